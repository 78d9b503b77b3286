// The telegram receiver fed with arbitrary levels at several rates and in any division into waveforms.
//
// Input: kind, rate or refinement, number of cuts with the place of the first, step to the next, then the
// levels, eight to an octet. Invariants: the telegrams are those of a bit-by-bit decoder at any refinement of
// the levels and in any division; at any other rate their number is bounded and the division changes nothing;
// a flushed receiver has nothing pending.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "fuzz/octet_reader.hpp"
#include "fuzz/reference_line.hpp"
#include "harness/kernel/check.hpp"
#include "harness/line/telegram_receiver.hpp"

namespace {

using fieldproof::fuzz::OctetReader;
using fieldproof::line::Levels;
using fieldproof::line::Telegram;
using fieldproof::line::TelegramCode;
using fieldproof::line::TelegramReceiver;
using fieldproof::line::Waveform;

constexpr std::int64_t kBitRate = 500'000;
constexpr std::int64_t kPicosecondsPerBit = 2'000'000;
constexpr std::size_t kLargestInput = 256;
constexpr std::size_t kMostSampledOctets = 16;
constexpr std::size_t kMostOctetsOffGrid = 4;  // parts of a line that share no grid are joined at a high rate

// Rates with a whole number of picoseconds to a level: a cut lies on the grid of what it cuts.
constexpr std::array<std::int64_t, 16> kExactRates = {
    250'000,   400'000,   500'000,   512'000,   625'000,   800'000,    1'000'000,  1'250'000,
    2'000'000, 2'500'000, 3'125'000, 4'000'000, 5'000'000, 10'000'000, 12'500'000, 20'000'000};

// Levels to a bit, by the same reason.
constexpr std::array<unsigned, 8> kRefinements = {2, 4, 5, 8, 10, 16, 20, 25};

struct Seen {
  std::int64_t start;
  std::uint8_t header;
  std::uint8_t data;
  friend bool operator==(const Seen&, const Seen&) = default;
};

class Log {
 public:
  void clear() { count_ = 0; }
  // A telegram has an edge of its own, so there are at most half as many as levels.
  void add(const Seen& seen) {
    FIELDPROOF_CHECK(count_ < seen_.size(), "a receiver gives no more telegrams than fit the line");
    seen_[count_++] = seen;
  }
  FIELDPROOF_UNINSTRUMENTED bool is_same(const Log& other) const {
    if (count_ != other.count_) return false;
    for (std::size_t n = 0; n < count_; ++n) {
      if (!(seen_[n] == other.seen_[n])) return false;
    }
    return true;
  }

 private:
  std::array<Seen, 4 * kLargestInput> seen_;
  std::size_t count_ = 0;
};

enum class Kind : std::uint8_t { bit_wide, refined, exact_rate, any_rate };

struct Script {
  Kind kind = Kind::bit_wide;
  std::uint8_t rate = 0;
  std::size_t cuts = 0;
  std::size_t first_cut = 0;
  std::size_t cut_step = 1;
};

Script read_script(OctetReader& input) {
  Script script;
  const std::uint8_t kind = input.octet();
  script.kind = static_cast<Kind>(kind & 3);
  script.rate = kind >> 2;
  const std::uint8_t cuts = input.octet();
  script.cuts = cuts & 3;
  script.first_cut = static_cast<std::size_t>(cuts >> 2) * 3 + 1;
  script.cut_step = std::size_t{input.octet()} + 1;
  return script;
}

// What one input works on, kept from one to the next so that no input pays for its making.
struct Workplace {
  const TelegramCode code{fieldproof::line::TelegramLayout{}};
  Waveform bits;  // the levels as the input has them
  Waveform line;  // at the rate in work
  Waveform part;
  Log expected;
  Log whole;
  Log divided;
};

void hear(const Waveform& wave, TelegramReceiver& receiver, Log& log) {
  receiver.receive(wave, [&](const Waveform& heard, const Telegram& telegram) {
    log.add({heard.time_of(telegram.level).time_since_epoch().count(), telegram.header, telegram.data});
  });
}

void finish(TelegramReceiver& receiver, Log& log) {
  receiver.flush([&](const Waveform& heard, const Telegram& telegram) {
    log.add({heard.time_of(telegram.level).time_since_epoch().count(), telegram.header, telegram.data});
  });
  FIELDPROOF_CHECK(receiver.pending_until() == fieldproof::kernel::kNever,
                   "a flushed receiver has nothing pending");
}

void hear_whole(Workplace& place) {
  place.whole.clear();
  TelegramReceiver receiver(place.code, kBitRate);
  hear(place.line, receiver, place.whole);
  finish(receiver, place.whole);
}

void hear_divided(Workplace& place, const Script& script) {
  place.divided.clear();
  TelegramReceiver receiver(place.code, kBitRate);
  const std::size_t size = place.line.levels.size();
  std::size_t at = 0;
  for (std::size_t cut = 0; at < size; ++cut) {
    const std::size_t count = cut < script.cuts ? (cut == 0 ? script.first_cut : script.cut_step) : size;
    place.part.start = place.line.time_of(at);
    place.part.rate = place.line.rate;
    place.part.levels.clear();
    place.part.levels.append(place.line.levels, at, std::min(count, size - at));
    at += place.part.levels.size();
    hear(place.part, receiver, place.divided);
  }
  finish(receiver, place.divided);
}

void expect_bit_by_bit(Workplace& place) {
  place.expected.clear();
  fieldproof::fuzz::hear_bit_by_bit(place.bits.levels, [&](const fieldproof::fuzz::HeardTelegram& heard) {
    place.expected.add(
        {static_cast<std::int64_t>(heard.level) * kPicosecondsPerBit, heard.header, heard.data});
  });
}

void read_levels(OctetReader& input, Workplace& place, Kind kind) {
  place.bits.rate = kBitRate;
  place.bits.levels.clear();
  const auto octets = input.take(kind == Kind::bit_wide   ? kLargestInput
                                 : kind == Kind::any_rate ? kMostOctetsOffGrid
                                                          : kMostSampledOctets);
  for (const std::uint8_t octet : octets) place.bits.levels.append(octet, 8);
}

void set_line(Workplace& place, const Script& script) {
  const unsigned times = script.kind == Kind::refined ? kRefinements[script.rate % kRefinements.size()] : 1;
  place.line.levels.clear();
  if (times == 1) {
    place.line.levels.append(place.bits.levels);
  } else {
    for (std::size_t n = 0; n < place.bits.levels.size(); ++n) {
      place.line.levels.append(place.bits.levels[n] ? ~std::uint64_t{0} : 0, times);
    }
  }
  place.line.rate = kBitRate * times;
  if (script.kind == Kind::exact_rate) place.line.rate = kExactRates[script.rate % kExactRates.size()];
  if (script.kind == Kind::any_rate) place.line.rate = 200'001 + 49'999 * std::int64_t{script.rate};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLargestInput) return -1;
  static Workplace place;
  OctetReader input(data, size);
  const Script script = read_script(input);
  read_levels(input, place, script.kind);
  set_line(place, script);
  const bool are_bits = script.kind == Kind::bit_wide || script.kind == Kind::refined;
  if (are_bits) {
    expect_bit_by_bit(place);
  } else {
    hear_whole(place);
  }
  const Log& right = are_bits ? place.expected : place.whole;
  hear_divided(place, script);
  FIELDPROOF_CHECK(script.kind == Kind::any_rate || place.divided.is_same(right),
                   "the telegrams are those of the line, however it is divided");
  return 0;
}
