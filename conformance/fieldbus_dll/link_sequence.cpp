#include "conformance/fieldbus_dll/link_sequence.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 5> kLinkSilences{0, 4, kLinkSettles, kLinkSettles, kLinkSettles};

constexpr int kMostBitsFlipped = 2;

void flip(line::Levels& half_bits, std::size_t first, std::uint32_t what, int& bits_left) {
  if (what < kHalfBitsOfAnOctet) return half_bits.flip(first + what);
  if (what >= kFlipsOfAnOctet || bits_left-- <= 0) return;
  const std::size_t bit = first + 2 * std::size_t{what - kHalfBitsOfAnOctet};
  half_bits.flip(bit);
  half_bits.flip(bit + 1);
}

}  // namespace

void expect_time_for_answers(const fieldbus_dll::LinkRules& link) {
  const unsigned most = (link.response_delay_slots - 1) * link.slot_time_octets;
  if (link.inter_pdu_delay_octets > 0 && link.inter_pdu_delay_octets <= most) return;
  throw kernel::Error(kernel::ErrorKind::configuration,
                      fmt::format("\"inter_pdu_delay_octets\" is {}; it is from 1, so that two DLPDUs are "
                                  "not one, to (V(MRD) - 1) x V(ST), {} octets",
                                  link.inter_pdu_delay_octets, most));
}

SequenceNumber link_silence() {
  return {"silence", 0, kLinkSettles, kLinkSettles, kLinkSilences, true};
}

bool send_link_command(LinkBench& bench, const Octets& octets, const SequenceCommand& command) {
  const line::Levels whole = half_bits_of_frame(with_frame_check(octets));
  line::Levels half_bits = whole;
  const std::size_t units = whole.size() / kHalfBitsOfAnOctet - 1;
  int bits_left = kMostBitsFlipped;
  // What is dropped is low whatever was flipped in it.
  for (const SequenceFaultKind kind : {SequenceFaultKind::flip, SequenceFaultKind::drop}) {
    for (const SequenceFault& fault : command.faults) {
      if (fault.kind != kind || fault.unit >= units) continue;
      const std::size_t first = (fault.unit + 1U) * kHalfBitsOfAnOctet;
      if (kind == SequenceFaultKind::drop) half_bits.fill(first, first + kHalfBitsOfAnOctet, false);
      if (kind == SequenceFaultKind::flip) flip(half_bits, first, fault.value, bits_left);
    }
  }
  const bool is_whole = half_bits == whole;
  bench.send_half_bits(std::move(half_bits));
  return is_whole;
}

}  // namespace fieldproof::conformance
