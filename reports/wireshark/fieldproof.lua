-- Wireshark and tshark dissector for the captures of fieldproof (link type 147, USER0).
--
--   tshark -X lua_script:fieldproof.lua -r cases/ID/trace.pcapng -V
--
-- A packet is one transmission on one line: its levels, as they were driven or as they arrived. This file
-- reads the packet; a file beside it for each protocol finds telegrams or characters in the levels, follows
-- the frames of each line over its packets, and computes the frame check itself: nothing of it is taken from
-- the program that wrote the capture. Only "a fault changed this" comes from the mask in the packet.

-- The protocols by the number in a packet, and the file of each. It gives a function(packet, pinfo, tree).
local FILES = { [1] = "interbus.lua", [2] = "valve_bus.lua", [3] = "fieldbus_dll.lua", [4] = "token_bus.lua" }
local NAMES = { [0] = "unknown", [1] = "INTERBUS", [2] = "valve bus", [3] = "fieldbus data link", [4] = "token bus" }

-- ---------------------------------------------------------------------------------------------------------
-- The packet.

local VERSION = 2
local HEADER_OCTETS = 36

local fieldproof = Proto("fieldproof", "fieldproof capture")
local of_packet = {
  protocol = ProtoField.uint8("fieldproof.protocol", "Protocol", base.DEC, NAMES),
  variant = ProtoField.uint8("fieldproof.variant", "Variant of the protocol"),
  arrived = ProtoField.bool("fieldproof.arrived", "Arrived (else driven)"),
  changed = ProtoField.bool("fieldproof.changed", "Changed by a fault on the way"),
  lost = ProtoField.bool("fieldproof.lost", "Lost on the way"),
  start = ProtoField.int64("fieldproof.start_ps", "Start / ps"),
  rate = ProtoField.uint64("fieldproof.rate", "Levels per second"),
  bit_rate = ProtoField.uint64("fieldproof.bit_rate", "Bits per second"),
  channel = ProtoField.uint32("fieldproof.channel", "Channel"),
  count = ProtoField.uint32("fieldproof.levels", "Number of levels"),
  levels = ProtoField.string("fieldproof.level", "Levels"),
  changed_levels = ProtoField.uint32("fieldproof.changed_levels", "Levels that are not as they were sent"),
}
local packet_notes = {
  changed = ProtoExpert.new("fieldproof.note.changed", "A fault changed this transmission on the way",
    expert.group.PROTOCOL, expert.severity.WARN),
  version = ProtoExpert.new("fieldproof.note.version",
    "This dissector does not know the layout of the packet", expert.group.UNDECODED, expert.severity.ERROR),
  cut = ProtoExpert.new("fieldproof.note.cut", "The transmission is longer than the packet",
    expert.group.UNDECODED, expert.severity.NOTE),
}
fieldproof.fields = of_packet
fieldproof.experts = packet_notes

-- What the files of the protocols share.
local packets = {}

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
function packets.range_of(packet, first, count)
  local from = HEADER_OCTETS + math.floor(first / 8)
  local to = math.min(HEADER_OCTETS + math.floor((first + count - 1) / 8), packet.tvb:len() - 1)
  return packet.tvb(from, math.max(to - from + 1, 0))
end

function packets.is_changed(packet, first, count)
  for n = first, first + count - 1 do
    if packet.mask[n] == 1 then return true end
  end
  return false
end

-- The state of each line before a packet, kept because a packet may be shown again and in any order. A line
-- has two views: what was driven, and what its receiver heard. `advance` makes the state behind the packet of
-- a copy of the one before it; nil is the state of a line that was not heard yet.
function packets.memory(proto, copy_of)
  local before = {}
  local lines = {}
  function proto.init()
    before = {}
    lines = {}
  end
  return function(packet, pinfo, advance)
    if not pinfo.visited then
      local heard = packet.channel .. " heard"
      local own = packet.arrived and heard or packet.channel .. " driven"
      before[pinfo.number] = copy_of(lines[own]) or false
      lines[own] = advance(copy_of(lines[own]))
      if not packet.arrived and not packet.changed then
        lines[heard] = advance(copy_of(lines[heard]))
      end
    end
    return copy_of(before[pinfo.number] or nil)
  end
end

local function read_packet(tvb)
  local packet = { tvb = tvb, flags = tvb(2, 1):uint() }
  packet.protocol = tvb(1, 1):uint()
  packet.variant = tvb(3, 1):uint()
  packet.arrived = has_flag(packet.flags, 1)
  packet.changed = has_flag(packet.flags, 2)
  packet.lost = has_flag(packet.flags, 4)
  packet.start = tvb(4, 8):int64():tonumber()
  packet.rate = tvb(12, 8):uint64():tonumber()
  packet.bit_rate = tvb(20, 8):uint64():tonumber()
  packet.told_count = tvb(28, 4):uint()
  packet.channel = tvb(32, 4):uint()
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
  branch:add(of_packet.variant, tvb(3, 1))
  branch:add(of_packet.arrived, tvb(2, 1), packet.arrived)
  branch:add(of_packet.changed, tvb(2, 1), packet.changed)
  branch:add(of_packet.lost, tvb(2, 1), packet.lost)
  branch:add(of_packet.start, tvb(4, 8))
  branch:add(of_packet.rate, tvb(12, 8))
  branch:add(of_packet.bit_rate, tvb(20, 8))
  branch:add(of_packet.count, tvb(28, 4))
  branch:add(of_packet.channel, tvb(32, 4))
  if packet.count > 0 then
    local shown = {}
    for n = 0, math.min(packet.count, 400) - 1 do shown[#shown + 1] = tostring(packet.levels[n]) end
    branch:add(of_packet.levels, packets.range_of(packet, 0, packet.count), table.concat(shown))
  end
  if packet.changed_levels > 0 then branch:add(of_packet.changed_levels, packet.changed_levels) end
  if packet.count < packet.told_count then branch:add_proto_expert_info(packet_notes.cut) end
  if packet.changed then branch:add_proto_expert_info(packet_notes.changed) end
  return branch
end

-- ---------------------------------------------------------------------------------------------------------
-- The protocols.

local folder = debug.getinfo(1, "S").source:match("^@(.*[/\\])") or ""
local add_protocol = {}
for number, file in pairs(FILES) do add_protocol[number] = assert(loadfile(folder .. file))(packets) end

function fieldproof.dissector(tvb, pinfo, tree)
  pinfo.cols.protocol = "fieldproof"
  if tvb:len() < HEADER_OCTETS or tvb(0, 1):uint() ~= VERSION then
    tree:add(fieldproof, tvb()):add_proto_expert_info(packet_notes.version)
    return
  end
  local packet = read_packet(tvb)
  add_packet(packet, tree)
  local add = add_protocol[packet.protocol]
  if add then
    add(packet, pinfo, tree)
  else
    pinfo.cols.info = string.format("%d levels", packet.told_count)
  end
end

DissectorTable.get("wtap_encap"):add(wtap.USER0, fieldproof)
