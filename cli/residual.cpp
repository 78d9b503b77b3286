#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "cli/exit_code.hpp"
#include "cli/residual_text.hpp"
#include "cli/stored_document.hpp"
#include "cli/verbs.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

// `fieldproof residual`: how probably a frame check takes a corrupted telegram for a good one.
namespace fieldproof::cli {
namespace {

constexpr unsigned kWeightsShown = 16;
constexpr std::uint64_t kMostSamples = 1'000'000'000;
constexpr std::uint64_t kMostPerHour = 1'000'000'000'000;
constexpr std::uint64_t kMostReceivers = 1'000'000;

void require(const Settings& settings, std::string_view name, std::string_view example) {
  if (settings.is_set(name)) return;
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("residual needs --{0}; write for example --{0} {1}", name, example));
}

const line::FrameCheckParameters& check_from(const Settings& settings) {
  require(settings, "fcs", "CRC-16/IBM-3740");
  const std::string name = settings.text("fcs");
  const line::FrameCheckParameters* const found = line::find_frame_check(name);
  if (found == nullptr) {
    const std::vector<std::string_view> known = line::frame_check_names();
    settings.refuse("fcs", fmt::format("no frame check is called '{}'; the nearest are '{}'", name,
                                       fmt::join(config::nearest(name, std::span(known), 3), "', '")));
  }
  if (found->width > emc::kWidestCheck) {
    settings.refuse("fcs", fmt::format("'{}' has {} check bits; at most {} are computed", name, found->width,
                                       emc::kWidestCheck));
  }
  return *found;
}

std::vector<double> rates_from(const Settings& settings) {
  const std::vector<double> rates =
      settings.is_set("ber") ? settings.reals("ber") : std::vector<double>{1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.5};
  for (const double rate : rates) {
    if (rate == 0 || (rate >= emc::kLeastBer && rate <= emc::kGreatestBer)) continue;
    settings.refuse("ber", fmt::format("{:g} is no bit-error rate; write 0 or a number from {:g} to {:g}",
                                       rate, emc::kLeastBer, emc::kGreatestBer));
  }
  return rates;
}

emc::DualWeights weigh(Session& session, const line::FrameCheckParameters& check, unsigned bits) {
  session.terminal.begin_progress(emc::words_to_weigh(check), "words");
  emc::DualWeights dual =
      emc::dual_weights(check, bits, [&](std::uint64_t done) { session.terminal.progress(done); });
  session.terminal.end_progress();
  return dual;
}

ResidualPoint point_at(const Residual& residual, const emc::DualWeights& dual, double ber) {
  ResidualPoint point;
  point.ber = ber;
  point.probability = emc::undetected_error_probability(dual, ber);
  point.share_of_corrupted = emc::undetected_share_of_corrupted(dual, ber);
  if (residual.hamming_distance) {
    point.proper_bound = emc::proper_polynomial_bound(dual.width, dual.bits, *residual.hamming_distance, ber);
  }
  point.rate_per_hour = emc::residual_error_rate_per_hour(
      point.probability, static_cast<double>(residual.messages_per_hour), residual.receivers);
  return point;
}

void simulate(const Residual& residual, std::uint64_t samples, ResidualPoint& point) {
  const kernel::Random random(residual.seed);
  point.counted = emc::count_undetected_errors(*residual.check, residual.bits, point.ber, samples,
                                               random.split("counted"));
  point.sampled = emc::sample_undetected_errors(*residual.check, residual.bits, point.ber, samples,
                                                random.split("sampled"));
}

}  // namespace

int residual(Session& session) {
  const Settings& settings = session.settings;
  Residual result;
  result.check = &check_from(settings);
  require(settings, "bits", "2200");
  result.bits = static_cast<unsigned>(settings.number("bits", 1, emc::kMostBits));
  if (result.bits < result.check->width) {
    settings.refuse("bits",
                    fmt::format("{} bits are a code word with its check, and '{}' has {} check bits; "
                                "write {} or more",
                                result.bits, settings.text("fcs"), result.check->width, result.check->width));
  }
  result.messages_per_hour = settings.number("messages", 0, kMostPerHour);
  result.receivers = settings.number("receivers", 1, kMostReceivers);
  result.seed = settings.number("seed", 0, std::numeric_limits<std::uint64_t>::max());
  const std::uint64_t samples = settings.number("samples", 0, kMostSamples);
  const std::vector<double> rates = rates_from(settings);

  const emc::DualWeights dual = weigh(session, *result.check, result.bits);
  result.hamming_distance = emc::hamming_distance(dual);
  result.words = emc::code_word_counts(dual, std::min(result.bits, kWeightsShown));
  result.worst = emc::worst_undetected_error(dual);
  result.worst_of_usual = emc::worst_undetected_error(dual, kUsualBer);
  for (const double rate : rates) {
    result.points.push_back(point_at(result, dual, rate));
    if (samples > 0) simulate(result, samples, result.points.back());
  }
  write_document(session, "residual", residual_json(result));
  session.terminal.print(residual_text(result));
  return kAllAsExpected;
}

}  // namespace fieldproof::cli
