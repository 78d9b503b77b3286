#include "reports/pcapng_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "harness/kernel/untrusted_text.hpp"

namespace fieldproof::reports {
namespace {

constexpr std::uint16_t kUser0 = 147;
constexpr std::size_t kMostLevels = 1'000'000;

enum PayloadFlag : std::uint8_t { kArrived = 1, kChanged = 2, kLost = 4, kHasMask = 8 };
enum PacketFlag : std::uint32_t { kInbound = 1, kOutbound = 2, kCheckError = 1U << 24 };

// Numbers of pcapng, the least significant octet first.
class Block {
 public:
  explicit Block(std::uint32_t type) : type_(type) {}

  template <typename Number>
  void put(Number number) {
    put(body_, number);
  }
  void put_octets(std::string_view octets) {
    body_ += octets;
    body_.resize((body_.size() + 3) & ~std::size_t{3}, '\0');
  }
  void put_option(std::uint16_t code, std::string_view value) {
    constexpr std::size_t kLongest = 65'532;
    value = value.substr(0, kLongest);
    put(code);
    put(static_cast<std::uint16_t>(value.size()));
    put_octets(value);
  }
  void put_text(std::uint16_t code, std::string_view text) { put_option(code, kernel::as_utf8(text)); }

  // What the block is in a file, with its options ended.
  std::string finish() {
    put(std::uint32_t{0});
    const auto length = static_cast<std::uint32_t>(body_.size() + 12);
    std::string block;
    put(block, type_);
    put(block, length);
    block += body_;
    put(block, length);
    return block;
  }

 private:
  template <typename Number>
  static void put(std::string& to, Number number) {
    auto bits = static_cast<std::uint64_t>(number);
    for (std::size_t n = 0; n < sizeof number; ++n, bits >>= 8) to += static_cast<char>(bits & 0xFF);
  }

  std::uint32_t type_;
  std::string body_;
};

// Options, by the numbers that the format gives them.
constexpr std::uint16_t kComment = 1;
constexpr std::uint16_t kApplication = 4;  // of a section
constexpr std::uint16_t kName = 2;         // of an interface
constexpr std::uint16_t kResolution = 9;   // of an interface
constexpr std::uint16_t kFlags = 2;        // of a packet

std::string section(std::string_view application, std::string_view title) {
  Block block(0x0A0D0D0A);
  block.put(std::uint32_t{0x1A2B3C4D});
  block.put(std::uint16_t{1});
  block.put(std::uint16_t{0});
  block.put(std::int64_t{-1});
  block.put_text(kComment, title);
  block.put_text(kApplication, application);
  return block.finish();
}

std::string interface(std::string_view name) {
  Block block(1);
  block.put(kUser0);
  block.put(std::uint16_t{0});
  block.put(std::uint32_t{0});
  block.put_text(kName, name);
  block.put_option(kResolution, "\x09");
  return block.finish();
}

// Levels, or the places where they differ from what was sent, the first in the most significant bit.
void append_packed(std::string& to, const line::Levels& levels, std::size_t count, const line::Levels* sent) {
  for (std::size_t at = 0; at < count; at += 8) {
    unsigned octet = 0;
    for (std::size_t n = at; n < at + 8; ++n) {
      const bool bit = n < count ? levels[n] != (sent != nullptr && (*sent)[n]) : sent == nullptr;
      octet = octet << 1 | (bit ? 1U : 0U);
    }
    to += static_cast<char>(octet);
  }
}

struct Packet {
  trace::Channel channel = 0;
  const line::Waveform* wave = nullptr;
  const line::Levels* sent = nullptr;     // what the mask is held against
  const trace::Change* change = nullptr;  // null: it arrived as it was driven
  bool has_arrived = false;
};

std::vector<Packet> packets_of(const trace::Recording& recording) {
  std::vector<Packet> packets;
  for (const trace::Record& record : recording.records) {
    const auto* one = std::get_if<trace::Transmission>(&record);
    if (one == nullptr) continue;
    const trace::Change* change = one->change ? &recording.changes[*one->change] : nullptr;
    packets.push_back({one->channel, &one->wave, nullptr, change, false});
  }
  for (const trace::Change& change : recording.changes) {
    const bool is_comparable = change.arrivals.size() == 1 && change.arrivals[0].rate == change.sent.rate &&
                               change.arrivals[0].levels.size() == change.sent.levels.size();
    for (const line::Waveform& arrival : change.arrivals) {
      packets.push_back(
          {change.channel, &arrival, is_comparable ? &change.sent.levels : nullptr, &change, true});
    }
  }
  std::ranges::stable_sort(packets, {}, [](const Packet& packet) { return packet.wave->start; });
  return packets;
}

std::string payload(const Packet& packet, const trace::Dissector& dissector) {
  std::string octets;
  const auto put = [&octets](auto number) {
    for (std::size_t n = sizeof number; n > 0; --n)
      octets += static_cast<char>(static_cast<std::uint64_t>(number) >> (8 * (n - 1)) & 0xFF);
  };
  const line::Waveform& wave = *packet.wave;
  unsigned flags = 0;
  if (packet.has_arrived) flags |= kArrived;
  if (packet.change != nullptr) flags |= kChanged;
  if (packet.change != nullptr && packet.change->arrivals.empty()) flags |= kLost;
  if (packet.sent != nullptr) flags |= kHasMask;
  put(std::uint8_t{2});
  put(dissector.capture_number());
  put(static_cast<std::uint8_t>(flags));
  put(dissector.capture_variant());
  put(wave.start.time_since_epoch().count());
  put(wave.rate);
  put(dissector.bit_rate());
  put(static_cast<std::uint32_t>(wave.levels.size()));
  put(packet.channel);
  const std::size_t count = std::min(wave.levels.size(), kMostLevels);
  append_packed(octets, wave.levels, count, nullptr);
  if (packet.sent != nullptr) append_packed(octets, wave.levels, count, packet.sent);
  return octets;
}

// Octets that `payload` would have without its bound.
std::size_t whole_size(const Packet& packet, std::size_t kept) {
  const std::size_t beyond = packet.wave->levels.size() - std::min(packet.wave->levels.size(), kMostLevels);
  return kept + (beyond + 7) / 8;
}

class CaptureWriter {
 public:
  CaptureWriter(const trace::Recording& recording, const trace::Dissector& dissector)
      : recording_(recording), dissector_(dissector), faults_of_(recording) {}

  void write(std::string& to) {
    for (const Packet& packet : packets_of(recording_)) to += block(packet);
  }

 private:
  std::string block(const Packet& packet) {
    const std::string octets = payload(packet, dissector_);
    const std::int64_t ns = std::max<std::int64_t>(packet.wave->start.time_since_epoch().count(), 0) / 1000;
    Block block(6);
    block.put(packet.channel);
    block.put(static_cast<std::uint32_t>(static_cast<std::uint64_t>(ns) >> 32));
    block.put(static_cast<std::uint32_t>(ns & 0xFFFFFFFF));
    block.put(static_cast<std::uint32_t>(octets.size()));
    block.put(static_cast<std::uint32_t>(whole_size(packet, octets.size())));
    block.put_octets(octets);
    if (packet.change != nullptr) block.put_text(kComment, comment(packet));
    block.put(kFlags);
    block.put(std::uint16_t{4});
    block.put((packet.has_arrived ? kInbound : kOutbound) | (is_check_wrong(packet) ? kCheckError : 0U));
    return block.finish();
  }

  std::string comment(const Packet& packet) const {
    std::string text = packet.has_arrived ? "arrived so" : "changed on the way";
    text += ": " + trace::describe(*packet.change);
    for (const trace::Fault* fault : faults_of_.of(*packet.change)) text += "\n" + fault->text;
    return text;
  }

  // A line is told twice: as it was driven, and as its receiver heard it.
  bool is_check_wrong(const Packet& packet) {
    const auto tells = [&](bool heard) {
      std::unique_ptr<trace::Teller>& teller = tellers_[{packet.channel, heard}];
      if (teller == nullptr) teller = dissector_.teller();
      return teller->tell(*packet.wave).is_check_wrong;
    };
    if (packet.has_arrived) return tells(true);
    if (packet.change == nullptr) tells(true);
    return tells(false);
  }

  const trace::Recording& recording_;
  const trace::Dissector& dissector_;
  trace::FaultIndex faults_of_;
  std::map<std::pair<trace::Channel, bool>, std::unique_ptr<trace::Teller>> tellers_;
};

}  // namespace

std::string pcapng(const trace::Recording& recording, const trace::Dissector& dissector,
                   std::string_view application, std::string_view title) {
  std::string capture = section(application, title);
  for (const std::string& name : recording.channels) capture += interface(name);
  CaptureWriter(recording, dissector).write(capture);
  return capture;
}

}  // namespace fieldproof::reports
