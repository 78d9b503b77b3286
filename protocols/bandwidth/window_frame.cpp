#include "protocols/bandwidth/window_frame.hpp"

namespace fieldproof::bandwidth {
namespace {

constexpr std::uint8_t kToken = 0x01;
constexpr std::uint8_t kPoll = 0x02;
constexpr std::uint8_t kAnswer = 0x03;
constexpr std::uint8_t kData = 0x10;
constexpr std::uint8_t kLastNode = 127;

void put_time(Octets& octets, kernel::Time time) {
  const auto count = static_cast<std::uint64_t>(time.time_since_epoch().count());
  for (int shift = 56; shift >= 0; shift -= 8) octets.push_back(static_cast<std::uint8_t>(count >> shift));
}

kernel::Time time_at(std::span<const std::uint8_t> octets, std::size_t at) {
  std::uint64_t count = 0;
  for (const std::uint8_t octet : octets.subspan(at, 8)) count = count << 8 | octet;
  return kernel::Time{kernel::Duration{static_cast<std::int64_t>(count)}};
}

std::optional<WindowFrame> server_frame_of(std::span<const std::uint8_t> octets) {
  if (octets.size() != kServerOctets || octets[1] > kLastNode) return std::nullopt;
  WindowFrame frame;
  frame.byte = PeriodicByte(octets[2]);
  frame.type = octets[0] == kToken  ? FrameType::token
               : octets[0] == kPoll ? FrameType::poll
                                    : FrameType::answer;
  (frame.type == FrameType::answer ? frame.source : frame.destination) = octets[1];
  return frame;
}

}  // namespace

Octets octets_of(const WindowFrame& frame, std::size_t data_octets) {
  switch (frame.type) {
    case FrameType::token:
      return {kToken, frame.destination, frame.byte.octet()};
    case FrameType::poll:
      return {kPoll, frame.destination, frame.byte.octet()};
    case FrameType::answer:
      return {kAnswer, frame.source, frame.byte.octet()};
    case FrameType::data:
      break;
  }
  Octets octets{static_cast<std::uint8_t>(kData | static_cast<unsigned>(frame.packet)), frame.destination,
                frame.source, frame.byte.octet()};
  if (frame.packet == Packet::periodic) {
    put_time(octets, frame.generated);
    put_time(octets, frame.sample);
  }
  octets.resize(std::max(octets.size(), kDataHeaderOctets + data_octets), frame.source);
  return octets;
}

std::optional<WindowFrame> window_frame_of(std::span<const std::uint8_t> octets) {
  if (octets.empty()) return std::nullopt;
  if (octets[0] >= kToken && octets[0] <= kAnswer) return server_frame_of(octets);
  const auto packet = static_cast<Packet>(octets[0] & 0x0F);
  const bool is_data = (octets[0] & 0xF0) == kData && packet >= Packet::real_time &&
                       packet <= Packet::non_real_time && octets.size() >= kDataHeaderOctets;
  if (!is_data || octets[1] > kLastNode || octets[2] > kLastNode) return std::nullopt;
  WindowFrame frame{.type = FrameType::data,
                    .packet = packet,
                    .destination = octets[1],
                    .source = octets[2],
                    .byte = PeriodicByte(octets[3])};
  if (packet != Packet::periodic) return frame;
  if (octets.size() < kDataHeaderOctets + kDatumOctets) return std::nullopt;
  frame.generated = time_at(octets, kDataHeaderOctets);
  frame.sample = time_at(octets, kDataHeaderOctets + 8);
  return frame;
}

}  // namespace fieldproof::bandwidth
