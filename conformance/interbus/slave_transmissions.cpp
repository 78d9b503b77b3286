#include "conformance/interbus/slave_transmissions.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/interbus/moved_edges.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::int64_t kEighths = 8;
constexpr std::size_t kGap = 4;  // idle bits after each telegram
constexpr std::size_t kPitch = line::kDataTelegramLevels + kGap;

std::size_t level_of(const line::Levels& cycle, std::size_t pitch, CutPlace at) {
  const std::size_t telegrams = cycle.size() / pitch;
  return static_cast<std::size_t>(at.telegram) % telegrams * pitch + static_cast<std::size_t>(at.level);
}

line::Levels finer(const line::Levels& levels, std::int64_t times) {
  line::Levels fine;
  for (std::size_t n = 0; n < levels.size(); ++n)
    fine.append_fill(levels[n], static_cast<std::size_t>(times));
  return fine;
}

line::Levels glitch_of(std::int64_t eighths) {
  line::Levels levels;
  levels.append_idle(kEighths);
  levels.append_fill(false, static_cast<std::size_t>(eighths));
  levels.append_idle(kEighths);
  return levels;
}

// The cycle with these words, inverted in each second one.
line::Levels cycle_of(SlaveBench& bench, std::int64_t word, unsigned gap) {
  return bench.direct_data_cycle(words_in_turn(bench, word, ~word & 0xFFFF), gap);
}

}  // namespace

std::vector<std::uint16_t> words_in_turn(const SlaveBench& bench, std::int64_t even, std::int64_t odd) {
  std::vector<std::uint16_t> words;
  for (unsigned n = 0; n < bench.words(); ++n)
    words.push_back(static_cast<std::uint16_t>((n % 2 == 0 ? even : odd) ^ (n / 2 * 0x0101)));
  return words;
}

void drive_cut_cycle(SlaveBench& bench, std::int64_t word, CutPlace at, bool loses_supply) {
  const line::Levels whole = cycle_of(bench, word, kGap);
  line::Waveform wave{bench.now(), bench.rules().bit_rate, whole.slice(0, level_of(whole, kPitch, at))};
  if (!loses_supply) return bench.drive_at_receiver(wave);
  bench.drive_until_lost(wave);
  bench.silence(kernel::kMillisecond);
  bench.set_power(true);
}

void drive_in_three(SlaveBench& bench, std::int64_t word, CutPlace at, std::int64_t levels) {
  const line::Levels whole = cycle_of(bench, word, kGap);
  const std::size_t first = level_of(whole, kPitch, at);
  const std::size_t second = std::min(first + static_cast<std::size_t>(levels), whole.size() - 1);
  bench.drive_at_receiver(whole, std::array{first, second});
}

void drive_cut_at_missing_stop(SlaveBench& bench, std::int64_t word, std::int64_t telegram) {
  line::Levels whole = cycle_of(bench, word, 0);
  const std::size_t end = level_of(whole, line::kDataTelegramLevels, {telegram, line::kDataTelegramLevels});
  whole.set(end - 1, false);
  bench.drive_at_receiver(whole, std::array{std::min(end, whole.size() - 1)});
}

void drive_glitch_within(SlaveBench& bench, std::int64_t word, std::int64_t telegram, std::int64_t eighths) {
  const line::Levels whole = cycle_of(bench, word, kGap);
  // In the middle of the gap, so that a bit and more of idle line is on both sides.
  const std::size_t bit = level_of(whole, kPitch, {telegram, line::kDataTelegramLevels + kGap / 2 - 1});
  line::Levels levels = finer(whole, kEighths);
  for (std::size_t n = 0; n < static_cast<std::size_t>(eighths); ++n) levels.set(bit * kEighths + n, false);
  line::Waveform wave{bench.now(), bench.rules().bit_rate * kEighths, std::move(levels)};
  bench.drive_at_receiver(wave);
}

void return_glitch(SlaveBench& bench, bool on_branch, std::int64_t eighths) {
  line::Waveform wave{bench.now(), bench.rules().bit_rate * kEighths, glitch_of(eighths)};
  bench.send_back(on_branch, wave);
}

void return_pulses(SlaveBench& bench, bool on_branch, std::int64_t octet, std::int64_t longer,
                   std::int64_t per_mille) {
  TrainWriter writer(bench.rules());
  for (const std::int64_t one : {octet, ~octet & 0xFF})
    writer.telegram(line::kDataTelegram, static_cast<std::uint8_t>(one));
  const std::int64_t rate = bench.rules().bit_rate * (1000 + per_mille) / 1000;
  line::Waveform wave{bench.now(), rate * kEdgesPerBit,
                      with_moved_edges(writer.levels(), [&](bool falls) { return falls ? 0 : longer; })};
  bench.send_back(on_branch, wave);
}

}  // namespace fieldproof::conformance
