#include "harness/iut/message_device.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::iut {
namespace {

using std::chrono::milliseconds;

std::string octets_text(std::span<const std::uint8_t> message) {
  constexpr std::size_t kMost = 32;
  std::string text = "message:";
  for (const std::uint8_t octet : message.first(std::min(message.size(), kMost)))
    text += fmt::format(" {:02X}", octet);
  return message.size() > kMost ? text + " ..." : text;
}

}  // namespace

PeerCapabilities hello(Peer& peer, const RoleName& role, std::chrono::milliseconds limit) {
  MessageWriter writer;
  writer.begin(MessageType::hello).u16(kMessageVersion).text(role.protocol).text(role.role);
  peer.send(writer.finish(), limit);
  const auto message = peer.receive(limit);
  PeerCapabilities read;
  try {
    MessageReader reader(message);
    if (reader.type() == MessageType::unsupported) return read;
    if (reader.type() != MessageType::capabilities) throw MessageError("'capabilities' is expected");
    read = read_capabilities(reader);
    if (read.version == kMessageVersion && (read.unit < static_cast<std::uint8_t>(UnitKind::characters) ||
                                            read.unit > static_cast<std::uint8_t>(UnitKind::telegrams))) {
      throw MessageError(
          fmt::format("unit {}; there are 1 (characters), 2 (levels) and 3 (telegrams)", read.unit));
    }
  } catch (const MessageError& error) {
    peer.blame(reasons::kGarbage, fmt::format("sends what is no message: {}", error.what()),
               {octets_text(message)});
  }
  if (read.version != kMessageVersion) {
    throw kernel::Error(kernel::ErrorKind::implementation,
                        fmt::format("{} speaks version {} of the messages; this program speaks version {}",
                                    peer.what(), read.version, kMessageVersion));
  }
  return read;
}

MessageDevice::MessageDevice(Peer peer, const RoleName& role, const PeerLimits& limits)
    : peer_(std::move(peer)), limits_(limits) {
  const PeerCapabilities read = hello(peer_, role, limits_.start);
  if (std::ranges::find(read.roles, role) == read.roles.end()) {
    std::vector<std::string> served;
    for (const RoleName& one : read.roles) served.push_back(kernel::escaped_line(one.path()));
    throw kernel::Error(kernel::ErrorKind::implementation,
                        fmt::format("{} does not serve the role {}; it serves {}", peer_.what(), role.path(),
                                    served.empty() ? "none" : fmt::format("{}", fmt::join(served, ", "))));
  }
  unit_kind_ = static_cast<UnitKind>(read.unit);
  senses_activity_ = read.senses_activity;
  own_name_ = kernel::escaped_line(read.name);
}

void MessageDevice::test_itself() {
  constexpr std::array<std::uint8_t, 8> kEcho{0x00, 0xFF, 0x0A, 0x0D, 0x1A, 0x7F, 0x80, 0x55};
  writer_.begin(MessageType::echo).octets(kEcho);
  const auto message = expect(writer_.finish(), MessageType::echoed, limits_.call);
  if (!std::ranges::equal(message.subspan(1), kEcho)) {
    throw kernel::Error(
        kernel::ErrorKind::implementation,
        fmt::format("{} does not send an echo back as it came ({}); its output may not be binary",
                    peer_.what(), octets_text(message)));
  }
  // A bench of its own: whoever takes this case has not looked at its name.
  class NoBench final : public Bench {
    void set_driver(unsigned, bool, kernel::Time) override {}
    void send(unsigned, kernel::Time, std::span<const std::uint16_t>) override {}
    void transmit(unsigned, line::Waveform&) override {}
    void write(Item, std::uint64_t, kernel::Time) override {}
    std::uint64_t read(Item, kernel::Time) override { return 0; }
  } none;
  if (begin({"self_test/unknown/case", 0, {}}, none)) {
    throw kernel::Error(
        kernel::ErrorKind::implementation,
        fmt::format("{} takes the case 'self_test/unknown/case', which is none of its protocol; it "
                    "should answer 'unsupported'",
                    peer_.what()));
  }
}

bool MessageDevice::is_quiet() {
  return peer_.is_alive() && !peer_.has_more();
}

bool MessageDevice::begin(const CaseBegin& begin, Bench& bench) {
  bench_ = &bench;
  case_begin_ = Peer::Clock::now();
  next_time_ = kernel::kNever;
  return call(write_case_begin(writer_, begin), Refusal::allowed);
}

void MessageDevice::set_power(bool is_on, kernel::Time now) {
  writer_.begin(MessageType::power).u8(is_on ? 1 : 0).time(now);
  call(writer_.finish());
}

void MessageDevice::receive(unsigned port, std::span<const Character> characters, kernel::Time now) {
  call(write_reception(writer_, port, characters, now));
}

void MessageDevice::receive(unsigned port, const line::Waveform& reception) {
  call(write_levels(writer_, MessageType::receive_levels, port, reception));
}

void MessageDevice::on_activity(unsigned port, bool begins, kernel::Time now) {
  call(write_activity(writer_, {port, begins, now}));
}

void MessageDevice::on_time(kernel::Time now) {
  writer_.begin(MessageType::on_time).time(now);
  call(writer_.finish());
}

void MessageDevice::end() {
  bench_ = nullptr;  // the case is over: there is nothing to act on any more
  writer_.begin(MessageType::case_end);
  call(writer_.finish());
  // What it says beyond that comes in front of the echo: this case is to blame, not the next one.
  writer_.begin(MessageType::echo);
  expect(writer_.finish(), MessageType::echoed, limits_.call);
}

bool MessageDevice::call(std::span<const std::uint8_t> message, Refusal refusal) {
  if (peer_.has_read_more()) {
    peer_.blame(reasons::kGarbage,
                "says something that it was not asked for: each call is answered once, by 'done'");
  }
  // One limit for all that happens within the call: what comes drop by drop is as bad as what never comes.
  const auto begin = Peer::Clock::now();
  if (begin - case_begin_ > limits_.whole_case) {
    peer_.blame(reasons::kHangs,
                fmt::format("has not come to the end of a case within {} ms", limits_.whole_case.count()));
  }
  peer_.send(message, limits_.call);
  std::size_t octets = 0;
  for (unsigned actions = 0; actions <= kMostActions; ++actions) {
    const auto answer = peer_.receive(limits_.call, begin);
    octets += answer.size();
    if (octets > kMostOctets) {
      peer_.blame(reasons::kFloods, fmt::format("has said more than {} octets within one call", kMostOctets));
    }
    try {
      MessageReader reader(answer);
      if (reader.type() == MessageType::done) {
        next_time_ = reader.time();
        reader.finish();
        return true;
      }
      if (reader.type() == MessageType::unsupported && refusal == Refusal::allowed) {
        reader.finish();
        bench_ = nullptr;
        return false;
      }
      serve(reader);
    } catch (const MessageError& error) {
      refuse(answer, error.what());
    }
  }
  peer_.blame(reasons::kFloods, fmt::format("has done more than {} things within one call", kMostActions));
}

void MessageDevice::serve(MessageReader& reader) {
  if (bench_ == nullptr) {
    throw MessageError(
        fmt::format("'{}' is nothing that an implementation says without a case", name(reader.type())));
  }
  switch (reader.type()) {
    case MessageType::driver: {
      const DriverSwitch driver = read_driver(reader);
      bench_->set_driver(driver.port, driver.is_on, driver.at);
      return;
    }
    case MessageType::characters: {
      const SentCharacters sent = read_characters(reader);
      bench_->send(sent.port, sent.start, sent.characters);
      return;
    }
    case MessageType::transmit_levels: {
      const unsigned port = read_levels(reader, wave_);
      bench_->transmit(port, wave_);
      return;
    }
    case MessageType::write: {
      const Item item = reader.u16();
      const std::uint64_t value = reader.u64();
      const kernel::Time when = reader.time();
      reader.finish();
      bench_->write(item, value, when);
      return;
    }
    case MessageType::read: {
      const Item item = reader.u16();
      const kernel::Time when = reader.time();
      reader.finish();
      writer_.begin(MessageType::value).u64(bench_->read(item, when));
      peer_.send(writer_.finish(), limits_.call);
      return;
    }
    default:
      throw MessageError(
          fmt::format("'{}' is nothing that an implementation says here", name(reader.type())));
  }
}

std::span<const std::uint8_t> MessageDevice::expect(std::span<const std::uint8_t> message, MessageType answer,
                                                    milliseconds limit) {
  peer_.send(message, limit);
  const auto received = peer_.receive(limit);
  if (static_cast<MessageType>(received.front()) != answer) {
    refuse(received, fmt::format("'{}' is expected", name(answer)));
  }
  return received;
}

void MessageDevice::refuse(std::span<const std::uint8_t> message, const std::string& why) {
  const std::vector<std::string> evidence{octets_text(message)};
  peer_.blame(reasons::kGarbage, fmt::format("sends what is no message: {}", why), evidence);
}

}  // namespace fieldproof::iut
