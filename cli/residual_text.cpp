#include "cli/residual_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "harness/judge/verdict.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

// Formula of the proper polynomial and of the rate per hour; nobody has read the standard for it.
constexpr const char* kSafetySource = "IEC 61784-3";
constexpr auto kSafetyStanding = judge::Standing::memory;

std::string unverified() {
  return fmt::format("{} [{}, unverified]", kSafetySource, judge::name(kSafetyStanding));
}

std::string polynomial_text(const line::FrameCheckParameters& check) {
  return fmt::format("0x{:0{}X}", static_cast<std::uint64_t>(check.poly), (check.width + 3) / 4);
}

std::string weights_text(const Residual& residual) {
  if (!residual.hamming_distance) return "no room for a message: every corrupted telegram is detected\n";
  std::string text = fmt::format(
      "Hamming distance {}; patterns of flips that nobody sees (all of {} or fewer flips, exact)\n",
      *residual.hamming_distance, residual.words.size() - 1);
  for (std::size_t weight = 1; weight < residual.words.size(); ++weight) {
    if (residual.words[weight] == 0) continue;
    text += fmt::format("  {:>3} flips  {}\n", weight, residual.words[weight].str());
  }
  return text;
}

std::string worst_text(const emc::WorstError& worst, double up_to) {
  return fmt::format("largest probability up to a bit-error rate of {:g}: {:.6g} at {:.6g}{}\n", up_to,
                     worst.probability, worst.ber,
                     worst.rises_throughout ? ", it rises throughout" : ", it does NOT rise throughout");
}

std::string simulated_text(const ResidualPoint& point, std::uint64_t seed) {
  if (!point.counted || !point.sampled) return {};
  const emc::CountedErrors& counted = *point.counted;
  const emc::SampledErrors& sampled = *point.sampled;
  const auto without_hit = std::count_if(sampled.weights.begin(), sampled.weights.end(),
                                         [](const emc::SampledWeight& one) { return one.hits == 0; });
  std::string text =
      fmt::format("\nsimulated at {:g}, seed {}; exact {:.6g}\n", point.ber, seed, point.probability);
  text += fmt::format(
      "  counted   {} telegrams, {} corrupted, {} undetected; of corrupted at most {:.3g} (one-sided 95 %), "
      "exact "
      "{:.3g}\n",
      counted.samples, counted.corrupted, counted.undetected,
      emc::upper_bound_of_share(counted.undetected, counted.corrupted), point.share_of_corrupted);
  text += fmt::format("  sampled   {:.6g}, standard error {:.2g}; sum of w_k f_k over {} weights k",
                      sampled.probability, sampled.standard_error, sampled.weights.size());
  if (!sampled.weights.empty()) {
    text += fmt::format(" ({} to {}, {} of them without a hit)", sampled.weights.front().weight,
                        sampled.weights.back().weight, without_hit);
  }
  text += fmt::format(
      "\n            w_k exact, f_k from {} patterns each with the last {} looked up; {:.2g} of all "
      "telegrams left "
      "out\n",
      sampled.samples_per_weight, sampled.looked_up == 1 ? "flip" : "two flips", sampled.left_out);
  return text;
}

// More than rounding: the formula is no bound for this check at this length.
bool is_bound_exceeded(const ResidualPoint& point) {
  return point.proper_bound && point.probability > *point.proper_bound * (1 + 1e-9);
}

ordered_json worst_json(const emc::WorstError& worst) {
  return {
      {"ber", worst.ber}, {"probability", worst.probability}, {"rises_throughout", worst.rises_throughout}};
}

ordered_json counted_json(const emc::CountedErrors& counted) {
  return {{"samples", counted.samples},
          {"corrupted", counted.corrupted},
          {"undetected", counted.undetected},
          {"upper_bound_95", emc::upper_bound_of_share(counted.undetected, counted.corrupted)}};
}

ordered_json sampled_json(const emc::SampledErrors& sampled) {
  ordered_json weights = ordered_json::array();
  for (const emc::SampledWeight& one : sampled.weights) {
    weights.push_back({{"weight", one.weight},
                       {"probability", one.probability},
                       {"hits", one.hits},
                       {"share", one.share},
                       {"standard_error", one.error}});
  }
  return {{"estimator", "sum of w_k f_k: patterns of k flips drawn uniformly, the last flips looked up"},
          {"samples_per_weight", sampled.samples_per_weight},
          {"looked_up", sampled.looked_up},
          {"probability", sampled.probability},
          {"standard_error", sampled.standard_error},
          {"left_out", sampled.left_out},
          {"weights", std::move(weights)}};
}

ordered_json point_json(const ResidualPoint& point) {
  ordered_json json = {{"ber", point.ber},
                       {"probability", point.probability},
                       {"share_of_corrupted", point.share_of_corrupted},
                       {"proper_bound", nullptr},
                       {"rate_per_hour", point.rate_per_hour}};
  if (point.proper_bound) json["proper_bound"] = *point.proper_bound;
  json["proper_bound_exceeded"] = is_bound_exceeded(point);
  if (point.counted) json["counted"] = counted_json(*point.counted);
  if (point.sampled) json["sampled"] = sampled_json(*point.sampled);
  return json;
}

}  // namespace

std::string residual_text(const Residual& residual) {
  std::string text =
      fmt::format("{}: {} check bits, polynomial {}, {} bits of message and check\n", residual.check->name,
                  residual.check->width, polynomial_text(*residual.check), residual.bits);
  text += weights_text(residual);
  text += worst_text(residual.worst, emc::kGreatestBer);
  text += worst_text(residual.worst_of_usual, kUsualBer);
  text += fmt::format("\n{:>10}  {:>14}  {:>14}  {:>14}  {:>14}\n", "bit-errors", "undetected",
                      "of corrupted", "if proper (1)", "per hour (1)");
  for (const ResidualPoint& point : residual.points) {
    const std::string bound = point.proper_bound ? fmt::format("{:.6g}{}", *point.proper_bound,
                                                               is_bound_exceeded(point) ? " !" : "")
                                                 : "-";
    text += fmt::format("{:>10g}  {:>14.6g}  {:>14.6g}  {:>14}  {:>14.6g}\n", point.ber, point.probability,
                        point.share_of_corrupted, bound, point.rate_per_hour);
  }
  text += fmt::format("(1) formulas of {}; {} messages per hour, {} receivers\n", unverified(),
                      residual.messages_per_hour, residual.receivers);
  if (std::any_of(residual.points.begin(), residual.points.end(), is_bound_exceeded)) {
    text += " !  the exact probability is larger: the formula is no bound here\n";
  }
  for (const ResidualPoint& point : residual.points) text += simulated_text(point, residual.seed);
  return text;
}

std::string residual_json(const Residual& residual) {
  ordered_json words = ordered_json::array();
  for (std::size_t weight = 0; weight < residual.words.size(); ++weight) {
    if (residual.words[weight] == 0) continue;
    words.push_back({{"weight", weight}, {"count", residual.words[weight].str()}});
  }
  ordered_json json = {{"schema", "fieldproof/residual/1"},
                       {"frame_check", residual.check->name},
                       {"width", residual.check->width},
                       {"polynomial", polynomial_text(*residual.check)},
                       {"bits", residual.bits},
                       {"hamming_distance", nullptr},
                       {"weights_up_to", residual.words.size() - 1},
                       {"weights", std::move(words)},
                       {"worst", worst_json(residual.worst)},
                       {"worst_up_to_usual", worst_json(residual.worst_of_usual)},
                       {"usual_ber", kUsualBer},
                       {"safety_source", kSafetySource},
                       {"safety_standing", judge::name(kSafetyStanding)},
                       {"messages_per_hour", residual.messages_per_hour},
                       {"receivers", residual.receivers},
                       {"seed", std::to_string(residual.seed)},
                       {"points", ordered_json::array()}};
  if (residual.hamming_distance) json["hamming_distance"] = *residual.hamming_distance;
  for (const ResidualPoint& point : residual.points) json["points"].push_back(point_json(point));
  return json.dump(2) + "\n";
}

}  // namespace fieldproof::cli
