#include "harness/line/telegram_receiver.hpp"

#include <algorithm>

namespace fieldproof::line {
namespace {

static_assert(kDataTelegramLevels <= Sampler::kMostBits);

constexpr std::int64_t kJoinedLevelsPerBit = 320;

// The number of whole levels from `from` to `to` when both lie on one grid, -1 otherwise.
std::int64_t levels_between(kernel::Time from, kernel::Time to, std::int64_t rate) {
  if (to < from) return -1;
  const std::int64_t whole = kernel::levels_within(to - from, rate);
  for (const std::int64_t count : {whole, whole + 1}) {
    if (kernel::level_time(from, count, rate) == to) return count;
  }
  return -1;
}

// The first level of a line that begins at `start` whose middle lies at or after `time`.
std::size_t first_middle_at(kernel::Time start, std::int64_t rate, kernel::Time time) {
  if (time <= start) return 0;
  const std::int64_t halves = kernel::levels_within(time - start, 2 * rate);
  std::int64_t n = std::max<std::int64_t>(0, (halves - 1) / 2 - 1);  // one less, for the rounding
  while (kernel::level_time(start, 2 * n + 1, 2 * rate) < time) ++n;
  return static_cast<std::size_t>(n);
}

// Appends up to level `until` what a look at the middle of each level finds in the waveform, run by run.
void append_sampled(Levels& levels, const Waveform& wave, kernel::Time start, std::int64_t rate,
                    std::size_t until) {
  const auto fill_until = [&](bool level, kernel::Time end) {
    const std::size_t to = std::min(until, first_middle_at(start, rate, end));
    if (to > levels.size()) levels.append_fill(level, to - levels.size());
  };
  fill_until(true, wave.start);
  for (std::size_t n = 0; n < wave.levels.size() && levels.size() < until;) {
    const std::size_t next = wave.levels.end_of_run(n);
    fill_until(wave.levels[n], wave.time_of(next));
    n = next;
  }
  if (levels.size() < until) levels.append_idle(until - levels.size());
}

std::size_t levels_until(kernel::Time start, kernel::Time end, std::int64_t rate) {
  if (end <= start) return 0;
  std::int64_t count = kernel::levels_within(end - start, rate);
  while (kernel::level_time(start, count, rate) < end) ++count;
  return static_cast<std::size_t>(count);
}

}  // namespace

TelegramReceiver::TelegramReceiver(const TelegramCode& code, std::int64_t bit_rate,
                                   TelegramReceiverOptions options)
    : code_(code), bit_rate_(bit_rate), options_(options), sampler_(options.sampling, bit_rate) {}

bool TelegramReceiver::sample_telegram(const Waveform& wave, std::size_t& at, Telegram& telegram) {
  sampler_.look_at(wave);
  while ((at = falling_edge(wave.levels, at)) < wave.levels.size()) {
    sampler_.start(at);
    // Whether it is a start bit is not known yet: the next reception may go on with it.
    if (!sampler_.is_decided(0)) return false;
    std::uint64_t sampled = 0;
    for (unsigned bit = 0; bit < kDataTelegramLevels; ++bit) {
      if (sampler_.sample(bit)) sampled |= std::uint64_t{1} << bit;
    }
    if ((sampled & 1) != 0) {
      if (options_.validates_start) {
        at = sampler_.idle_seen();
        continue;
      }
      sampled &= ~std::uint64_t{1};
    }
    telegram = code_.from_levels(sampled);
    telegram.level = static_cast<std::uint32_t>(at);
    if (!sampler_.is_decided(telegram.levels() - 1)) return false;
    at = sampler_.behind(telegram.levels() - 1);
    // A line that stays low after a missing stop bit is no start bit; one that has risen by then may fall.
    if (!wave.levels[at - 1]) at = next_idle(wave.levels, at);
    return true;
  }
  return false;
}

std::size_t TelegramReceiver::next_idle(const Levels& levels, std::size_t from) {
  while (from < levels.size() && !levels[from]) ++from;
  return from;
}

bool TelegramReceiver::begins_before(const Waveform& wave, std::size_t from, kernel::Time time) {
  const std::size_t edge = falling_edge(wave.levels, from);
  return edge < wave.levels.size() && wave.time_of(edge) < time;
}

void TelegramReceiver::keep(const Waveform& wave, std::size_t from) {
  pending_.start = wave.time_of(from);
  pending_.rate = wave.rate;
  pending_.levels.clear();
  pending_.levels.append(wave.levels, from, wave.levels.size() - from);
  pending_until_ = kernel::level_time(pending_.start, kDataTelegramLevels, bit_rate_);
  has_pending_ = true;
}

std::size_t TelegramReceiver::idle_levels(const Waveform& wave) const {
  return static_cast<std::size_t>((kDataTelegramLevels + 1) * wave.rate / bit_rate_ + 1);
}

bool TelegramReceiver::join_on_grid(const Waveform& second) {
  if (pending_.rate != second.rate) return false;
  const std::int64_t offset = levels_between(pending_.start, second.start, second.rate);
  if (offset < static_cast<std::int64_t>(pending_.levels.size())) return false;
  joined_ = pending_;
  joined_.levels.append_idle(static_cast<std::size_t>(offset) - joined_.levels.size());
  joined_.levels.append(second.levels);
  return true;
}

// At a multiple of the sixty-fourths in which bursts are written, of the sixteenths at which bits are sampled
// and of the tenths and twentieths in which people write glitches. It does not grow when joins follow joins.
void TelegramReceiver::join_head(const Waveform& second) {
  const kernel::Time head = kernel::level_time(second.start, kDataTelegramLevels + 1, bit_rate_);
  joined_.start = pending_.start;
  joined_.levels.clear();
  joined_.rate = std::max({pending_.rate, second.rate, bit_rate_ * kJoinedLevelsPerBit});
  append_sampled(joined_.levels, pending_, joined_.start, joined_.rate,
                 levels_until(joined_.start, second.start, joined_.rate));
  append_sampled(joined_.levels, second, joined_.start, joined_.rate,
                 levels_until(joined_.start, std::min(head, second.end()), joined_.rate));
}

}  // namespace fieldproof::line
