#include "cli/emc_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "cli/emc_beside.hpp"
#include "emc/evidence.hpp"
#include "emc/residual/residual_error.hpp"
#include "harness/field/facts.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::array kCriteria = {emc::Criterion::a, emc::Criterion::b, emc::Criterion::c, emc::Criterion::d};

double seconds(kernel::Duration time) {
  return static_cast<double>(time.count()) / 1e12;
}

std::string recovery_text(const emc::ImmunityResult& result) {
  if (result.recovered_by_itself) return fmt::format("{}", result.recovery_exchanges);
  return result.recovered_after_start ? "after a start" : "never";
}

// Which of four ends each exchange had, and how many put the checks to the test.
ordered_json balance_json(const network::ErrorStatistics& ledger) {
  return {{"exposed", ledger.sent},
          {"untouched", ledger.untouched},
          {"hit_without_effect", ledger.without_effect},
          {"rejected", ledger.refused},
          {"accepted_wrong", ledger.wrong_exchanges},
          {"data_differed", ledger.differed}};
}

ordered_json volts_json(const std::optional<double>& volts) {
  return volts ? ordered_json(*volts) : ordered_json();
}

ordered_json thresholds_json(const emc::Thresholds& found) {
  return {{"is_complete", found.is_complete},
          {"text", emc::text_of(found)},
          {"a_up_to_volts", found.a_up_to_volts},
          {"b_from_volts", volts_json(found.seen_from[1])},
          {"c_seen_from_volts", volts_json(found.seen_from[2])},
          {"d_seen_from_volts", volts_json(found.seen_from[3])},
          {"searched_to_volts", found.top_volts}};
}

ordered_json search_json(const EmcSearch& search) {
  ordered_json probes = ordered_json::array();
  for (const auto& [volts, criterion] : search.thresholds.probes)
    probes.push_back({{"volts", volts}, {"criterion", emc::name(criterion)}});
  ordered_json json = thresholds_json(search.thresholds);
  json["tests"] = search.tests();
  json["test_s"] = seconds(search.duration);
  json["probes"] = std::move(probes);
  if (search.references) json["references"] = thresholds_json(*search.references);
  return json;
}

ordered_json sensitivity_json(const EmcSensitivity& found) {
  ordered_json parameters = ordered_json::array();
  for (const emc::ParameterRange& range : found.parameters) {
    ordered_json one = {{"name", range.name}, {"unit", range.unit}, {"value", range.value},
                        {"from", range.from}, {"to", range.to},     {"holds", range.holds()}};
    if (range.below)
      one["below"] = {{"value", range.below->first}, {"criterion", emc::name(range.below->second)}};
    if (range.above)
      one["above"] = {{"value", range.above->first}, {"criterion", emc::name(range.above->second)}};
    parameters.push_back(std::move(one));
  }
  return {{"is_complete", found.is_complete},        {"level", found.level.text()},
          {"criterion", emc::name(found.criterion)}, {"tests", found.tests},
          {"test_s", seconds(found.duration)},       {"parameters", std::move(parameters)}};
}

ordered_json evidence_json(const emc::Evidence& evidence) {
  ordered_json json = {{"text", evidence.text}};
  if (evidence.worse_than_a) json["worse_than_a_at_most"] = *evidence.worse_than_a;
  if (evidence.c) json["c_at_most"] = *evidence.c;
  if (evidence.d) json["d_at_most"] = *evidence.d;
  return json;
}

ordered_json ledger_json(const network::ErrorStatistics& ledger) {
  return {{"sent", ledger.sent},
          {"corrupted", ledger.corrupted},
          {"detected", ledger.detected},
          {"missing", ledger.missing},
          {"retried", ledger.retried},
          {"repeated", ledger.repeated},
          {"accepted_wrong_inputs", ledger.accepted_wrong_inputs},
          {"accepted_wrong_outputs", ledger.accepted_wrong_outputs},
          {"wrong_cycles", ledger.wrong_exchanges},
          {"missed_outputs", ledger.missed_outputs},
          {"cleared_outputs", ledger.cleared_outputs},
          {"partly_latched", ledger.partly_latched},
          {"balance", balance_json(ledger)}};
}

ordered_json line_json(const emc::BurstStatistics& line) {
  return {{"transmissions", line.transmissions},
          {"hit", line.hit_transmissions},
          {"changed", line.changed_transmissions},
          {"pulses", line.pulses},
          {"wrong_levels", line.wrong_levels}};
}

constexpr double kPerMicrosecond = 1e6;  // picoseconds

double us(double picoseconds) {
  return picoseconds / kPerMicrosecond;
}

ordered_json distribution_json(const measure::Distribution& times) {
  if (times.is_empty()) return {{"count", 0}};
  return {{"count", times.count()},
          {"min_us", us(static_cast<double>(times.min()))},
          {"mean_us", us(times.mean())},
          {"p99_us", us(static_cast<double>(times.quantile(0.99)))},
          {"max_us", us(static_cast<double>(times.max()))}};
}

ordered_json cycles_json(const std::vector<emc::CycleTimes>& cycles) {
  ordered_json all = ordered_json::array();
  for (const emc::CycleTimes& cycle : cycles) {
    ordered_json one = {{"cycle", cycle.kind.name},
                        {"theory_us", us(static_cast<double>(cycle.kind.theory.count()))},
                        {"theory_is_bound", cycle.kind.is_bound},
                        {"form", cycle.kind.form}};
    for (const measure::Phase phase : measure::kPhases) {
      one[std::string(measure::name(phase))] = distribution_json(cycle.times.in(phase));
    }
    all.push_back(std::move(one));
  }
  return all;
}

// On the quiet line; by the closed form where there was none.
double cycle_time_us(const emc::ImmunityResult& result) {
  if (result.cycles.empty()) return 0;
  const measure::Distribution& quiet = result.cycles.front().times.in(measure::Phase::quiet);
  return us(quiet.is_empty() ? static_cast<double>(result.cycles.front().kind.theory.count())
                             : static_cast<double>(quiet.quantile(0.5)));
}

// Windows in which nothing was wrong are left out.
ordered_json immunity_course_json(const emc::ImmunityCourse& course) {
  const kernel::Duration width = course.length() / emc::ImmunityCourse::kWindows;
  ordered_json windows = ordered_json::array();
  for (std::size_t n = 0; n < course.windows().size(); ++n) {
    const emc::ImmunityCourse::Window& one = course.windows()[n];
    if (one.rejected + one.accepted_wrong + one.stops == 0) continue;
    windows.push_back({{"from_s", seconds(static_cast<std::int64_t>(n) * width)},
                       {"exchanges", one.exchanges},
                       {"rejected", one.rejected},
                       {"accepted_wrong", one.accepted_wrong},
                       {"stops", one.stops}});
  }
  ordered_json bursts = ordered_json::array();
  for (const measure::Band& band : course.bursts())
    bursts.push_back(
        {{"from_s", seconds(band.from)}, {"to_s", seconds(band.to)}, {"count", band.disturbances}});
  return {{"length_s", seconds(course.length())},
          {"window_s", seconds(width)},
          {"windows", std::move(windows)},
          {"bursts", std::move(bursts)}};
}

ordered_json result_json(const emc::ImmunityResult& result) {
  return {{"came_up", result.came_up},
          {"complaint", result.complaint},
          {"criterion", emc::name(result.criterion)},
          {"decided_by", result.decided_by},
          {"first_wrong", result.first_wrong_text},
          {"longest_bad_run", result.longest_bad_run},
          {"recovered_by_itself", result.recovered_by_itself},
          {"recovered_after_start", result.recovered_after_start},
          {"recovery_cycles", result.recovery_exchanges},
          {"recovery_s", seconds(result.recovery_time)},
          {"bus_stops", result.stops},
          {"quality_bit", result.poor_quality},
          {"cycle_time_us", cycle_time_us(result)},
          {"cycles", cycles_json(result.cycles)},
          {"bursts", result.bursts},
          {"evidence", evidence_json(emc::evidence_of(result))},
          {"ledger", ledger_json(result.counts)},
          {"course", immunity_course_json(result.course)},
          {"line", line_json(result.line)}};
}

ordered_json test_json(const EmcTest& test) {
  ordered_json json = {{"level", test.level.text()},
                       {"open_circuit_volts", test.level.open_circuit_volts()},
                       {"repetition", emc::text_of(test.repetition)},
                       {"polarity", emc::text_of(test.polarity)}};
  if (test.of_search) json["of_search_s"] = seconds(test.of_search->duration);
  json.update(result_json(test.result));
  if (test.reference) json["reference"] = reference_json(*test.reference);
  return json;
}

ordered_json channel_json(const EmcTest& test) {
  ordered_json json = {{"channel", "bsc"},
                       {"flip_probability", test.flip_probability},
                       {"receivers", test.result.receivers},
                       {"expected_wrong_cycles_at_most", test.expected_wrong()},
                       {"chance_of_count", test.chance_of_count()}};
  for (const UndetectedPart& part : test.undetected) json["undetected_by_" + part.name] = part.probability;
  json.update(result_json(test.result));
  return json;
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

ordered_json frame_residual_json(const emc::FrameResidual& residual, const EmcTotal& total) {
  return {{"frame_check", residual.frame_check},
          {"bits", residual.bits},
          {"worst_ber", residual.worst_ber},
          {"worst_share_of_corrupted", residual.worst_share},
          {"expected_wrong_at_most", total.expected_at_most},
          {"probability_at_ber_0.01", residual.probability_at_one_in_100},
          {"rate_per_hour_at_ber_0.01", residual.rate_per_hour}};
}

emc::FrameResidual residual_of(const EmcCampaign& campaign) {
  return campaign.residuals.empty() ? emc::FrameResidual{} : campaign.residuals.front();
}

ordered_json places_json(const EmcCampaign& campaign) {
  ordered_json places = ordered_json::array();
  for (const EmcPlace& place : campaign.places) {
    ordered_json one = {{"receiver", place.name}, {"exposed", place.is_exposed}};
    if (!place.is_exposed) one["why_not"] = place.why_not;
    places.push_back(std::move(one));
  }
  return places;
}

ordered_json acceptance_json(const EmcCampaign& campaign) {
  ordered_json numbers = ordered_json::array();
  for (const field::Fact& fact : field::facts_of(network::kAcceptanceTable, campaign.acceptance)) {
    numbers.push_back({{"name", fact.name},
                       {"value", fact.value},
                       {"source", fact.source},
                       {"standing", judge::name(fact.standing)}});
  }
  return numbers;
}

std::string acceptance_text(const EmcCampaign& campaign) {
  std::string text = "the numbers by which C and D are decided (fieldproof explain network/acceptance):\n";
  for (const field::Fact& fact : field::facts_of(network::kAcceptanceTable, campaign.acceptance)) {
    text += fmt::format("  {:<24} {:>12}  [{}] {}\n", fact.name, fact.value, judge::name(fact.standing),
                        fact.source);
  }
  return text;
}

// What a reader of the results has to know of their standing.
std::vector<std::string> unverified_of(const EmcCampaign& campaign) {
  if (campaign.has_bursts) return emc::caveats_of(campaign.profile);
  return campaign.channel_caveats;
}

}  // namespace

namespace {

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

void EmcTest::bound_by(const std::vector<network::ProtectedFrame>& frames) {
  for (const network::ProtectedFrame& frame : frames)
    undetected_share = std::max(undetected_share, emc::undetected_share_at(frame, flip_probability));
}

double EmcTest::expected_wrong() const {
  if (undetected.empty()) return static_cast<double>(result.counts.corrupted) * undetected_share;
  double any = 0;
  for (const UndetectedPart& part : undetected) any += part.probability;
  return static_cast<double>(result.counts.sent * result.receivers) * any;
}

EmcTotal total_of(const EmcCampaign& campaign) {
  EmcTotal total;
  for (const EmcTest& test : campaign.tests) {
    total.counts += test.result.counts;
  }
  total.upper_bound_of_share = emc::upper_bound_of_share(total.counts.wrong_exchanges, total.counts.differed);
  if (!campaign.residuals.empty()) {
    total.expected_at_most =
        static_cast<double>(total.counts.differed) * campaign.residuals.front().worst_share;
  }
  return total;
}

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
  return fmt::format("{:.2f}", us(static_cast<double>(kind.theory.count())));
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
                          measure::name(phase), times.count(), us(static_cast<double>(times.min())),
                          us(times.mean()), us(static_cast<double>(times.quantile(0.99))),
                          us(static_cast<double>(times.max())));
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
  return fmt::format("hint: all levels lie on one side, {}; {}\n", side, where);
}

std::string longest_recovery_text(const EmcCampaign& campaign) {
  kernel::Duration longest{};
  for (const EmcTest& test : campaign.tests)
    if (test.result.recovered_by_itself) longest = std::max(longest, test.result.recovery_time);
  return longest > kernel::Duration{} ? fmt::format("; the longest took {}", kernel::describe(longest)) : "";
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
    for (const auto criterion : kCriteria) {
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

std::string emc_json(const EmcCampaign& campaign) {
  ordered_json tests = ordered_json::array();
  ordered_json channels = ordered_json::array();
  for (const EmcTest& test : campaign.tests) {
    if (test.has_bursts()) {
      tests.push_back(test_json(test));
    } else {
      channels.push_back(channel_json(test));
    }
  }
  ordered_json criteria = ordered_json::array();
  for (const auto criterion : kCriteria) {
    criteria.push_back({{"criterion", emc::name(criterion)}, {"meaning", emc::text_of(criterion)}});
  }
  const EmcTotal total = total_of(campaign);
  const bool has_bursts = campaign.has_bursts;
  ordered_json document = {{"schema", "fieldproof/emc/1"},
                           {"protocol", campaign.protocol},
                           {"network", campaign.network},
                           {"implementations", campaign.implementations},
                           {"profile", has_bursts ? campaign.profile.name : ""},
                           {"threshold_volts", has_bursts ? campaign.threshold_volts : 0},
                           {"unverified", unverified_of(campaign)},
                           {"criteria", std::move(criteria)},
                           {"worst_allowed", emc::name(campaign.worst)},
                           {"seed", std::to_string(campaign.seed)},
                           {"is_complete", campaign.is_complete},
                           {"duration_s", seconds(campaign.duration)},
                           {"tests", std::move(tests)},
                           {"channels", std::move(channels)},
                           {"places", places_json(campaign)},
                           {"acceptance", acceptance_json(campaign)},
                           {"recovery_limit",
                            {{"exchanges", campaign.recovery.exchanges},
                             {"exchange", campaign.exchange},
                             {"source", campaign.recovery.source}}},
                           {"residual", frame_residual_json(residual_of(campaign), total)},
                           {"total",
                            {{"corrupted", total.counts.corrupted},
                             {"detected", total.counts.detected},
                             {"accepted_wrong", total.counts.accepted_wrong()},
                             {"balance", balance_json(total.counts)},
                             {"upper_bound_of_share", total.upper_bound_of_share}}}};
  if (campaign.search) document["thresholds"] = search_json(*campaign.search);
  if (campaign.sensitivity) document["sensitivity"] = sensitivity_json(*campaign.sensitivity);
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
