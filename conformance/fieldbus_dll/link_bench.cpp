#include "conformance/fieldbus_dll/link_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::conformance {

namespace {

std::span<const fault::Stress> stresses_at(std::int64_t bit_rate, const LinkStresses* all) {
  const auto found = all == nullptr ? LinkStresses::const_iterator{} : all->find(bit_rate);
  if (all == nullptr || found == all->end()) return {};
  return found->second;
}

// Octets of the longest DLPDU without its check, and more: nobody has to drive so long.
constexpr std::size_t kLongestDlpdu = 300;

}  // namespace

LinkBench::LinkBench(const fieldbus_dll::LinkRules& link, std::uint64_t seed, Volume volume,
                     const LinkStresses* stresses)
    : LineBench(seed, volume, stresses_at(link.bit_rate, stresses),
                LineWatch(fieldbus_dll::octets(link, 1), fieldbus_dll::frame_time(link, kLongestDlpdu))),
      link_(link),
      driven_(link.bit_rate),
      sent_(link.bit_rate),
      arrived_(link.bit_rate) {}

segment::MediumPort& LinkBench::attach_station(segment::Station& station, const fault::Plan& plan) {
  attach_iut(station, "station");
  place().sense_activity();
  place().tap_driven(driven_);
  place().tap_arrived(ear_);
  tester().tap_driven(sent_);
  watch(place());
  install(plan, link_.bit_rate);
  return place();
}

Octets LinkBench::numbered_data(std::size_t size) {
  ++number_;
  Octets data{static_cast<std::uint8_t>(number_ >> 8), static_cast<std::uint8_t>(number_ & 0xFF)};
  while (data.size() < size) data.push_back(random_octet());
  data.resize(size);
  return data;
}

void LinkBench::run_until(kernel::Time time) {
  if (time > now()) segment().run_until(time);
}

kernel::Time LinkBench::send_wave(line::Waveform wave) {
  wave.start = now();
  return drive_to_end(wave);
}

kernel::Time LinkBench::send_half_bits(line::Levels half_bits) {
  return send_wave({now(), 2 * link_.bit_rate, std::move(half_bits)});
}

kernel::Time LinkBench::send(std::span<const std::uint8_t> octets) {
  return send_half_bits(half_bits_of_frame(with_frame_check(octets), link_.preamble_octets));
}

kernel::Time LinkBench::send_at(kernel::Time start, std::span<const std::uint8_t> octets) {
  // A station that drives over itself ends a DLPDU while another lasts.
  line::Waveform wave{std::max(start, now()), 2 * link_.bit_rate,
                      half_bits_of_frame(with_frame_check(octets), link_.preamble_octets)};
  const kernel::Time end = wave.end();
  tester().drive(wave);
  return end;
}

void LinkBench::begin_stress(const fault::Stress& stress, kernel::Duration later) {
  if (!has_been_stressed()) place().tap_arrived(arrived_);
  // The levels of the line are half bits.
  begin_stress_at(stress, place(), 2 * link_.bit_rate, now() + later);
}

std::vector<DrivenDlpdu> LinkBench::arrived_unsent() const {
  std::vector<DrivenDlpdu> all;
  for (const DrivenDlpdu& one : arrived_.all()) {
    const bool is_sent =
        std::ranges::any_of(sent_.all(), [&](const DrivenDlpdu& sent) { return sent.octets == one.octets; });
    if (one.has_right_check && !is_sent) all.push_back(one);
  }
  return all;
}

bool LinkBench::next_begins(kernel::Time limit) {
  // In steps of an octet: the ear knows at once what the IUT begins, and no frame is as short.
  run_in_steps(limit, octets(1), [&] { return driven_.has_new(limit); });
  return driven_.has_new(limit);
}

std::optional<DrivenDlpdu> LinkBench::next(kernel::Time limit) {
  if (!next_begins(limit)) return std::nullopt;
  const DrivenDlpdu first = driven_.take_one();
  run_until(first.end);
  return first;
}

std::vector<DrivenDlpdu> LinkBench::listen() {
  constexpr std::size_t kMost = 1'000;
  std::vector<DrivenDlpdu> all;
  while (all.size() < kMost) {
    auto one = next();
    if (!one) break;
    all.push_back(std::move(*one));
  }
  return all;
}

std::vector<std::string> LinkBench::decode_lines(kernel::Time time) {
  DecodedLines lines;
  const auto tell = [&](std::string_view who, const std::vector<DrivenDlpdu>& dlpdus) {
    for (const DrivenDlpdu& one : dlpdus) {
      lines.add(one.begin, fmt::format("{} {} to {}: {}", who, kernel::describe(one.begin),
                                       kernel::describe(one.end), words(one)));
    }
  };
  tell("tester drove", sent_.all());
  tell("station drove", driven_.all());
  lines.add(supply_);
  return lines.around(time);
}

}  // namespace fieldproof::conformance
