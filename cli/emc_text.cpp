#include "cli/emc_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "cli/emc_beside.hpp"
#include "emc/evidence.hpp"
#include "harness/field/facts.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

std::string recovery_text(const emc::ImmunityResult& result) {
  if (result.recovered_by_itself) return fmt::format("{}", result.recovery_exchanges);
  return result.recovered_after_start ? "after a start" : "never";
}

std::string does_not_come_up(const emc::ImmunityResult& result) {
  if (result.complaint.empty()) return "  the network does not come up on a quiet line\n";
  return fmt::format("  the network does not work on a quiet line: {}\n",
                     reports::escaped_line(result.complaint));
}

std::string channel_line(const EmcTest& test) {
  const std::string where = fmt::format("bsc {:<12g}", test.flip_probability);
  if (!test.result.came_up) return where + does_not_come_up(test.result);
  const network::ErrorStatistics& counts = test.result.counts;
  const std::string line =
      fmt::format("{} {:>9} {:>9} {:>9} {:>9} {:>8} {:>6} {:>6}", where, counts.sent, counts.untouched,
                  counts.without_effect, counts.refused, test.result.longest_bad_run, test.result.stops,
                  counts.wrong_exchanges);
  const std::string complaint = test.result.complaint.empty()
                                    ? ""
                                    : fmt::format("    {}\n", reports::escaped_line(test.result.complaint));
  if (!test.has_theory()) return line + fmt::format(" {:>12} {:>8}\n", "-", "-") + complaint;
  return line + fmt::format(" {:>12.3g} {:>8.3g}\n", test.expected_wrong(), test.chance_of_count()) +
         complaint;
}

std::string frame_residual_text(const emc::FrameResidual& residual, std::uint64_t differed) {
  return fmt::format(
      "{} over {} bits lets at most {:.3g} of the corrupted frames pass (exact, at the worst bit-error rate, "
      "{:.2g}): of these {:.3g}\n"
      "per hour {:.3g} frames pass wrong at a bit-error rate of 1e-2 (formula of IEC 61784-3, unverified)\n",
      residual.frame_check, residual.bits, residual.worst_share, residual.worst_ber,
      static_cast<double>(differed) * residual.worst_share, residual.rate_per_hour);
}

std::string acceptance_text(const EmcCampaign& campaign) {
  std::string text = "the numbers by which C and D are decided (fieldproof explain network/acceptance):\n";
  for (const field::Fact& fact : field::facts_of(network::kAcceptanceTable, campaign.acceptance)) {
    text += fmt::format("  {:<24} {:>12}  [{}] {}\n", fact.name, fact.value, judge::name(fact.standing),
                        fact.source);
  }
  return text;
}

std::string burst_columns(const emc::ImmunityResult& result) {
  const network::ErrorStatistics& counts = result.counts;
  return fmt::format("  {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>8} {:>7} {:>7} {:>8} {:>14} {:>6} {:>8}\n",
                     emc::name(result.criterion), counts.sent, counts.untouched, counts.without_effect,
                     counts.refused, counts.wrong_exchanges, counts.retried,
                     counts.detected - std::min(counts.detected, counts.partly_latched),
                     counts.missed_outputs, result.longest_bad_run, recovery_text(result), result.stops,
                     counts.cleared_outputs);
}

// The letter with what it rests on, and what decided.
std::string evidence_lines(const emc::ImmunityResult& result) {
  const emc::Evidence evidence = emc::evidence_of(result);
  const std::string more = emc::longer_run(evidence);
  std::string text;
  if (!evidence.text.empty())
    text += fmt::format("    {}: {}{}{}\n", emc::name(result.criterion), evidence.text,
                        more.empty() ? "" : "; ", more);
  if (!result.decided_by.empty())
    text += fmt::format("    {}: {}\n", emc::name(result.criterion), result.decided_by);
  return text;
}

}  // namespace

std::string emc_table_head(bool has_bursts) {
  if (!has_bursts) {
    return fmt::format("{:<16} {:>9} {:>9} {:>9} {:>9} {:>8} {:>6} {:>6} {:>12} {:>8}\n", "channel",
                       "exposed", "untouched", "no effect", "rejected", "longest", "stops", "wrong",
                       "at most", "chance");
  }
  return fmt::format(
      "{:<14} {:>8} {:>3}  {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>8} {:>7} {:>7} {:>8} {:>14} {:>6} {:>8}\n",
      "level", "pulses", "pol", "criterion", "exposed", "untouched", "no effect", "rejected", "wrong",
      "retries", "held", "missed", "longest", "recovery", "stops", "cleared");
}

std::string emc_line(const EmcTest& test) {
  if (!test.has_bursts()) return channel_line(test);
  const emc::ImmunityResult& result = test.result;
  const std::string where = fmt::format("{:<14} {:>8} {:>3}", test.level.text(),
                                        emc::text_of(test.repetition), emc::text_of(test.polarity));
  if (!result.came_up) return where + does_not_come_up(result);
  std::string line = where + burst_columns(result);
  if (test.reference && test.reference->came_up && !is_as_references(test))
    line += fmt::format("{:<27}", "  references alone") + burst_columns(*test.reference);
  if (test.of_search)
    line +=
        fmt::format("    seen by the search, in a test of {}\n", kernel::describe(test.of_search->duration));
  line += evidence_lines(result);
  if (!result.first_wrong_text.empty())
    line += fmt::format("    the first {}\n", reports::escaped_line(result.first_wrong_text));
  if (!result.complaint.empty()) line += fmt::format("    {}\n", reports::escaped_line(result.complaint));
  if (result.complaint.empty() && !result.was_disturbed())
    line += "    no burst met a receiver: this shows nothing\n";
  return line;
}

namespace {

std::string theory_text(const network::CycleKind& kind) {
  if (kind.theory == kernel::Duration{}) return "none";
  return fmt::format("{:.2f}", microseconds(static_cast<double>(kind.theory.count())));
}

// Times of all tests together, by the phase in which they lay, beside the closed form.
std::string cycles_text(const EmcCampaign& campaign) {
  if (campaign.tests.empty()) return "";
  std::vector<emc::CycleTimes> sums = campaign.tests.front().result.cycles;
  for (std::size_t n = 1; n < campaign.tests.size(); ++n) {
    const auto& more = campaign.tests[n].result.cycles;
    for (std::size_t k = 0; k < std::min(sums.size(), more.size()); ++k) sums[k].times.add(more[k].times);
  }
  std::string text = fmt::format("\n{:<24} {:>12}  {:>10} {:>10} {:>12} {:>12} {:>12} {:>12}\n", "cycle",
                                 "theory, us", "phase", "count", "min, us", "mean, us", "p99, us", "max, us");
  for (const emc::CycleTimes& cycle : sums) {
    for (const measure::Phase phase : measure::kPhases) {
      const measure::Distribution& times = cycle.times.in(phase);
      if (times.is_empty()) continue;
      text += fmt::format("{:<24} {:>12}{} {:>10} {:>10} {:>12.2f} {:>12.2f} {:>12.2f} {:>12.2f}\n",
                          cycle.kind.name, theory_text(cycle.kind), cycle.kind.is_bound ? "<" : " ",
                          measure::name(phase), times.count(), microseconds(static_cast<double>(times.min())),
                          microseconds(times.mean()), microseconds(static_cast<double>(times.quantile(0.99))),
                          microseconds(static_cast<double>(times.max())));
    }
    text += fmt::format("  theory: {}\n", cycle.kind.form);
  }
  return text;
}

std::string places_text(const EmcCampaign& campaign) {
  std::string text;
  std::size_t exposed = 0;
  for (const EmcPlace& place : campaign.places) exposed += place.is_exposed ? 1 : 0;
  text += fmt::format("{} of {} receivers are {}\n", exposed, campaign.places.size(),
                      campaign.has_bursts ? "exposed to the bursts" : "disturbed by the channel");
  constexpr std::size_t kMostNamed = 8;
  std::size_t named = 0;
  for (const EmcPlace& place : campaign.places) {
    if (place.is_exposed || ++named > kMostNamed) continue;
    text += fmt::format("  - not {}: {}\n", reports::escaped_line(place.name), place.why_not);
  }
  if (named > kMostNamed) text += fmt::format("  - and {} more\n", named - kMostNamed);
  return text;
}

}  // namespace

std::string emc_hint(const EmcCampaign& campaign) {
  const auto is_a = [](const EmcTest& test) { return test.result.criterion == emc::Criterion::a; };
  const auto says_something = [](const EmcTest& test) {
    return test.result.came_up && test.result.was_disturbed();
  };
  if (!campaign.has_bursts || !campaign.is_complete || campaign.tests.empty() ||
      !std::ranges::all_of(campaign.tests, says_something))
    return "";
  const bool has_a = std::ranges::any_of(campaign.tests, is_a);
  if (has_a && !std::ranges::all_of(campaign.tests, is_a)) return "";
  const std::string side = has_a ? "below where A ends" : "above where A ends";
  const std::string where =
      campaign.search && campaign.search->thresholds.is_complete
          ? fmt::format("A was found up to {:.0f} V", campaign.search->thresholds.a_up_to_volts)
          : "--search finds where that is";
  return fmt::format("all levels lie on one side, {}; {}", side, where);
}

// Picoseconds say nothing of a recovery.
std::string rounded_text(kernel::Duration time) {
  double value = static_cast<double>(time.count());
  std::string_view unit = "ps";
  for (const std::string_view larger : {"ns", "us", "ms", "s"}) {
    if (value < 1000) break;
    value /= 1000;
    unit = larger;
  }
  return fmt::format("{:.3f} {}", value, unit);
}

std::string longest_recovery_text(const EmcCampaign& campaign) {
  kernel::Duration longest{};
  for (const EmcTest& test : campaign.tests)
    if (test.result.recovered_by_itself) longest = std::max(longest, test.result.recovery_time);
  return longest > kernel::Duration{} ? fmt::format("; the longest took {}", rounded_text(longest)) : "";
}

std::string emc_summary(const EmcCampaign& campaign) {
  if (campaign.tests.empty()) return "no test came to its end: nothing is shown\n";
  const EmcTotal total = total_of(campaign);
  std::string text;
  if (campaign.has_bursts) {
    text = fmt::format("\nan exchange is one {}; recovery is counted in them, and may take {} ({}){}\n",
                       campaign.exchange, campaign.recovery.exchanges, campaign.recovery.source,
                       longest_recovery_text(campaign));
    text += "criterion  what it means (a choice of this project)\n";
    for (const auto criterion : emc::kCriteria) {
      text += fmt::format("{:>9}  {}\n", emc::name(criterion), emc::text_of(criterion));
    }
    text += acceptance_text(campaign);
  } else {
    text =
        "\nwrong: exchanges in which a wrong word was accepted; chance: of so many or more, where as many "
        "come "
        "on average as theory allows at most\n";
    for (const std::string& caveat : unverified_of(campaign)) text += fmt::format("  - {}\n", caveat);
  }
  text += cycles_text(campaign);
  text += fmt::format(
      "\nerror statistics: {} exchanges exposed = {} untouched + {} hit without effect + {} rejected + {} "
      "accepted wrong ({} words); data differed in {}: {}\n",
      total.counts.sent, total.counts.untouched, total.counts.without_effect, total.counts.refused,
      total.counts.wrong_exchanges, total.counts.accepted_wrong(), total.counts.differed,
      emc::undetected_text(total.counts, campaign.exchange));
  text += beside_text(campaign);
  for (const emc::FrameResidual& residual : campaign.residuals)
    text += frame_residual_text(residual, total.counts.differed);
  text += places_text(campaign);
  if (!campaign.has_bursts) return text;
  text += fmt::format("profile {} ({}): a receiver can be wrong from {:.0f} V on\n", campaign.profile.name,
                      reports::escaped_line(campaign.profile.title), campaign.threshold_volts);
  for (const std::string& caveat : emc::caveats_of(campaign.profile)) {
    text += fmt::format("  - {}\n", reports::escaped_line(caveat));
  }
  return text;
}

}  // namespace fieldproof::cli
