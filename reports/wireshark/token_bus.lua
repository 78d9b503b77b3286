-- The token bus of IEEE 802.4 on IEEE 802.3 in the captures of fieldproof: frames between their delimiters in
-- the levels, their fields, and the frame check. Loaded by fieldproof.lua, which hands over how packets are
-- read; alone it does nothing. The variant of a packet is the octets of an address.
local packets = ...
if packets == nil then return end

-- Half bits of a MAC symbol: a 1 of the line rises in its middle, and a symbol is two bits of the line.
local ONE, ZERO = "0110", "1001"
local NON_DATA = "01011010"  -- two symbols, always together
local START = NON_DATA .. ZERO .. NON_DATA .. ZERO .. ZERO .. ZERO
local END = NON_DATA .. ONE .. NON_DATA .. ONE  -- then I and E
local SYMBOL, DELIMITER = 4, 32
local CHECK_OCTETS = 4
local MOST_OCTETS = 8191

-- By the octet of frame control, its first bit on the line lowest.
local CONTROLS = {
  [0x00] = "claim_token",
  [0x80] = "solicit_successor_1",
  [0x40] = "solicit_successor_2",
  [0xC0] = "who_follows",
  [0x20] = "resolve_contention",
  [0x10] = "token",
  [0x30] = "set_successor",
}
local HAS_ADDRESS = { [0xC0] = true, [0x30] = true }
local ACTIONS = { [0] = "request with no response", [1] = "request with response", [2] = "response" }

local token_bus = Proto("token_bus", "Token bus on IEEE 802.3")
local of_bus = {
  frame = ProtoField.string("token_bus.frame", "Frame"),
  half_bit = ProtoField.uint32("token_bus.frame.half_bit", "First half bit of its start delimiter"),
  ends = ProtoField.string("token_bus.frame.end", "How it ends"),
  more = ProtoField.bool("token_bus.frame.more", "I: more frames follow"),
  error = ProtoField.bool("token_bus.frame.error", "E: an error was noticed"),
  type = ProtoField.string("token_bus.type", "Type"),
  control = ProtoField.uint8("token_bus.control", "Frame control", base.HEX),
  action = ProtoField.uint8("token_bus.action", "Action", base.DEC, ACTIONS),
  priority = ProtoField.uint8("token_bus.priority", "Priority"),
  destination = ProtoField.string("token_bus.destination", "Destination"),
  source = ProtoField.string("token_bus.source", "Source"),
  address = ProtoField.string("token_bus.address", "Address in the data unit"),
  data = ProtoField.string("token_bus.data", "Data"),
  check_good = ProtoField.bool("token_bus.check.good", "Frame check fits"),
}
local function note(name, text, group, severity)
  return ProtoExpert.new("token_bus.note." .. name, text, group, severity)
end
local notes = {
  changed = note("changed", "A fault changed this frame on the way", expert.group.PROTOCOL, expert.severity.WARN),
  check = note("check", "The frame check does not fit", expert.group.CHECKSUM, expert.severity.ERROR),
  broken = note("broken", "This is no whole frame", expert.group.PROTOCOL, expert.severity.ERROR),
  unknown = note("unknown", "This is no frame of this network", expert.group.PROTOCOL, expert.severity.NOTE),
}
token_bus.fields = of_bus
token_bus.experts = notes

-- ---------------------------------------------------------------------------------------------------------
-- Levels to frames.

-- Each edge is a border of half bits; how many lie between two edges is rounded.
local function half_bits_of(packet)
  local text, begins = {}, {}
  local per_half_bit = packet.rate / (2 * packet.bit_rate)
  local at = 0
  while at < packet.count do
    local to = at
    while to < packet.count and packet.levels[to] == packet.levels[at] do to = to + 1 end
    for n = 0, math.floor((to - at) / per_half_bit + 0.5) - 1 do
      text[#text + 1] = tostring(packet.levels[at])
      begins[#begins + 1] = at + math.floor(n * per_half_bit)
    end
    at = to
  end
  return table.concat(text), begins
end

-- From after its start delimiter on. Gives the frame and where to look for the next one.
local function read_frame(half_bits, first)
  local frame = { half_bit = first, octets = {}, ends = "frame fragment" }
  local at = first + DELIMITER
  local bits, octet = 0, 0
  while true do
    local symbol = half_bits:sub(at + 1, at + SYMBOL)
    if symbol ~= ONE and symbol ~= ZERO then break end
    if symbol == ONE then octet = octet + 2 ^ bits end
    bits = bits + 1
    if bits == 8 then
      frame.octets[#frame.octets + 1] = octet
      bits, octet = 0, 0
    end
    at = at + SYMBOL
  end
  local is_long = #frame.octets > MOST_OCTETS
  if is_long then frame.ends = "frame too long" end
  local flags = half_bits:sub(at + #END + 1, at + DELIMITER)
  local more, error = flags:sub(1, SYMBOL), flags:sub(SYMBOL + 1)
  local is_flag = { [ONE] = true, [ZERO] = true }
  if half_bits:sub(at + 1, at + #END) == END and is_flag[more] and is_flag[error] then
    frame.more, frame.error = more == ONE, error == ONE
    if bits == 0 and not is_long then frame.ends = frame.error and "E bit error" or "whole" end
    at = at + DELIMITER
  elseif half_bits:sub(at + 1, at + DELIMITER) ~= START then
    at = at + SYMBOL
  end
  frame.behind = at
  return frame, at
end

local function frames_in(half_bits)
  local frames, at = {}, 0
  while true do
    local found = half_bits:find(START, at + 1, true)
    if not found then return frames end
    frames[#frames + 1], at = read_frame(half_bits, found - 1)
  end
end

-- ---------------------------------------------------------------------------------------------------------
-- Octets to fields.

local function exclusive_or(a, b)
  local result, weight = 0, 1
  while a > 0 or b > 0 do
    if a % 2 ~= b % 2 then result = result + weight end
    a, b, weight = math.floor(a / 2), math.floor(b / 2), weight * 2
  end
  return result
end

-- CRC-32 of one octet, for each of them.
local CRC_TABLE = {}
for octet = 0, 255 do
  local register = octet
  for _ = 1, 8 do
    local leaves = register % 2 == 1
    register = math.floor(register / 2)
    if leaves then register = exclusive_or(register, 0xEDB88320) end
  end
  CRC_TABLE[octet] = register
end

local function crc_of(octets, count)
  local register = 0xFFFFFFFF
  for n = 1, count do
    register = exclusive_or(math.floor(register / 256), CRC_TABLE[exclusive_or(register % 256, octets[n])])
  end
  return 0xFFFFFFFF - register
end

local function has_right_check(octets)
  local count = #octets - CHECK_OCTETS
  local check = 0
  for n = CHECK_OCTETS, 1, -1 do check = check * 256 + octets[count + n] end
  return check == crc_of(octets, count)
end

local function hex(octets, first, last)
  local text = {}
  for n = first, math.min(last, first + 63) do text[#text + 1] = string.format("%02X", octets[n]) end
  return table.concat(text, " ")
end

local function address_at(octets, first, size)
  local text = ""
  for n = first, first + size - 1 do text = string.format("%02X", octets[n]) .. text end
  return text
end

-- The type, in words; nothing where there is no such frame.
local function type_of(octets, count, size)
  local head = 1 + 2 * size
  if count < head or octets[1 + size + 1] % 2 == 1 then return nil end
  local control = octets[1]
  if CONTROLS[control] then
    local is_right = control == 0x00 or count - head == (HAS_ADDRESS[control] and size or 0)
    return is_right and CONTROLS[control] or nil
  end
  local format, action = control % 4, math.floor(control / 4) % 8
  -- MMM has its highest bit first.
  action = math.floor(action / 4) + math.floor(action / 2) % 2 * 2 + action % 2 * 4
  if ACTIONS[action] == nil then return nil end
  if format == 2 then return "data", action end
  if format == 1 then return "management data", action end
  return nil
end

local function add_fields(tree, range, octets, count, size)
  local name, action = type_of(octets, count, size)
  if not name then return nil end
  local head = 1 + 2 * size
  local destination, source = address_at(octets, 2, size), address_at(octets, 2 + size, size)
  tree:add(of_bus.type, range, name)
  tree:add(of_bus.control, range, octets[1])
  tree:add(of_bus.destination, range, destination)
  tree:add(of_bus.source, range, source)
  if action then
    local bits = math.floor(octets[1] / 32)
    tree:add(of_bus.action, range, action)
    tree:add(of_bus.priority, range, math.floor(bits / 4) + math.floor(bits / 2) % 2 * 2 + bits % 2 * 4)
  end
  if HAS_ADDRESS[octets[1]] then
    tree:add(of_bus.address, range, address_at(octets, head + 1, size))
  elseif count > head then
    tree:add(of_bus.data, range, hex(octets, head + 1, count))
  end
  return string.format("%s, %s -> %s", name, source, destination)
end

local function add_frame(packet, tree, begins, frame, size)
  local first = begins[frame.half_bit + 1]
  local last = begins[frame.behind] or packet.count - 1
  local range = packets.range_of(packet, first, last - first + 1)
  local count = #frame.octets
  local branch = tree:add(of_bus.frame, range, hex(frame.octets, 1, count))
  branch:add(of_bus.half_bit, range, frame.half_bit)
  if packets.is_changed(packet, first, last - first + 1) then branch:add_proto_expert_info(notes.changed) end
  if frame.ends == "whole" and count == 0 then frame.ends = "frame fragment" end
  if frame.ends == "whole" then
    local fits = count > CHECK_OCTETS and has_right_check(frame.octets)
    branch:add(of_bus.check_good, range, fits):set_generated()
    if not fits then
      branch:add_proto_expert_info(notes.check)
      frame.ends = "FCS error"
    end
  end
  branch:add(of_bus.ends, range, frame.ends)
  if frame.more ~= nil then
    branch:add(of_bus.more, range, frame.more)
    branch:add(of_bus.error, range, frame.error)
  end
  if frame.ends ~= "whole" then
    branch:add_proto_expert_info(notes.broken)
    return frame.ends
  end
  local text = add_fields(branch, range, frame.octets, count - CHECK_OCTETS, size)
  if text then return text end
  branch:add_proto_expert_info(notes.unknown)
  return "no frame of this network"
end

local function add_token_bus(packet, pinfo, tree)
  if packet.rate <= 0 or packet.bit_rate <= 0 or packet.variant == 0 then
    pinfo.cols.info = string.format("%d levels, rate or addresses not known", packet.told_count)
    return
  end
  local branch = tree:add(token_bus, packet.tvb())
  local half_bits, begins = half_bits_of(packet)
  local words = {}
  for _, frame in ipairs(frames_in(half_bits)) do
    words[#words + 1] = add_frame(packet, branch, begins, frame, packet.variant)
  end
  local info = #words > 0 and table.concat(words, "; ") or "non-silence"
  branch:set_text("Token bus: " .. info)
  pinfo.cols.protocol = "token bus"
  pinfo.cols.info = info .. (packet.arrived and " (arrived so)" or "")
end

return add_token_bus
