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

constexpr std::string_view kFramings =
    "data of 8 octets for its user, with 1 to 7 bits more in front of the end delimiter, 8: after a start "
    "delimiter and two octets, 9: after a frame for another in the same transmission, 10: after a start "
    "delimiter, two octets and three bits, 11: after other data for its user, 12: in finer levels, 13: after "
    "two frames for another";

void flip(line::Levels& half_bits, std::size_t first, std::uint32_t what, int& bits_left) {
  if (what < kHalfBitsOfAnOctet) return half_bits.flip(first + what);
  if (what >= kFlipsOfAnOctet || bits_left-- <= 0) return;
  const std::size_t bit = first + 2 * std::size_t{what - kHalfBitsOfAnOctet};
  half_bits.flip(bit);
  half_bits.flip(bit + 1);
}

void send_finely(LinkBench& bench, const line::Levels& half_bits) {
  constexpr unsigned kFineness = 8;
  line::Waveform wave{bench.now(), 2 * bench.link().bit_rate * kFineness, {}};
  for (std::size_t n = 0; n < half_bits.size(); ++n) wave.levels.append_fill(half_bits[n], kFineness);
  bench.send_wave(std::move(wave));
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

SequenceWord link_wait() {
  return {.word = "wait",
          .meaning = "silence of so many octet durations",
          .numbers = {{"octets", 1, 50'000, 40, kLinkWaits}},
          .weight = 3};
}

SequenceWord link_noise() {
  return {.word = "noise",
          .meaning = "levels on the line that are no frame",
          .numbers = {{"octets", 1, 60, 4}, link_silence()},
          .weight = 3,
          .is_no_frame = true};
}

SequenceWord link_one() {
  return {.word = "one", .meaning = "until the station has sent one DLPDU, or does not", .weight = 8};
}

std::vector<SequenceSetting> link_settings(const field::AnyTable& table, const void* as_made,
                                           std::span<const SettingBound> bounds,
                                           std::span<const OtherCodes> codes) {
  std::vector<SequenceSetting> all = sequence_settings(table, as_made, kFixedOfLink, bounds);
  for (SequenceSetting& setting : sequence_settings(table, as_made)) {
    const auto other = std::ranges::find_if(
        codes, [&](const OtherCodes& one) { return means_setting(one.names, setting.name); });
    if (other == codes.end()) continue;
    setting.likely = other->values;
    setting.is_likely_only = true;
    all.push_back(std::move(setting));
  }
  return all;
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

SequenceWord link_framed() {
  return {.word = "framed",
          .meaning = kFramings,
          .numbers = {{"how", 1, kAfterTwoOthers, kAfterAnother}, link_silence()},
          .weight = 4,
          .is_no_frame = true};
}

std::vector<Octets> send_framed(LinkBench& bench, std::int64_t framing, const Octets& other,
                                const Octets& octets) {
  constexpr std::size_t kBegun = 2 * kHalfBitsOfAnOctet;  // preamble and start delimiter
  constexpr std::size_t kCut = 6;                         // of the third octet, half bits
  constexpr unsigned kHalfBitsOfABit = 2;
  constexpr std::uint64_t kOneBit = 0b01;
  const line::Levels frame = half_bits_of_frame(with_frame_check(octets));
  if (framing == kFinely) {
    send_finely(bench, frame);
    return {octets};
  }
  line::Levels half_bits;
  std::vector<Octets> heard{octets};
  if (framing == kAfterAnother || framing == kTwoOfThem || framing == kAfterTwoOthers) {
    half_bits = half_bits_of_frame(with_frame_check(other));
    heard.insert(heard.begin(), other);
    if (framing == kAfterTwoOthers) {
      half_bits.append(line::Levels(half_bits), kHalfBitsOfAnOctet, half_bits.size() - kHalfBitsOfAnOctet);
      heard.insert(heard.begin(), other);
    }
  } else if (framing >= kAfterAStart) {
    const std::size_t more = framing == kWithinAnOctet ? kCut : 0;
    half_bits.append(half_bits_of_frame(octets), 0, kBegun + 2 * kHalfBitsOfAnOctet + more);
  }
  if (framing >= kAfterAStart) {
    half_bits.append(frame, kHalfBitsOfAnOctet, frame.size() - kHalfBitsOfAnOctet);
  } else {
    const std::size_t end = frame.size() - kHalfBitsOfAnOctet;
    half_bits.append(frame, 0, end);
    for (std::int64_t n = 0; n < framing; ++n) half_bits.append(kOneBit, kHalfBitsOfABit);
    half_bits.append(frame, end, kHalfBitsOfAnOctet);
    heard.clear();
  }
  bench.send_half_bits(std::move(half_bits));
  return heard;
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
