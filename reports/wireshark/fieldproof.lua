-- Wireshark and tshark dissector for the captures of fieldproof (link type 147, USER0).
--
--   tshark -X lua_script:fieldproof.lua -r cases/ID/trace.pcapng -V
--
-- A packet is one transmission on one line: its levels, as they were driven or as they arrived. The dissector
-- finds the telegrams in the levels, follows the cycles of each line over its packets, and computes the frame
-- check itself: nothing of it is taken from the program that wrote the capture. Only "a fault changed this
-- telegram" comes from the mask in the packet.
--
-- What cannot be told: a telegram that the end of a transmission cuts is shown as cut and not completed from
-- the next one; levels off the grid of the bits are sampled once, in the middle of a bit.

-- ---------------------------------------------------------------------------------------------------------
-- INTERBUS, as fieldproof takes it to be. "unverified": a choice of the project or from memory, because the
-- standard was not at hand; wire compatibility with real INTERBUS is not claimed. Whoever has the standard, or
-- a network file with other rules, changes this table and nothing else.
local INTERBUS = {
  capture_number = 1,
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
-- The packet.

local VERSION = 1
local HEADER_OCTETS = 32

local fieldproof = Proto("fieldproof", "fieldproof capture")
local of_packet = {
  protocol = ProtoField.uint8("fieldproof.protocol", "Protocol", base.DEC, { [0] = "unknown", [1] = "INTERBUS" }),
  arrived = ProtoField.bool("fieldproof.arrived", "Arrived (else driven)"),
  changed = ProtoField.bool("fieldproof.changed", "Changed by a fault on the way"),
  lost = ProtoField.bool("fieldproof.lost", "Lost on the way"),
  start = ProtoField.int64("fieldproof.start_ps", "Start / ps"),
  rate = ProtoField.uint64("fieldproof.rate", "Levels per second"),
  bit_rate = ProtoField.uint64("fieldproof.bit_rate", "Bits per second"),
  count = ProtoField.uint32("fieldproof.levels", "Number of levels"),
  levels = ProtoField.string("fieldproof.level", "Levels"),
  changed_levels = ProtoField.uint32("fieldproof.changed_levels", "Levels that are not as they were sent"),
}
local packet_notes = {
  changed = ProtoExpert.new("fieldproof.note.changed", "A fault changed this transmission on the way",
    expert.group.PROTOCOL, expert.severity.WARN),
  version = ProtoExpert.new("fieldproof.note.version", "This dissector does not know the layout of the packet",
    expert.group.UNDECODED, expert.severity.ERROR),
  cut = ProtoExpert.new("fieldproof.note.cut", "The transmission is longer than the packet",
    expert.group.UNDECODED, expert.severity.NOTE),
}
fieldproof.fields = of_packet
fieldproof.experts = packet_notes

local interface_of = Field.new("frame.interface_id")

local function bits_of(octets, first, count)
  local bits = {}
  for n = 0, count - 1 do
    local octet = octets:byte(first + math.floor(n / 8) + 1)
    bits[n] = math.floor(octet / 2 ^ (7 - n % 8)) % 2
  end
  return bits
end

local function has_flag(flags, flag)
  return math.floor(flags / flag) % 2 == 1
end

-- The part of the packet in which levels [first, first + count) lie.
local function range_of(packet, first, count)
  local from = HEADER_OCTETS + math.floor(first / 8)
  local to = math.min(HEADER_OCTETS + math.floor((first + count - 1) / 8), packet.tvb:len() - 1)
  return packet.tvb(from, math.max(to - from + 1, 0))
end

local function read_packet(tvb)
  local packet = { tvb = tvb, flags = tvb(2, 1):uint(), protocol = tvb(1, 1):uint() }
  packet.arrived = has_flag(packet.flags, 1)
  packet.changed = has_flag(packet.flags, 2)
  packet.lost = has_flag(packet.flags, 4)
  packet.rate = tvb(12, 8):uint64():tonumber()
  packet.bit_rate = tvb(20, 8):uint64():tonumber()
  packet.told_count = tvb(28, 4):uint()
  local has_mask = has_flag(packet.flags, 8)
  local octets = tvb:len() - HEADER_OCTETS
  packet.count = math.min(packet.told_count, (has_mask and math.floor(octets / 2) or octets) * 8)
  local raw = tvb:raw(HEADER_OCTETS, octets)
  packet.levels = bits_of(raw, 0, packet.count)
  packet.mask = {}
  packet.changed_levels = 0
  if has_mask then
    packet.mask = bits_of(raw, math.floor((packet.count + 7) / 8), packet.count)
    for n = 0, packet.count - 1 do packet.changed_levels = packet.changed_levels + packet.mask[n] end
  end
  return packet
end

local function add_packet(packet, tree)
  local tvb = packet.tvb
  local branch = tree:add(fieldproof, tvb(), "fieldproof: one transmission")
  branch:add(of_packet.protocol, tvb(1, 1))
  branch:add(of_packet.arrived, tvb(2, 1), packet.arrived)
  branch:add(of_packet.changed, tvb(2, 1), packet.changed)
  branch:add(of_packet.lost, tvb(2, 1), packet.lost)
  branch:add(of_packet.start, tvb(4, 8))
  branch:add(of_packet.rate, tvb(12, 8))
  branch:add(of_packet.bit_rate, tvb(20, 8))
  branch:add(of_packet.count, tvb(28, 4))
  if packet.count > 0 then
    local shown = {}
    for n = 0, math.min(packet.count, 400) - 1 do shown[#shown + 1] = tostring(packet.levels[n]) end
    branch:add(of_packet.levels, range_of(packet, 0, packet.count), table.concat(shown))
  end
  if packet.changed_levels > 0 then branch:add(of_packet.changed_levels, packet.changed_levels) end
  if packet.count < packet.told_count then branch:add_proto_expert_info(packet_notes.cut) end
  if packet.changed then branch:add_proto_expert_info(packet_notes.changed) end
  return branch
end

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

local function is_changed(packet, telegram)
  for n = telegram.at, telegram.at + telegram.levels - 1 do
    if packet.mask[n] == 1 then return true end
  end
  return false
end

local function add_telegram(packet, telegram, tree)
  local range = range_of(packet, telegram.at, math.max(telegram.levels, 1))
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
  if is_changed(packet, telegram) then branch:add_proto_expert_info(line_notes.changed) end
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
  local range = range_of(packet, part.at, part.levels)
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

-- What was open before a packet, kept because a packet may be shown again and in any order.
local open_before = {}
local lines = {}

function interbus.init()
  open_before = {}
  lines = {}
end

-- Both views of a line: what was driven, and what its receiver heard.
local function open_cycle(packet, pinfo, telegrams)
  if not pinfo.visited then
    local line = interface_of() and tostring(interface_of()) or "0"
    local own = line .. (packet.arrived and " heard" or " driven")
    open_before[pinfo.number] = copy_of(lines[own]) or false
    local _, open = cycle_parts(telegrams, copy_of(lines[own]))
    lines[own] = open
    if not packet.arrived and not packet.changed then
      local _, heard = cycle_parts(telegrams, copy_of(lines[line .. " heard"]))
      lines[line .. " heard"] = heard
    end
  end
  return copy_of(open_before[pinfo.number] or nil)
end

local function add_interbus(packet, pinfo, tree)
  packet.ratio = packet.bit_rate > 0 and packet.rate / packet.bit_rate or 1
  local telegrams = telegrams_of(packet)
  local parts = cycle_parts(telegrams, open_cycle(packet, pinfo, telegrams))
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

function fieldproof.dissector(tvb, pinfo, tree)
  pinfo.cols.protocol = "fieldproof"
  if tvb:len() < HEADER_OCTETS or tvb(0, 1):uint() ~= VERSION then
    tree:add(fieldproof, tvb()):add_proto_expert_info(packet_notes.version)
    return
  end
  local packet = read_packet(tvb)
  add_packet(packet, tree)
  if packet.protocol == INTERBUS.capture_number then
    add_interbus(packet, pinfo, tree)
  else
    pinfo.cols.info = string.format("%d levels", packet.told_count)
  end
end

DissectorTable.get("wtap_encap"):add(wtap.USER0, fieldproof)
