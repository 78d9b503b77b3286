#include "cli/emc_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/emc_beside.hpp"
#include "cli/emc_text.hpp"
#include "emc/evidence.hpp"
#include "harness/field/facts.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

double seconds(kernel::Duration time) {
  return static_cast<double>(time.count()) / 1e12;
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

ordered_json distribution_json(const measure::Distribution& times) {
  if (times.is_empty()) return {{"count", 0}};
  return {{"count", times.count()},
          {"min_us", microseconds(static_cast<double>(times.min()))},
          {"mean_us", microseconds(times.mean())},
          {"p99_us", microseconds(static_cast<double>(times.quantile(0.99)))},
          {"max_us", microseconds(static_cast<double>(times.max()))}};
}

ordered_json cycles_json(const std::vector<emc::CycleTimes>& cycles) {
  ordered_json all = ordered_json::array();
  for (const emc::CycleTimes& cycle : cycles) {
    ordered_json one = {{"cycle", cycle.kind.name},
                        {"theory_us", microseconds(static_cast<double>(cycle.kind.theory.count()))},
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
  return microseconds(quiet.is_empty() ? static_cast<double>(result.cycles.front().kind.theory.count())
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

double nanoseconds(kernel::Duration time) {
  return static_cast<double>(time.count()) / static_cast<double>(kernel::kNanosecond.count());
}

// As many digits as a chart shows.
ordered_json volts_json(const std::vector<double>& volts) {
  constexpr double kParts = 1'000;
  ordered_json list = ordered_json::array();
  for (const double one : volts) list.push_back(std::round(kParts * one) / kParts);
  return list;
}

ordered_json pulse_json(const EmcPulse& pulse, const emc::Coupling& coupling) {
  const emc::PulsePicture& picture = pulse.picture;
  ordered_json wrong = ordered_json::array();
  for (const auto& intervals : picture.wrong.of_level) {
    ordered_json of_level = ordered_json::array();
    for (const emc::Interval& one : intervals)
      of_level.push_back({nanoseconds(one.from), nanoseconds(one.to)});
    wrong.push_back(std::move(of_level));
  }
  const line::Sampling sampling = pulse.place.sampling;
  ordered_json sampled = ordered_json::array();
  for (unsigned n = sampling.first(); n <= sampling.last(); ++n) sampled.push_back(n);
  return {{"open_circuit_volts", picture.open_circuit_volts},
          {"polarity", emc::text_of(picture.polarity)},
          {"receiver", pulse.place.name},
          {"level_ns", nanoseconds(pulse.place.level)},
          {"sampled_sixteenths", std::move(sampled)},
          {"bit_v", coupling.bit_v},
          {"threshold_v", coupling.threshold_v},
          {"hysteresis_mv", coupling.hysteresis_mv},
          {"step_ns", nanoseconds(picture.step)},
          {"generator_v", volts_json(picture.generator_v)},
          {"receiver_v", volts_json(picture.receiver_v)},
          {"wrong_ns", std::move(wrong)}};
}

}  // namespace

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
  for (const auto criterion : emc::kCriteria) {
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
  if (campaign.pulse) document["pulse"] = pulse_json(*campaign.pulse, campaign.profile.coupling);
  if (campaign.search) document["thresholds"] = search_json(*campaign.search);
  if (std::string hint = emc_hint(campaign); !hint.empty()) document["hint"] = std::move(hint);
  if (campaign.sensitivity) document["sensitivity"] = sensitivity_json(*campaign.sensitivity);
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
