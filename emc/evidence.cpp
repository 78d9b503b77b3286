#include "emc/evidence.hpp"

#include <fmt/format.h>

#include "emc/residual/residual_error.hpp"

namespace fieldproof::emc {
namespace {

std::string counted(std::uint64_t count, std::string_view one, std::string_view several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::string what_came(const ImmunityResult& result) {
  const network::ErrorStatistics& counts = result.counts;
  const std::string rejected = counted(counts.refused, "exchange rejected", "exchanges rejected");
  switch (result.criterion) {
    case Criterion::a:
      return "nothing rejected";
    case Criterion::b:
      return counts.refused > 0 ? rejected : "an exchange for service not served";
    case Criterion::c:
      if (result.stops > 0) return counted(result.stops, "bus stop", "bus stops");
      return result.recovered_by_itself ? counted(1, "late recovery", "") : "a start was needed";
    case Criterion::d:
      if (counts.wrong_exchanges == 0) return result.reason;
      return counted(counts.wrong_exchanges, "exchange accepted wrong", "exchanges accepted wrong");
  }
  return "";
}

}  // namespace

Evidence evidence_of(const ImmunityResult& result) {
  Evidence evidence;
  if (!result.came_up || result.bursts == 0 || !result.was_disturbed()) return evidence;
  evidence.text = fmt::format("{} in {}", what_came(result), counted(result.bursts, "burst", "bursts"));
  const double none_of_the_bursts = upper_bound_of_share(0, result.bursts);
  if (result.criterion == Criterion::a) evidence.worse_than_a = none_of_the_bursts;
  if (result.criterion == Criterion::b) evidence.c = none_of_the_bursts;
  if (result.criterion != Criterion::d) evidence.d = upper_bound_of_share(0, result.counts.differed);
  return evidence;
}

std::string longer_run(const Evidence& evidence) {
  constexpr double kPercent = 100;
  std::string text;
  const auto add = [&text](std::string_view what, double share, std::string_view of) {
    text += fmt::format("{}{} in up to {:.2g} % of {}", text.empty() ? "" : ", ", what, share * kPercent, of);
  };
  if (evidence.worse_than_a) add("B or worse", *evidence.worse_than_a, "bursts");
  if (evidence.c) add("C", *evidence.c, "bursts");
  if (evidence.d && *evidence.d < 1) add("D", *evidence.d, "exchanges whose data differ");
  if (evidence.d && *evidence.d >= 1 && !evidence.worse_than_a) text += ", D (no data differed)";
  return text.empty() ? text : "a longer run could still show " + text;
}

std::string undetected_text(const network::ErrorStatistics& counts, std::string_view exchange) {
  if (counts.untouched == counts.sent) return fmt::format("no {} was hit", exchange);
  if (counts.differed == 0) return "in none did data differ, so the checks were not put to the test";
  return fmt::format("of those whose data differed at most {:.3g} pass unseen (one-sided 95 %)",
                     upper_bound_of_share(counts.wrong_exchanges, counts.differed));
}

}  // namespace fieldproof::emc
