#include "emc/random_flips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "harness/kernel/check.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::emc {
namespace {

double probability(double p, std::string_view of) {
  if (p >= 0 && p <= 1) return p;
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("{} cannot be {}; a probability is 0 to 1.", of, p));
}

// By multiplications alone, so that every machine gets the same.
double power(double base, std::uint64_t exponent) {
  double result = 1;
  for (; exponent != 0; exponent /= 2, base *= base) {
    if (exponent % 2 != 0) result *= base;
  }
  return result;
}

// The arrival that is being changed; made with the first change.
line::Waveform& changed(const line::Waveform& sent, line::Waveforms& arrivals, bool& is_changed) {
  if (!is_changed) arrivals.add(sent);
  is_changed = true;
  return arrivals.back();
}

}  // namespace

BernoulliChannel::BernoulliChannel(double flip_probability, kernel::Random random)
    : skip_(probability(flip_probability, "the flip probability")), random_(random), clean_(skip_(random_)) {}

bool BernoulliChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  const std::uint64_t size = sent.levels.size();
  if (clean_ >= size) {
    clean_ -= size;
    return false;
  }
  line::Waveform& arrival = arrivals.add(sent);
  std::uint64_t at = clean_;
  while (true) {
    arrival.levels.flip(at);
    ++flipped_;
    const std::uint64_t skip = skip_(random_);
    if (skip >= size - at - 1) {
      clean_ = skip - (size - at - 1);
      return true;
    }
    at += skip + 1;
  }
}

GilbertElliottProcess::GilbertElliottProcess(const GilbertElliott& parameters, kernel::Random random)
    : to_bad_(probability(parameters.to_bad, "the way to the bad state")),
      to_good_(probability(parameters.to_good, "the way to the good state")),
      good_flip_(probability(parameters.good_flip, "the flip probability of the good state")),
      bad_flip_(probability(parameters.bad_flip, "the flip probability of the bad state")),
      bad_share_(parameters.bad_share()),
      memory_(1 - parameters.to_bad - parameters.to_good),
      random_(random) {
  if (parameters.to_bad + parameters.to_good == 0) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        "a Gilbert-Elliott channel whose states are never left has no share of them; use a "
                        "Bernoulli channel.");
  }
  enter(random_.chance(parameters.bad_share()));
}

void GilbertElliottProcess::enter(bool bad) {
  is_bad_ = bad;
  // A state is stayed in for one bit at least.
  const std::uint64_t more = (bad ? to_good_ : to_bad_)(random_);
  stays_ = more == ~std::uint64_t{0} ? more : more + 1;
  clean_ = (bad ? bad_flip_ : good_flip_)(random_);
}

std::optional<std::uint64_t> GilbertElliottProcess::next_flip(std::uint64_t bits) {
  std::uint64_t passed = 0;
  while (true) {
    const std::uint64_t left = bits - passed;
    if (clean_ < stays_ && clean_ < left) {
      const std::uint64_t at = passed + clean_;
      stays_ -= clean_ + 1;
      clean_ = (is_bad_ ? bad_flip_ : good_flip_)(random_);
      if (stays_ == 0) enter(!is_bad_);
      return at;
    }
    const std::uint64_t step = std::min(stays_, left);
    stays_ -= step;
    clean_ -= std::min(step, clean_);
    passed += step;
    if (stays_ == 0) enter(!is_bad_);
    if (passed == bits) return std::nullopt;
  }
}

// The state after the bits comes from the chain of two states in closed form; how long it then stays and
// when it flips have no memory and are drawn anew.
void GilbertElliottProcess::skip(std::uint64_t bits) {
  const double now = is_bad_ ? 1 : 0;
  const double bad = bad_share_ + (now - bad_share_) * power(memory_, bits);
  enter(random_.chance(std::clamp(bad, 0.0, 1.0)));
}

GilbertElliottChannel::GilbertElliottChannel(const GilbertElliott& parameters, kernel::Random random)
    : process_(parameters, random) {}

void GilbertElliottChannel::pass_idle_time(const line::Waveform& sent) {
  if (sent.start > passed_until_) {
    __extension__ using Wide = unsigned __int128;
    const auto idle = static_cast<std::uint64_t>((sent.start - passed_until_).count());
    const auto bits =
        static_cast<std::uint64_t>(static_cast<Wide>(idle) * static_cast<std::uint64_t>(sent.rate) /
                                   static_cast<std::uint64_t>(kernel::kSecond.count()));
    process_.skip(bits);
  }
  passed_until_ = std::max(passed_until_, sent.end());
}

bool GilbertElliottChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  pass_idle_time(sent);
  const std::uint64_t size = sent.levels.size();
  bool is_changed = false;
  for (std::uint64_t passed = 0; passed < size;) {
    const auto flip = process_.next_flip(size - passed);
    if (!flip) break;
    changed(sent, arrivals, is_changed).levels.flip(passed + *flip);
    ++flipped_;
    passed += *flip + 1;
  }
  return is_changed;
}

BitListChannel::BitListChannel(Positions positions) : positions_(std::move(positions)) {
  FIELDPROOF_CHECK(std::ranges::is_sorted(*positions_), "the bits of a list are in order");
}

bool BitListChannel::pass(const line::Waveform& sent, line::Waveforms& arrivals) {
  const std::uint64_t number = passed_++;
  bool is_changed = false;
  const std::vector<Position>& positions = *positions_;
  for (; next_ < positions.size() && positions[next_].transmission == number; ++next_) {
    const std::uint64_t bit = positions[next_].bit;
    if (bit >= sent.levels.size()) {
      ++missed_;
      continue;
    }
    changed(sent, arrivals, is_changed).levels.flip(bit);
    ++flipped_;
  }
  return is_changed;
}

}  // namespace fieldproof::emc
