-- The valve bus in the captures of fieldproof: characters in the levels, frames over the packets of a line
-- (each character may be a transmission of its own), and the block check. Loaded by fieldproof.lua, which
-- hands over how packets are read; alone it does nothing.
--
-- What cannot be told at once: only silence ends a frame. A command is shown with its fifth character; three
-- characters are shown as a response when their check fits, because they may still become a command. What a
-- frame with another number of characters was, or a response whose check does not fit, is shown in front of
-- the next frame of the line, and behind the last one of a capture not at all.
local packets = ...
if packets == nil then return end

-- ---------------------------------------------------------------------------------------------------------
-- The valve bus, as fieldproof takes it to be. "unverified": a choice of the project, because the paper that
-- describes the bus is silent. Whoever knows a real one changes this table and nothing else.
local VALVE_BUS = {
  start_is = 0,                   -- start-stop characters: idle and stop are the other level
  formats = {                     -- unverified: which; 11 bits are derived from serial mode 2 of the 8051
    [0] = { name = "P0", data_bits = 8, has_ninth = true },
    [1] = { name = "P1", data_bits = 8, has_parity = true },  -- even
    [2] = { name = "P2", data_bits = 8 },
  },
  gap_half_characters = 3,        -- unverified: more inside a frame spoils it
  delimiter_half_characters = 7,  -- unverified: silence that ends a frame
  command_characters = 5,         -- seed: ID, COMMAND, DATA0, DATA1, BCC
  response_characters = 3,        -- seed: DATA0, DATA1, BCC
  commands = { [0] = "write", [1] = "read" },  -- seed
  first_address = 1,              -- seed
  last_address = 99,              -- seed
  first_number = 1,               -- unverified: valve and switch of the lowest bit of DATA0; DATA1 goes on
}

local valve_bus = Proto("valve_bus", "Valve bus (as fieldproof takes it)")
local of_bus = {
  character = ProtoField.string("valve_bus.character", "Character"),
  level = ProtoField.uint32("valve_bus.character.level", "First level"),
  start = ProtoField.uint8("valve_bus.character.start", "Start"),
  octet = ProtoField.uint8("valve_bus.character.data", "Data", base.HEX),
  ninth = ProtoField.uint8("valve_bus.character.ninth", "Ninth bit"),
  parity = ProtoField.uint8("valve_bus.character.parity", "Parity (even)"),
  stop = ProtoField.uint8("valve_bus.character.stop", "Stop"),
  id = ProtoField.uint8("valve_bus.id", "ID of the node"),
  command = ProtoField.uint8("valve_bus.command", "Command", base.DEC, VALVE_BUS.commands),
  data0 = ProtoField.uint8("valve_bus.data0", "DATA0", base.HEX),
  data1 = ProtoField.uint8("valve_bus.data1", "DATA1", base.HEX),
  valves = ProtoField.string("valve_bus.valves", "Valves that are on"),
  check = ProtoField.uint8("valve_bus.check", "Block check", base.HEX),
  check_calculated = ProtoField.uint8("valve_bus.check.calculated", "Block check as calculated here",
    base.HEX),
  check_good = ProtoField.bool("valve_bus.check.good", "Block check fits"),
  response_data0 = ProtoField.uint8("valve_bus.response.data0", "DATA0", base.HEX),
  response_data1 = ProtoField.uint8("valve_bus.response.data1", "DATA1", base.HEX),
  response_switches = ProtoField.string("valve_bus.response.switches", "Switches that are closed"),
  response_check = ProtoField.uint8("valve_bus.response.check", "Block check", base.HEX),
  response_check_calculated = ProtoField.uint8("valve_bus.response.check.calculated",
    "Block check as calculated here", base.HEX),
  response_check_good = ProtoField.bool("valve_bus.response.check.good", "Block check fits"),
  before = ProtoField.framenum("valve_bus.before", "The frame before ended in"),
  before_characters = ProtoField.uint32("valve_bus.before.characters", "Characters of the frame before"),
}
local function note(name, text, group, severity)
  return ProtoExpert.new("valve_bus.note." .. name, text, group, severity)
end
local notes = {
  changed = note("changed", "A fault changed this character on the way", expert.group.PROTOCOL,
    expert.severity.WARN),
  check = note("check", "The block check does not fit the octets that it covers", expert.group.CHECKSUM,
    expert.severity.ERROR),
  parity = note("parity", "The parity is wrong", expert.group.CHECKSUM, expert.severity.ERROR),
  stop = note("stop", "The stop bit is missing", expert.group.PROTOCOL, expert.severity.ERROR),
  gap = note("gap", "The gap in front of this character spoils its frame", expert.group.PROTOCOL,
    expert.severity.WARN),
  length = note("length", "The frame before has a wrong length", expert.group.PROTOCOL,
    expert.severity.ERROR),
  address = note("address", "No node has this ID", expert.group.PROTOCOL, expert.severity.NOTE),
  command = note("command", "This command is not defined", expert.group.PROTOCOL, expert.severity.NOTE),
}
valve_bus.fields = of_bus
valve_bus.experts = notes

-- ---------------------------------------------------------------------------------------------------------
-- Characters: a receiver takes three samples of each bit, at 7, 8 and 9 sixteenths of it, and believes two.

-- The instant at which level `n` begins, as the program rounds it.
local function time_of(packet, n)
  return packet.start + math.floor(n * 1e12 / packet.rate + 0.5)
end

local function bits_time(packet, count)
  return math.floor(count * 1e12 / packet.bit_rate + 0.5)
end

local function level_at(packet, n)
  if n >= packet.count then return 1 - VALVE_BUS.start_is end
  return packet.levels[n]
end

-- Levels from the edge to so many sixteenths of bit `k`.
local function levels_to(packet, k, sixteenth)
  return (k * 16 + sixteenth) * packet.rate / (packet.bit_rate * 16)
end

local function sample(packet, edge, k)
  local sum = 0
  for sixteenth = 7, 9 do
    sum = sum + level_at(packet, edge + math.floor(levels_to(packet, k, sixteenth)))
  end
  return sum >= 2 and 1 or 0
end

-- The first edge to the start level at or after level `at`; in front of level 0 the line is idle.
local function next_edge(packet, at)
  local start = VALVE_BUS.start_is
  while at < packet.count do
    if packet.levels[at] == start and (at == 0 or packet.levels[at - 1] ~= start) then return at end
    at = at + 1
  end
  return at
end

-- Where a receiver that has refused a start bit looks for the next edge.
local function idle_seen(packet, edge)
  local is_idle_last = level_at(packet, edge + math.floor(levels_to(packet, 0, 9))) ~= VALVE_BUS.start_is
  return edge + math.ceil(levels_to(packet, 0, is_idle_last and 9 or 8))
end

-- The end of its last bit; with the stop bit missing, when the line is idle again.
local function busy_until(packet, character, stop_bit)
  if not character.is_stop_missing then return character.time + bits_time(packet, stop_bit + 1) end
  local at = character.at + math.ceil(levels_to(packet, stop_bit - 1, 9))
  while at < packet.count and packet.levels[at] == VALVE_BUS.start_is do at = at + 1 end
  local sampled = character.time + math.floor((stop_bit * 16 + 9) * 1e12 / (packet.bit_rate * 16) + 0.5)
  return math.max(sampled, time_of(packet, math.min(at, packet.count)))
end

local function character_at(packet, edge)
  local format = packet.format
  local character = { at = edge, time = time_of(packet, edge), octet = 0 }
  local ones = 0
  for n = 0, format.data_bits - 1 do
    local bit = sample(packet, edge, 1 + n)
    character.octet = character.octet + bit * 2 ^ n
    ones = ones + bit
  end
  if format.has_ninth then character.ninth = sample(packet, edge, 9) end
  if format.has_parity then character.parity = sample(packet, edge, 9) end
  character.is_parity_wrong = format.has_parity and (ones + character.parity) % 2 == 1
  character.stop = sample(packet, edge, packet.stop_bit)
  character.is_stop_missing = character.stop == VALVE_BUS.start_is
  character.is_good = not character.is_parity_wrong and not character.is_stop_missing
  character.busy_until = busy_until(packet, character, packet.stop_bit)
  local levels = math.ceil(levels_to(packet, packet.stop_bit + 1, 0))
  character.levels = math.max(math.min(levels, packet.count - edge), 1)
  return character
end

local function characters_of(packet)
  local characters = {}
  local at = next_edge(packet, 0)
  while at < packet.count do
    if sample(packet, at, 0) ~= VALVE_BUS.start_is then
      at = next_edge(packet, idle_seen(packet, at))
    else
      characters[#characters + 1] = character_at(packet, at)
      at = next_edge(packet, at + math.ceil(levels_to(packet, packet.stop_bit, 9)))
    end
  end
  return characters
end

-- ---------------------------------------------------------------------------------------------------------
-- Frames. A frame is open until silence ends it; it may go on in the next packets of its line.

local function check_of(octets)
  local check = 0
  for n = 1, #octets - 1 do check = bit32.bxor(check, octets[n]) end
  return check
end

local function is_check_good(octets)
  return check_of(octets) == octets[#octets]
end

local function copy_of(frame)
  if frame == nil then return nil end
  local copy = {}
  for name, value in pairs(frame) do copy[name] = value end
  copy.octets = {}
  for n, octet in ipairs(frame.octets) do copy.octets[n] = octet end
  return copy
end

-- Calls put(character, frame, before) for each character with the frame that it makes, and with the frame
-- that it follows when it begins one. Gives the frame that is open behind them.
local function follow(packet, characters, frame, number, put)
  for _, character in ipairs(characters) do
    local before
    local bits = packet.stop_bit + 1
    if frame and frame.busy_until + bits_time(packet, VALVE_BUS.delimiter_half_characters * bits / 2)
      <= character.time then
      before = frame
      frame = nil
    end
    frame = frame or { octets = {}, is_spoilt = false }
    character.is_late = frame.busy_until ~= nil and character.time - frame.busy_until
      > bits_time(packet, VALVE_BUS.gap_half_characters * bits / 2)
    frame.octets[#frame.octets + 1] = character.octet
    frame.is_spoilt = frame.is_spoilt or character.is_late or not character.is_good
    frame.busy_until = character.busy_until
    frame.number = number
    if put then put(character, frame, before) end
  end
  return frame
end

-- "2, 9": the numbers of the bits that are 1.
local function numbers_of(data0, data1)
  local numbers = {}
  for n = 0, 15 do
    local octet = n < 8 and data0 or data1
    if math.floor(octet / 2 ^ (n % 8)) % 2 == 1 then
      numbers[#numbers + 1] = tostring(VALVE_BUS.first_number + n)
    end
  end
  return #numbers == 0 and "none" or table.concat(numbers, ", ")
end

local function add_check(branch, range, octets, check, calculated, good)
  local is_good = is_check_good(octets)
  branch:add(check, range, octets[#octets])
  branch:add(calculated, range, check_of(octets)):set_generated()
  branch:add(good, range, is_good):set_generated()
  if not is_good then branch:add_proto_expert_info(notes.check) end
  return is_good and "" or ", check WRONG"
end

local function add_command(tree, range, octets)
  local name = VALVE_BUS.commands[octets[2]]
  local branch = tree:add(valve_bus, range)
  branch:add(of_bus.id, range, octets[1])
  branch:add(of_bus.command, range, octets[2])
  branch:add(of_bus.data0, range, octets[3])
  branch:add(of_bus.data1, range, octets[4])
  local text = string.format("%s, node %d", name or string.format("command %02X", octets[2]), octets[1])
  if name == "write" then
    local valves = numbers_of(octets[3], octets[4])
    branch:add(of_bus.valves, range, valves):set_generated()
    text = text .. ", valves on: " .. valves
  end
  if octets[1] < VALVE_BUS.first_address or octets[1] > VALVE_BUS.last_address then
    branch:add_proto_expert_info(notes.address)
  end
  if name == nil then branch:add_proto_expert_info(notes.command) end
  text = text .. add_check(branch, range, octets, of_bus.check, of_bus.check_calculated, of_bus.check_good)
  branch:set_text("Command: " .. text)
  return text
end

local function add_response(tree, range, octets)
  local switches = numbers_of(octets[1], octets[2])
  local branch = tree:add(valve_bus, range)
  branch:add(of_bus.response_data0, range, octets[1])
  branch:add(of_bus.response_data1, range, octets[2])
  branch:add(of_bus.response_switches, range, switches):set_generated()
  local text = "response, switches closed: " .. switches
  text = text .. add_check(branch, range, octets, of_bus.response_check, of_bus.response_check_calculated,
    of_bus.response_check_good)
  branch:set_text("Response: " .. text)
  return text
end

-- What could not be told of a frame before it had ended.
local function add_before(tree, range, frame)
  local count = #frame.octets
  if frame.is_spoilt or count == VALVE_BUS.command_characters then return nil end
  local is_response = count == VALVE_BUS.response_characters
  if is_response and is_check_good(frame.octets) then return nil end
  local branch = tree:add(of_bus.before, range, frame.number)
  branch:set_generated()
  branch:add(of_bus.before_characters, range, count):set_generated()
  if is_response then return "before: " .. add_response(branch, range, frame.octets) end
  branch:add_proto_expert_info(notes.length, string.format("The frame before has %d characters", count))
  return string.format("before: %d characters", count)
end

local function add_character(packet, character, range, tree)
  local text = string.format("%02X%s", character.octet, character.is_good and "" or "!")
  local branch = tree:add(of_bus.character, range, text)
  branch:add(of_bus.level, range, character.at)
  branch:add(of_bus.start, range, VALVE_BUS.start_is)
  branch:add(of_bus.octet, range, character.octet)
  if character.ninth then branch:add(of_bus.ninth, range, character.ninth) end
  if character.parity then branch:add(of_bus.parity, range, character.parity) end
  branch:add(of_bus.stop, range, character.stop)
  if packets.is_changed(packet, character.at, character.levels) then
    branch:add_proto_expert_info(notes.changed)
  end
  if character.is_parity_wrong then branch:add_proto_expert_info(notes.parity) end
  if character.is_stop_missing then branch:add_proto_expert_info(notes.stop) end
  if character.is_late then branch:add_proto_expert_info(notes.gap) end
  return text
end

local function add_frame(tree, range, frame)
  if frame.is_spoilt then return nil end
  if #frame.octets == VALVE_BUS.command_characters then return add_command(tree, range, frame.octets) end
  if #frame.octets == VALVE_BUS.response_characters and is_check_good(frame.octets) then
    return add_response(tree, range, frame.octets)
  end
  return nil
end

local frame_before = packets.memory(valve_bus, copy_of)

local function add_valve_bus(packet, pinfo, tree)
  packet.format = VALVE_BUS.formats[packet.variant]
  if packet.format == nil or packet.rate <= 0 or packet.bit_rate <= 0 then
    pinfo.cols.info = string.format("%d levels, character format not known", packet.told_count)
    return
  end
  packet.stop_bit = 1 + packet.format.data_bits
    + ((packet.format.has_ninth or packet.format.has_parity) and 1 or 0)
  local characters = characters_of(packet)
  local open = frame_before(packet, pinfo, function(frame)
    return follow(packet, characters, frame, pinfo.number)
  end)
  local branch = tree:add(valve_bus, packet.tvb())
  local words = {}
  follow(packet, characters, open, pinfo.number, function(character, frame, before)
    local range = packets.range_of(packet, character.at, character.levels)
    if before then words[#words + 1] = add_before(branch, range, before) end
    words[#words + 1] = add_character(packet, character, range, branch)
    local text = add_frame(branch, range, frame)
    if text then words[#words] = words[#words] .. " = " .. text end
  end)
  local info = #words > 0 and table.concat(words, "; ") or "no character"
  branch:set_text(string.format("Valve bus, %s: %s", packet.format.name, info))
  pinfo.cols.protocol = "valve bus"
  pinfo.cols.info = info .. (packet.arrived and " (arrived so)" or "")
end

return add_valve_bus
