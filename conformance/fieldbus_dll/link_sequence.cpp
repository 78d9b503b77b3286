#include "conformance/fieldbus_dll/link_sequence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::array<std::int64_t, 5> kLinkSilences{0, 4, kLinkSettles, kLinkSettles, kLinkSettles};

constexpr std::array<std::int64_t, 25> kLinkLengths{0, 0, 0, 0, 0, 0, 0, 0,  0,  0,  0, 0, 0,
                                                    0, 0, 0, 0, 0, 0, 0, -9, -2, -1, 1, 2};
constexpr std::array<std::int64_t, 6> kLinkWaits{1, 40, 260, 4'000, 8'200, 40'000};
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

SequenceNumber link_length() {
  return {"more", -9, 2, 0, kLinkLengths, true};
}

SequenceWord link_supply() {
  return {.word = "supply",
          .meaning = "0: goes, 1: comes, 2: goes and comes again",
          .numbers = {{"how", kSupplyGoes, kSupplyReturns, kSupplyReturns}},
          .weight = 1,
          .is_loss = true};
}

SequenceNumber link_wait() {
  return {"octets", 1, 50'000, 40, kLinkWaits};
}

Octets with_length(Octets dlpdu, std::int64_t more) {
  const auto size = std::max<std::int64_t>(1, static_cast<std::int64_t>(dlpdu.size()) + more);
  dlpdu.resize(static_cast<std::size_t>(size));
  return dlpdu;
}

void send_noise(LinkBench& bench, std::int64_t octets) {
  line::Levels half_bits = half_bits_of_frame({}, static_cast<unsigned>(octets));
  half_bits.fill(static_cast<std::size_t>(octets) * kHalfBitsOfAnOctet, half_bits.size(), false);
  bench.send_half_bits(std::move(half_bits));
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
