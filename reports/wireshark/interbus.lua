-- INTERBUS in the captures of fieldproof: telegrams in the levels, cycles over the packets of a line, and the
-- frame check. Loaded by fieldproof.lua, which hands over how packets are read; alone it does nothing.
--
-- What cannot be told: a telegram that the end of a transmission cuts is shown as cut and not completed from
-- the next one; levels off the grid of the bits are sampled once, in the middle of a bit.
local packets = ...
if packets == nil then return end

-- ---------------------------------------------------------------------------------------------------------
-- INTERBUS, as fieldproof takes it to be. "unverified": a choice of the project or from memory, because the
-- standard was not at hand; wire compatibility with real INTERBUS is not claimed. Whoever has the standard,
-- or a network file with other rules, changes this table and nothing else.
local INTERBUS = {
  header = { "sl", "cr", "fl" },  -- unverified: order of the header levels behind the start level
  select_is = 1,                  -- unverified: level of "SL set" (ID cycle)
  control_is = 1,                 -- unverified: level of "CR set" (check phase)
  data_flag_is = 1,               -- unverified: level of "data telegram"
  start_is = 0,                   -- unverified: idle and stop are the other level
  msb_first = true,               -- unverified: order of the data levels
  loopback_word = 0xA55A,         -- unverified
  check_preset = 0xFFFF,          -- searched: registers are preset with 1
  check_polynomial = { 0x1000, 0x0020, 0x0001 },  -- searched: x^16 + x^12 + x^5 + 1
  check_xorout = 0x0000,          -- unverified: final XOR
  status_clean = 0x0000,          -- unverified
  status_marked = 0xFFFF,         -- unverified
}

-- ---------------------------------------------------------------------------------------------------------
-- INTERBUS: telegrams.

local interbus = Proto("interbus", "INTERBUS (as fieldproof takes it, wire format unverified)")
local KINDS = { [0] = "data cycle", [1] = "ID cycle" }
local of_line = {
  telegram = ProtoField.string("interbus.telegram", "Telegram"),
  level = ProtoField.uint32("interbus.telegram.level", "First level"),
  start = ProtoField.uint8("interbus.telegram.start", "Start"),
  sl = ProtoField.uint8("interbus.telegram.sl", "SL (select)"),
  cr = ProtoField.uint8("interbus.telegram.cr", "CR (control)"),
  fl = ProtoField.uint8("interbus.telegram.fl", "FL (data telegram)"),
  data = ProtoField.uint8("interbus.telegram.data", "Data", base.HEX),
  stop = ProtoField.uint8("interbus.telegram.stop", "Stop"),
  cycle = ProtoField.string("interbus.cycle", "Cycle"),
  kind = ProtoField.uint8("interbus.cycle.kind", "Kind", base.DEC, KINDS),
  lbw = ProtoField.uint16("interbus.lbw", "Loopback word", base.HEX),
  word = ProtoField.uint16("interbus.word", "Data word", base.HEX),
  id = ProtoField.uint16("interbus.id", "ID or control word", base.HEX),
  octet = ProtoField.uint8("interbus.octet", "Octet without a second one", base.HEX),
  fcs = ProtoField.uint16("interbus.fcs", "Frame check", base.HEX),
  fcs_calculated = ProtoField.uint16("interbus.fcs.calculated", "Frame check as calculated here", base.HEX),
  fcs_good = ProtoField.bool("interbus.fcs.good", "Frame check fits"),
  status_word = ProtoField.uint16("interbus.status_word", "Status word", base.HEX),
  end_word = ProtoField.uint16("interbus.end", "End", base.HEX),
}
local line_notes = {
  changed = ProtoExpert.new("interbus.note.changed", "A fault changed this telegram on the way",
    expert.group.PROTOCOL, expert.severity.WARN),
  fcs = ProtoExpert.new("interbus.note.fcs", "The frame check does not fit the octets that it covers",
    expert.group.CHECKSUM, expert.severity.ERROR),
  stop = ProtoExpert.new("interbus.note.stop", "The stop bit is missing",
    expert.group.PROTOCOL, expert.severity.ERROR),
  cut = ProtoExpert.new("interbus.note.cut", "The end of the transmission cuts this telegram",
    expert.group.PROTOCOL, expert.severity.NOTE),
  marked = ProtoExpert.new("interbus.note.marked", "A station has marked the status word",
    expert.group.PROTOCOL, expert.severity.NOTE),
}
interbus.fields = of_line
interbus.experts = line_notes

local STATUS_LEVELS = 5
local DATA_LEVELS = 13

-- The level of bit `k` of a telegram that begins at level `at`; idle beyond the end.
local function sample(packet, at, k)
  local n = at + math.floor((k + 0.5) * packet.ratio)
  if n >= packet.count then return 1 - INTERBUS.start_is, true end
  return packet.levels[n], false
end

local function octet_of(packet, at)
  local octet = 0
  for n = 0, 7 do
    local bit = sample(packet, at, 4 + n)
    octet = INTERBUS.msb_first and octet * 2 + bit or octet + bit * 2 ^ n
  end
  return octet
end

local function telegram_at(packet, at)
  local telegram = { at = at, start = sample(packet, at, 0) }
  for n, name in ipairs(INTERBUS.header) do telegram[name] = sample(packet, at, n) end
  telegram.is_id = telegram.sl == INTERBUS.select_is
  telegram.is_check = telegram.cr == INTERBUS.control_is
  telegram.is_data = telegram.fl == INTERBUS.data_flag_is
  telegram.bits = telegram.is_data and DATA_LEVELS or STATUS_LEVELS
  if telegram.is_data then telegram.octet = octet_of(packet, at) end
  local is_beyond
  telegram.stop, is_beyond = sample(packet, at, telegram.bits - 1)
  telegram.is_cut = is_beyond
  telegram.is_stop_missing = telegram.stop == INTERBUS.start_is
  telegram.levels = math.min(math.ceil(telegram.bits * packet.ratio), packet.count - at)
  return telegram
end

-- The first edge to the start level at or after level `at`.
local function next_start(packet, at, needs_idle)
  if needs_idle then
    while at < packet.count and packet.levels[at] == INTERBUS.start_is do at = at + 1 end
  end
  while at < packet.count and packet.levels[at] ~= INTERBUS.start_is do at = at + 1 end
  return at
end

local function telegrams_of(packet)
  local telegrams = {}
  local is_on_grid = packet.ratio == 1
  local at = next_start(packet, 0, false)
  while at < packet.count do
    local telegram = telegram_at(packet, at)
    if telegram.start ~= INTERBUS.start_is then
      at = next_start(packet, at, true)  -- a glitch
    else
      telegrams[#telegrams + 1] = telegram
      local stop = at + math.floor((telegram.bits - 0.5) * packet.ratio)
      local behind = is_on_grid and at + telegram.bits or stop
      at = next_start(packet, telegram.is_stop_missing and stop or behind, telegram.is_stop_missing)
    end
  end
  return telegrams
end

local function add_telegram(packet, telegram, tree)
  local range = packets.range_of(packet, telegram.at, math.max(telegram.levels, 1))
  local text = telegram.is_data and string.format("data %02X", telegram.octet) or "status"
  if telegram.is_cut then text = text .. ", cut" end
  local branch = tree:add(of_line.telegram, range, text)
  branch:add(of_line.level, range, telegram.at)
  branch:add(of_line.start, range, telegram.start)
  branch:add(of_line.sl, range, telegram.is_id and 1 or 0)
  branch:add(of_line.cr, range, telegram.is_check and 1 or 0)
  branch:add(of_line.fl, range, telegram.is_data and 1 or 0)
  if telegram.is_data then branch:add(of_line.data, range, telegram.octet) end
  branch:add(of_line.stop, range, telegram.stop)
  if packets.is_changed(packet, telegram.at, telegram.levels) then
    branch:add_proto_expert_info(line_notes.changed)
  end
  if telegram.is_cut then branch:add_proto_expert_info(line_notes.cut) end
  if telegram.is_stop_missing then branch:add_proto_expert_info(line_notes.stop) end
end

-- ---------------------------------------------------------------------------------------------------------
-- INTERBUS: cycles. A cycle is open until another begins; it may go on in the next packets of its line.

local function check_of(octets)
  local check = INTERBUS.check_preset
  for _, octet in ipairs(octets) do
    for bit = 7, 0, -1 do
      local leaves = math.floor(check / 0x8000) ~= math.floor(octet / 2 ^ bit) % 2
      check = (check * 2) % 0x10000
      if leaves then
        for _, power in ipairs(INTERBUS.check_polynomial) do
          check = math.floor(check / power) % 2 == 1 and check - power or check + power
        end
      end
    end
  end
  if INTERBUS.check_xorout ~= 0 then check = 0xFFFF - check end  -- the only other XOR in use is FFFFh
  return check
end

local function copy_of(cycle)
  if cycle == nil then return nil end
  local copy = { is_id = cycle.is_id, is_whole = cycle.is_whole, transfer = {}, check = {} }
  for n, octet in ipairs(cycle.transfer) do copy.transfer[n] = octet end
  for n, octet in ipairs(cycle.check) do copy.check[n] = octet end
  return copy
end

-- The parts of cycles in the telegrams of a packet, in order; `open` is the cycle that was open before.
local function cycle_parts(telegrams, open)
  local parts = {}
  local cycle = open
  local part
  for _, telegram in ipairs(telegrams) do
    if telegram.is_data and not telegram.is_cut then
      local is_new = cycle == nil or cycle.is_id ~= telegram.is_id
        or (not telegram.is_check and #cycle.check > 0)
      if is_new then
        cycle = { is_id = telegram.is_id, is_whole = not telegram.is_check, transfer = {}, check = {} }
      end
      if is_new or part == nil then
        part = { cycle = cycle, transfer_from = #cycle.transfer, check_from = #cycle.check, at = telegram.at }
        parts[#parts + 1] = part
      end
      local phase = telegram.is_check and cycle.check or cycle.transfer
      phase[#phase + 1] = telegram.octet
      part.transfer_to = #cycle.transfer
      part.check_to = #cycle.check
      part.levels = telegram.at + telegram.levels - part.at
    end
  end
  return parts, cycle
end

-- Calls put(word) or put(nil, octet) for the words of which a part has the last octet.
local function each_word(octets, from, to, put)
  for n = 1, to, 2 do
    if n + 1 <= to then
      if n + 1 > from then put(octets[n] * 256 + octets[n + 1], nil, n) end
    elseif n > from then
      put(nil, octets[n], n)
    end
  end
end

local function add_cycle(packet, part, tree)
  local cycle = part.cycle
  local range = packets.range_of(packet, part.at, part.levels)
  local name = cycle.is_id and "ID cycle" or "data cycle"
  local text = name .. (part.transfer_from + part.check_from > 0 and " goes on" or "")
  local branch = tree:add(of_line.cycle, range, text)
  branch:add(of_line.kind, range, cycle.is_id and 1 or 0)
  local loopback_at
  each_word(cycle.transfer, 0, part.transfer_to, function(word, _, n)
    if loopback_at == nil and word == INTERBUS.loopback_word then loopback_at = n end
  end)
  each_word(cycle.transfer, part.transfer_from, part.transfer_to, function(word, octet, n)
    if word == nil then
      branch:add(of_line.octet, range, octet)
    elseif n == loopback_at then
      branch:add(of_line.lbw, range, word)
    else
      branch:add(cycle.is_id and of_line.id or of_line.word, range, word)
    end
  end)
  each_word(cycle.check, part.check_from, part.check_to, function(word, octet, n)
    if word == nil then
      branch:add(of_line.octet, range, octet)
    elseif n == 1 then
      branch:add(of_line.fcs, range, word)
      if cycle.is_whole then
        local check = check_of(cycle.transfer)
        branch:add(of_line.fcs_calculated, range, check):set_generated()
        branch:add(of_line.fcs_good, range, check == word):set_generated()
        if check == word then
          text = text .. ", frame check fits"
        else
          text = text .. ", frame check WRONG"
          branch:add_proto_expert_info(line_notes.fcs)
        end
      end
    elseif n == 3 then
      branch:add(of_line.status_word, range, word)
      if word ~= INTERBUS.status_clean then branch:add_proto_expert_info(line_notes.marked) end
    else
      branch:add(of_line.end_word, range, word)
    end
  end)
  return text
end

local cycle_before = packets.memory(interbus, copy_of)

local function add_interbus(packet, pinfo, tree)
  packet.ratio = packet.bit_rate > 0 and packet.rate / packet.bit_rate or 1
  local telegrams = telegrams_of(packet)
  local open = cycle_before(packet, pinfo, function(cycle)
    local _, behind = cycle_parts(telegrams, cycle)
    return behind
  end)
  local parts = cycle_parts(telegrams, open)
  local branch = tree:add(interbus, packet.tvb())
  local words = {}
  for n, part in ipairs(parts) do
    local text = add_cycle(packet, part, branch)
    if n <= 4 then words[#words + 1] = text end
  end
  if #parts > 4 then words[#words + 1] = string.format("%d cycles more", #parts - 4) end
  local status = 0
  for _, telegram in ipairs(telegrams) do
    add_telegram(packet, telegram, branch)
    if not telegram.is_data then status = status + 1 end
  end
  if status > 0 then words[#words + 1] = string.format("%d status telegrams", status) end
  branch:set_text("INTERBUS: " .. table.concat(words, "; "))
  pinfo.cols.protocol = "INTERBUS"
  pinfo.cols.info = table.concat(words, "; ") .. (packet.arrived and " (arrived so)" or "")
end

return add_interbus
