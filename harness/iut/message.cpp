#include "harness/iut/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/kernel/check.hpp"

namespace fieldproof::iut {
namespace {

constexpr std::uint8_t kParityWrong = 1;
constexpr std::uint8_t kStopMissing = 2;
constexpr std::uint8_t kSensesActivity = 1;  // of capabilities

struct NamedType {
  MessageType type;
  std::string_view name;
};
constexpr std::array kNames = {
    NamedType{MessageType::hello, "hello"},
    NamedType{MessageType::echo, "echo"},
    NamedType{MessageType::case_begin, "case begin"},
    NamedType{MessageType::power, "power"},
    NamedType{MessageType::receive_characters, "receive characters"},
    NamedType{MessageType::receive_levels, "receive levels"},
    NamedType{MessageType::on_time, "on time"},
    NamedType{MessageType::case_end, "case end"},
    NamedType{MessageType::value, "value"},
    NamedType{MessageType::activity, "activity"},
    NamedType{MessageType::capabilities, "capabilities"},
    NamedType{MessageType::echoed, "echoed"},
    NamedType{MessageType::done, "done"},
    NamedType{MessageType::unsupported, "unsupported"},
    NamedType{MessageType::characters, "characters"},
    NamedType{MessageType::transmit_levels, "transmit levels"},
    NamedType{MessageType::write, "write"},
    NamedType{MessageType::read, "read"},
    NamedType{MessageType::driver, "driver"},
};

}  // namespace

std::string name(MessageType type) {
  const auto found = std::ranges::find(kNames, type, &NamedType::type);
  if (found != kNames.end()) return std::string(found->name);
  return fmt::format("type {}", static_cast<unsigned>(type));
}

MessageWriter& MessageWriter::begin(MessageType type) {
  bytes_.clear();
  return u32(0).u8(static_cast<std::uint8_t>(type));
}

MessageWriter& MessageWriter::text(std::string_view value) {
  const std::string_view kept = value.substr(0, 0xFFFF);
  u16(static_cast<std::uint16_t>(kept.size()));
  bytes_.insert(bytes_.end(), kept.begin(), kept.end());
  return *this;
}

MessageWriter& MessageWriter::octets(std::span<const std::uint8_t> value) {
  bytes_.insert(bytes_.end(), value.begin(), value.end());
  return *this;
}

std::span<const std::uint8_t> MessageWriter::finish() {
  const std::size_t length = bytes_.size() - kMessageHead;
  FIELDPROOF_CHECK(length <= kLongestMessage, "a message of the bench is not longer than its reader takes");
  for (unsigned n = 0; n < kMessageHead; ++n) bytes_[n] = static_cast<std::uint8_t>(length >> (8 * n));
  return bytes_;
}

MessageReader::MessageReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
  type_ = static_cast<MessageType>(u8());
}

std::span<const std::uint8_t> MessageReader::take(std::size_t octets) {
  if (octets > bytes_.size()) {
    throw MessageError(fmt::format("{} octets are missing at its end", octets - bytes_.size()));
  }
  const auto taken = bytes_.first(octets);
  bytes_ = bytes_.subspan(octets);
  return taken;
}

std::uint64_t MessageReader::number(std::size_t octets) {
  std::uint64_t value = 0;
  const auto taken = take(octets);
  for (std::size_t n = 0; n < octets; ++n) value |= std::uint64_t{taken[n]} << (8 * n);
  return value;
}

std::string MessageReader::text() {
  const auto taken = take(u16());
  return {taken.begin(), taken.end()};
}

std::span<const std::uint8_t> MessageReader::rest() {
  return take(bytes_.size());
}

void MessageReader::finish() const {
  if (!bytes_.empty()) throw MessageError(fmt::format("{} octets more than it should have", bytes_.size()));
}

std::span<const std::uint8_t> write_capabilities(MessageWriter& writer,
                                                 const PeerCapabilities& capabilities) {
  writer.begin(MessageType::capabilities)
      .u16(capabilities.version)
      .u8(capabilities.unit)
      .text(capabilities.name);
  writer.u16(static_cast<std::uint16_t>(capabilities.roles.size()));
  for (const RoleName& role : capabilities.roles) writer.text(role.protocol).text(role.role);
  if (capabilities.senses_activity) writer.u8(kSensesActivity);
  return writer.finish();
}

PeerCapabilities read_capabilities(MessageReader& reader) {
  PeerCapabilities read;
  read.version = reader.u16();
  if (read.version != kMessageVersion) return read;
  read.unit = reader.u8();
  read.name = reader.text();
  for (unsigned left = reader.u16(); left > 0; --left) {
    RoleName role;
    role.protocol = reader.text();
    role.role = reader.text();
    read.roles.push_back(std::move(role));
  }
  if (!reader.is_at_end()) {
    const unsigned asked = reader.u8();
    if (asked != kSensesActivity)
      throw MessageError(fmt::format("it asks for {}; there is 1 (activity), or nothing", asked));
    read.senses_activity = true;
  }
  reader.finish();
  return read;
}

std::span<const std::uint8_t> write_case_begin(MessageWriter& writer, const CaseBegin& begin) {
  writer.begin(MessageType::case_begin).text(begin.id).u64(begin.seed);
  writer.u16(static_cast<std::uint16_t>(begin.settings.size()));
  for (const auto& [name, value] : begin.settings) writer.text(name).i64(value);
  return writer.finish();
}

CaseBegin read_case_begin(MessageReader& reader) {
  CaseBegin begin;
  begin.id = reader.text();
  begin.seed = reader.u64();
  const std::size_t count = reader.u16();
  for (std::size_t n = 0; n < count; ++n) {
    std::string name = reader.text();
    begin.settings.emplace_back(std::move(name), reader.i64());
  }
  reader.finish();
  return begin;
}

std::span<const std::uint8_t> write_reception(MessageWriter& writer, unsigned port,
                                              std::span<const Character> characters, kernel::Time now) {
  writer.begin(MessageType::receive_characters).u8(static_cast<std::uint8_t>(port)).time(now);
  writer.u16(static_cast<std::uint16_t>(characters.size()));
  for (const Character& one : characters) {
    const unsigned flags =
        (one.is_parity_wrong ? kParityWrong : 0U) | (one.is_stop_missing ? kStopMissing : 0U);
    writer.time(one.start).time(one.busy_until).u16(one.data).u8(static_cast<std::uint8_t>(flags));
  }
  return writer.finish();
}

ReceivedCharacters read_reception(MessageReader& reader) {
  ReceivedCharacters received;
  received.port = reader.u8();
  received.now = reader.time();
  const std::size_t count = reader.u16();
  for (std::size_t n = 0; n < count; ++n) {
    Character& one = received.characters.emplace_back();
    one.start = reader.time();
    one.busy_until = reader.time();
    one.data = reader.u16();
    const std::uint8_t flags = reader.u8();
    one.is_parity_wrong = (flags & kParityWrong) != 0;
    one.is_stop_missing = (flags & kStopMissing) != 0;
  }
  reader.finish();
  return received;
}

std::span<const std::uint8_t> write_activity(MessageWriter& writer, const LineActivity& activity) {
  writer.begin(MessageType::activity).u8(static_cast<std::uint8_t>(activity.port));
  return writer.u8(activity.begins ? 1 : 0).time(activity.now).finish();
}

LineActivity read_activity(MessageReader& reader) {
  LineActivity activity;
  activity.port = reader.u8();
  const unsigned begins = reader.u8();
  if (begins > 1)
    throw MessageError(fmt::format("'begins' of activity is {}; there are 0 (ends) and 1 (begins)", begins));
  activity.begins = begins == 1;
  activity.now = reader.time();
  reader.finish();
  return activity;
}

std::span<const std::uint8_t> write_driver(MessageWriter& writer, const DriverSwitch& driver) {
  writer.begin(MessageType::driver).u8(static_cast<std::uint8_t>(driver.port)).u8(driver.is_on ? 1 : 0);
  return writer.time(driver.at).finish();
}

DriverSwitch read_driver(MessageReader& reader) {
  DriverSwitch driver;
  driver.port = reader.u8();
  const unsigned on = reader.u8();
  if (on > 1) throw MessageError(fmt::format("'on' of a driver is {}; there are 0 (off) and 1 (on)", on));
  driver.is_on = on == 1;
  driver.at = reader.time();
  reader.finish();
  return driver;
}

std::span<const std::uint8_t> write_characters(MessageWriter& writer, unsigned port, kernel::Time start,
                                               std::span<const std::uint16_t> characters) {
  writer.begin(MessageType::characters).u8(static_cast<std::uint8_t>(port)).time(start);
  writer.u16(static_cast<std::uint16_t>(characters.size()));
  for (const std::uint16_t character : characters) writer.u16(character);
  return writer.finish();
}

SentCharacters read_characters(MessageReader& reader) {
  SentCharacters sent;
  sent.port = reader.u8();
  sent.start = reader.time();
  const std::size_t count = reader.u16();
  for (std::size_t n = 0; n < count; ++n) sent.characters.push_back(reader.u16());
  reader.finish();
  return sent;
}

std::span<const std::uint8_t> write_levels(MessageWriter& writer, MessageType type, unsigned port,
                                           const line::Waveform& wave) {
  writer.begin(type).u8(static_cast<std::uint8_t>(port)).time(wave.start).i64(wave.rate);
  const std::size_t count = wave.levels.size();
  writer.u32(static_cast<std::uint32_t>(count));
  for (std::size_t n = 0; n < count; n += 8) {
    writer.u8(static_cast<std::uint8_t>(wave.levels.window(n) & 0xFF));
  }
  return writer.finish();
}

unsigned read_levels(MessageReader& reader, line::Waveform& wave) {
  const unsigned port = reader.u8();
  wave.start = reader.time();
  wave.rate = reader.i64();
  const std::size_t count = reader.u32();
  const auto packed = reader.rest();
  if (packed.size() != (count + 7) / 8) {
    throw MessageError(fmt::format("{} octets for {} levels", packed.size(), count));
  }
  constexpr std::int64_t kGreatestRate = 100'000'000'000;
  if (wave.rate < 1 || wave.rate > kGreatestRate) {
    throw MessageError(fmt::format("{} levels per second", wave.rate));
  }
  wave.levels.clear();
  for (std::size_t n = 0; n < count; n += 8) {
    wave.levels.append(packed[n / 8], static_cast<unsigned>(std::min<std::size_t>(8, count - n)));
  }
  return port;
}

}  // namespace fieldproof::iut
