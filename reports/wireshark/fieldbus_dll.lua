-- The data link of IEC 61158 type 1 in the captures of fieldproof: frames with their delimiters in the levels,
-- DLPDUs of the profile that the packet names, and the frame check. Loaded by fieldproof.lua, which hands over
-- how packets are read; alone it does nothing.
local packets = ...
if packets == nil then return end

-- ---------------------------------------------------------------------------------------------------------
-- The data link, as fieldproof takes it to be. "unverified": from memory, or a choice of the project. Whoever has
-- the standard changes this table and nothing else.
local LINK = {
  start_delimiter = "1011001001001101",  -- searched: half bits, 1 N+ N- 1 0 N- N+ 0
  end_delimiter = "1011001100100110",    -- searched: 1 N+ N- N+ N- 1 0 1
  check_poly = 0x1DCF,                   -- searched; begins with FFFF, complemented, the high octet first
  priorities = { [1] = "time-available", [2] = "normal", [3] = "urgent" },
  reasons = { [0] = "nothing to send", [1] = "no time", [2] = "single frame done" },  -- unverified
  statuses = { [0] = "unknown address", [1] = "nothing written" },                    -- unverified
  most_data = { [1] = 256, [2] = 128, [3] = 64 },  -- unverified: octets, by priority
  first_address = 0x01,                            -- unverified, ISA-D
  last_address = 0xF7,                             -- unverified, ISA-D
  everybody = 0xFF,                                -- unverified, ISA-D: DU only
}

-- What stands in the first octet besides a DLPDU's own code, and what follows it. A field is { name, octets };
-- 0 octets: an address, long or short; no number: all that is left.
local L, F, PP = 8, 4, 3
local DA, SA, NODE = { "destination", 1 }, { "source", 1 }, { "node", 1 }
local DURATION, VERSION, DATA = { "duration", 2 }, { "version", 2 }, { "data" }
local PROFILES = {
  [0] = {
    name = "ISA-D",  -- unverified, all of it
    dlpdus = {
      { "CD", 0x10, PP, { DA, SA } },
      { "DT", 0x20, F + PP, { DA, SA, DATA } },
      { "DU", 0x30, F + PP, { DA, SA, DATA } },
      { "ET", 0x40, PP, { DA, SA } },
      { "ES", 0x50, PP, { DA, SA, DURATION } },
      { "EE", 0x64, 0, { DA, SA, { "reason", 1 } } },
      { "TL", 0x70, 0, { DA, SA, VERSION } },
    },
  },
  [1] = {
    name = "FF-P",
    has_long_addresses = true,  -- unverified: octets from memory, what follows them in part a choice
    dlpdus = {
      { "RT", 0x34, 0, {} },
      { "RI", 0x20, 0, { DURATION } },
      { "PN", 0x26, 0, { NODE } },
      { "PR", 0x27, 0, { NODE } },
      { "TD", 0x11, 0, { { "link_time", 6 } } },
      { "CT", 0x14, 0, { NODE } },
      { "CL", 0x01, 0, { NODE } },
      { "TL", 0x06, 0, { NODE, VERSION } },
      { "IDLE", 0x10, 0, {} },
      { "SR", 0x13, F, { { "status", 1 } } },
      { "PT", 0x30, F + PP, { NODE, DURATION } },
      { "CD", 0xA0, L + F + PP, { { "destination", 0 } } },
      { "DT1", 0xD0, L + F + PP, { { "destination", 0 }, { "source", 0 }, DATA } },
      { "DT3", 0x50, L + F + PP, { { "source", 0 }, { "writes", 1 }, DATA } },
    },
  },
}

local fieldbus_dll = Proto("fieldbus_dll", "Fieldbus data link (as fieldproof takes it)")
local of_link = {
  frame = ProtoField.string("fieldbus_dll.frame", "Frame"),
  half_bit = ProtoField.uint32("fieldbus_dll.frame.half_bit", "First half bit of its start delimiter"),
  ends = ProtoField.string("fieldbus_dll.frame.end", "How it ends"),
  octets = ProtoField.string("fieldbus_dll.frame.octets", "Octets"),
  type = ProtoField.string("fieldbus_dll.type", "DLPDU"),
  control = ProtoField.uint8("fieldbus_dll.control", "First octet", base.HEX),
  priority = ProtoField.uint8("fieldbus_dll.priority", "Priority", base.DEC, LINK.priorities),
  final = ProtoField.bool("fieldbus_dll.final", "F: final use; of a PT, the first of a circulation"),
  long = ProtoField.bool("fieldbus_dll.long", "L: long addresses"),
  destination = ProtoField.uint32("fieldbus_dll.destination", "Destination", base.HEX),
  source = ProtoField.uint32("fieldbus_dll.source", "Source", base.HEX),
  node = ProtoField.uint8("fieldbus_dll.node", "Node", base.HEX),
  duration = ProtoField.uint16("fieldbus_dll.duration", "Duration / octets"),
  version = ProtoField.uint16("fieldbus_dll.version", "Version of the schedule"),
  reason = ProtoField.uint8("fieldbus_dll.reason", "Reason", base.DEC, LINK.reasons),
  status = ProtoField.uint8("fieldbus_dll.status", "Status", base.DEC, LINK.statuses),
  link_time = ProtoField.double("fieldbus_dll.link_time", "Link time / (1/32 ms)"),
  writes = ProtoField.uint8("fieldbus_dll.writes", "Number of writes"),
  data = ProtoField.string("fieldbus_dll.data", "Data"),
  check = ProtoField.uint16("fieldbus_dll.check", "Frame check", base.HEX),
  check_calculated = ProtoField.uint16("fieldbus_dll.check.calculated", "Frame check as calculated here",
    base.HEX),
  check_good = ProtoField.bool("fieldbus_dll.check.good", "Frame check fits"),
}
local function note(name, text, group, severity)
  return ProtoExpert.new("fieldbus_dll.note." .. name, text, group, severity)
end
local notes = {
  changed = note("changed", "A fault changed this frame on the way", expert.group.PROTOCOL,
    expert.severity.WARN),
  check = note("check", "The frame check does not fit the octets in front of it", expert.group.CHECKSUM,
    expert.severity.ERROR),
  broken = note("broken", "The frame has no right end", expert.group.PROTOCOL, expert.severity.ERROR),
  unknown = note("unknown", "This is no DLPDU of the profile", expert.group.PROTOCOL, expert.severity.NOTE),
}
fieldbus_dll.fields = of_link
fieldbus_dll.experts = notes

-- ---------------------------------------------------------------------------------------------------------
-- Levels to frames.

-- Each edge is a border of half bits; how many lie between two edges is rounded. Gives them as text, and the
-- level at which each begins.
local function half_bits_of(packet)
  local text, begins = {}, {}
  local at = 0
  while at < packet.count do
    local to = at
    while to < packet.count and packet.levels[to] == packet.levels[at] do to = to + 1 end
    local per_half_bit = packet.rate / (2 * packet.bit_rate)
    for n = 0, math.floor((to - at) / per_half_bit + 0.5) - 1 do
      text[#text + 1] = tostring(packet.levels[at])
      begins[#begins + 1] = at + math.floor(n * per_half_bit)
    end
    at = to
  end
  return table.concat(text), begins
end

-- From behind its start delimiter on. Gives the frame and where to look for the next one.
local function read_frame(half_bits, first)
  local frame = { half_bit = first, octets = {}, ends = "signal lost" }
  local at = first + 16
  local bits, octet = 0, 0
  while at + 2 <= #half_bits do
    local sixteen = half_bits:sub(at + 1, at + 16)
    if sixteen == LINK.end_delimiter then
      frame.ends = bits == 0 and "whole" or "part of an octet"
      frame.behind = at + 16
      return frame, frame.behind
    end
    if sixteen == LINK.start_delimiter then
      frame.ends, frame.behind = "begun anew", at
      return frame, at
    end
    local symbol = half_bits:sub(at + 1, at + 2)
    if symbol == "11" or symbol == "00" then
      frame.ends, frame.behind = "code violation", at
      return frame, at
    end
    octet = octet * 2 + (symbol == "10" and 1 or 0)
    bits = bits + 1
    if bits == 8 then
      frame.octets[#frame.octets + 1] = octet
      bits, octet = 0, 0
    end
    at = at + 2
  end
  frame.behind = at
  return frame, at
end

local function frames_in(half_bits)
  local frames = {}
  local at = 0
  while true do
    local found = half_bits:find(LINK.start_delimiter, at + 1, true)
    if not found then return frames end
    frames[#frames + 1], at = read_frame(half_bits, found - 1)
  end
end

-- ---------------------------------------------------------------------------------------------------------
-- Octets to DLPDUs.

local function exclusive_or(a, b)
  local result, weight = 0, 1
  while a > 0 or b > 0 do
    if a % 2 ~= b % 2 then result = result + weight end
    a, b, weight = math.floor(a / 2), math.floor(b / 2), weight * 2
  end
  return result
end

local function check_of(octets, count)
  local register = 0xFFFF
  for n = 1, count do
    for bit = 7, 0, -1 do
      local feeds = math.floor(register / 0x8000) ~= math.floor(octets[n] / 2 ^ bit) % 2
      register = register * 2 % 0x10000
      if feeds then register = exclusive_or(register, LINK.check_poly) end
    end
  end
  return 0xFFFF - register
end

local function has(bits, bit)
  return math.floor(bits / bit) % 2 == 1
end

-- The bits of a first octet that a DLPDU leaves free, without them, and whether it is this one.
local function is_shape(shape, control)
  local rest, free = control, shape[3]
  if has(free, L) then rest = rest - (has(control, L) and L or 0) end
  if has(free, F) then rest = rest - (has(control, F) and F or 0) end
  local needs_priority = free % 4 == PP
  if needs_priority then rest = rest - control % 4 end
  return rest == shape[2] and (not needs_priority or control % 4 ~= 0)
end

local function shape_of(profile, control)
  for _, shape in ipairs(profile.dlpdus) do
    if is_shape(shape, control) then return shape end
  end
  return nil
end

local function hex(octets, first, last)
  local words = {}
  for n = first, last do words[#words + 1] = string.format("%02X", octets[n]) end
  return table.concat(words, " ")
end

-- Values that a field cannot have make no DLPDU of it. An address of FF-P is long when its link is not 0.
local function is_possible(profile, shape, name, value, is_long)
  if name == "duration" then return value ~= 0 end
  if name == "reason" then return LINK.reasons[value] ~= nil end
  if name == "status" then return LINK.statuses[value] ~= nil end
  if name ~= "destination" and name ~= "source" then return true end
  if profile.has_long_addresses then return (value > 0xFFFF) == is_long end
  if name == "destination" and shape[1] == "DU" and value == LINK.everybody then return true end
  return value >= LINK.first_address and value <= LINK.last_address
end

local function value_of(octets, first, size)
  local value = 0
  for n = first, first + size - 1 do value = value * 256 + octets[n] end
  return value
end

-- Adds the fields of the first `count` octets; nil when they are no DLPDU.
local function add_dlpdu(tree, range, octets, count, profile)
  local shape = count >= 1 and shape_of(profile, octets[1])
  if not shape then return nil end
  local control, is_long = octets[1], has(shape[3], L) and has(octets[1], L)
  local fields, at = {}, 2
  for _, field in ipairs(shape[4]) do
    local size = field[2] == 0 and (is_long and 4 or 2) or field[2] or count + 1 - at
    if size < 0 or at + size - 1 > count then return nil end
    if field[1] == "data" then
      if size > LINK.most_data[control % 4] then return nil end
    elseif not is_possible(profile, shape, field[1], value_of(octets, at, size), is_long) then
      return nil
    end
    fields[#fields + 1] = { field[1], at, size }
    at = at + size
  end
  if at ~= count + 1 then return nil end
  tree:add(of_link.type, range, shape[1])
  tree:add(of_link.control, range, control)
  local words = { shape[1] }
  if shape[3] % 4 == PP then
    tree:add(of_link.priority, range, control % 4)
    words[#words + 1] = LINK.priorities[control % 4]
  end
  if has(shape[3], F) then tree:add(of_link.final, range, has(control, F)) end
  if has(shape[3], L) then tree:add(of_link.long, range, is_long) end
  for _, field in ipairs(fields) do
    local name, first, size = field[1], field[2], field[3]
    if name == "data" then
      tree:add(of_link.data, range, hex(octets, first, first + size - 1))
    else
      local value = value_of(octets, first, size)
      tree:add(of_link[name], range, value)
      words[#words + 1] = string.format("%s %X", name, value)
    end
  end
  return table.concat(words, " ")
end

local function add_frame(packet, tree, begins, frame, profile)
  local first = begins[frame.half_bit + 1]
  local last = begins[frame.behind] or packet.count - 1
  local range = packets.range_of(packet, first, last - first + 1)
  local count = #frame.octets
  local branch = tree:add(of_link.frame, range, hex(frame.octets, 1, count))
  branch:add(of_link.half_bit, range, frame.half_bit)
  branch:add(of_link.ends, range, frame.ends)
  branch:add(of_link.octets, range, count)
  if packets.is_changed(packet, first, last - first + 1) then branch:add_proto_expert_info(notes.changed) end
  if frame.ends ~= "whole" then
    branch:add_proto_expert_info(notes.broken)
    return frame.ends
  end
  if count < 2 then
    branch:add_proto_expert_info(notes.check)
    return "check wrong"
  end
  local check = frame.octets[count - 1] * 256 + frame.octets[count]
  local calculated = check_of(frame.octets, count - 2)
  branch:add(of_link.check, range, check)
  branch:add(of_link.check_calculated, range, calculated):set_generated()
  branch:add(of_link.check_good, range, check == calculated):set_generated()
  if check ~= calculated then
    branch:add_proto_expert_info(notes.check)
    return "check wrong"
  end
  local text = add_dlpdu(branch, range, frame.octets, count - 2, profile)
  if text then return text end
  branch:add_proto_expert_info(notes.unknown)
  return "no DLPDU"
end

local function add_fieldbus_dll(packet, pinfo, tree)
  local profile = PROFILES[packet.variant]
  if profile == nil or packet.rate <= 0 or packet.bit_rate <= 0 then
    pinfo.cols.info = string.format("%d levels, profile not known", packet.told_count)
    return
  end
  local branch = tree:add(fieldbus_dll, packet.tvb())
  local half_bits, begins = half_bits_of(packet)
  local words = {}
  for _, frame in ipairs(frames_in(half_bits)) do
    words[#words + 1] = add_frame(packet, branch, begins, frame, profile)
  end
  local info = #words > 0 and table.concat(words, "; ") or "no frame"
  branch:set_text(string.format("Fieldbus data link, %s: %s", profile.name, info))
  pinfo.cols.protocol = "fieldbus dll"
  pinfo.cols.info = info .. (packet.arrived and " (arrived so)" or "")
end

return add_fieldbus_dll
