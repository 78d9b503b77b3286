#include "cli/emc_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "emc/residual/residual_error.hpp"
#include "reports/text_summary.hpp"

namespace fieldproof::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::array kCriteria = {emc::Criterion::a, emc::Criterion::b, emc::Criterion::c, emc::Criterion::d};

std::string recovery_text(const emc::ImmunityResult& result) {
  if (result.recovered_by_itself) return fmt::format("{}", result.recovery_cycles);
  return result.recovered_after_start ? "after a start" : "never";
}

ordered_json ledger_json(const interbus::ErrorLedger& ledger) {
  return {{"sent", ledger.sent},
          {"corrupted", ledger.corrupted},
          {"detected", ledger.detected},
          {"repeated", ledger.repeated},
          {"accepted_wrong_inputs", ledger.accepted_wrong_inputs},
          {"accepted_wrong_outputs", ledger.accepted_wrong_outputs},
          {"wrong_cycles", ledger.wrong_cycles},
          {"missed_outputs", ledger.missed_outputs},
          {"cleared_outputs", ledger.cleared_outputs},
          {"partly_latched", ledger.partly_latched}};
}

ordered_json line_json(const emc::BurstStatistics& line) {
  return {{"transmissions", line.transmissions},
          {"hit", line.hit_transmissions},
          {"changed", line.changed_transmissions},
          {"pulses", line.pulses},
          {"wrong_levels", line.wrong_levels}};
}

ordered_json result_json(const emc::ImmunityResult& result) {
  return {{"came_up", result.came_up},
          {"criterion", emc::name(result.criterion)},
          {"longest_bad_run", result.longest_bad_run},
          {"recovered_by_itself", result.recovered_by_itself},
          {"recovered_after_start", result.recovered_after_start},
          {"recovery_cycles", result.recovery_cycles},
          {"bus_stops", result.bus_stops},
          {"quality_bit", result.quality_bit},
          {"cycle_time_us", static_cast<double>(result.cycle_time.count()) / 1e6},
          {"ledger", ledger_json(result.ledger)},
          {"line", line_json(result.line)}};
}

ordered_json test_json(const EmcTest& test) {
  ordered_json json = {{"level", test.level.text()},
                       {"open_circuit_volts", test.level.open_circuit_volts()},
                       {"repetition", emc::text_of(test.repetition)},
                       {"polarity", emc::text_of(test.polarity)}};
  json.update(result_json(test.result));
  return json;
}

ordered_json channel_json(const EmcTest& test) {
  ordered_json json = {{"channel", "bsc"},
                       {"flip_probability", test.flip_probability},
                       {"receivers", test.result.receivers},
                       {"undetected_by_code_word", test.undetected.by_code_word},
                       {"undetected_by_shift", test.undetected.by_shift},
                       {"undetected_by_misframing", test.undetected.by_misframing},
                       {"expected_wrong_cycles_at_most", test.expected_wrong_cycles()},
                       {"chance_of_count", test.chance_of_count()}};
  json.update(result_json(test.result));
  return json;
}

std::string channel_line(const EmcTest& test) {
  const std::string where = fmt::format("bsc {:<12g}", test.flip_probability);
  if (!test.result.came_up) return where + "  the network does not come up on a quiet line\n";
  const interbus::ErrorLedger& ledger = test.result.ledger;
  return fmt::format("{} {:>9} {:>10} {:>10} {:>8} {:>6} {:>6} {:>12.3g} {:>8.3g}\n", where, ledger.sent,
                     ledger.corrupted, ledger.detected, test.result.longest_bad_run, test.result.bus_stops,
                     ledger.wrong_cycles, test.expected_wrong_cycles(), test.chance_of_count());
}

std::string frame_residual_text(const emc::FrameResidual& residual, const EmcTotal& total) {
  return fmt::format(
      "{} over {} bits lets at most {:.3g} of the corrupted cycles pass (exact, at the worst bit-error rate, "
      "{:.2g}): of these {:.3g}\n"
      "per hour {:.3g} cycles pass wrong at a bit-error rate of 1e-2 (formula of IEC 61784-3, unverified)\n",
      residual.frame_check, residual.bits, residual.worst_share, residual.worst_ber, total.expected_at_most,
      residual.rate_per_hour);
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

// What a reader of the results has to know of their standing.
std::vector<std::string> unverified_of(const EmcCampaign& campaign) {
  if (campaign.has_bursts) return emc::caveats_of(campaign.profile);
  return {
      "That a flipped header level moves the end of the data, and how often a check fits then, follows from "
      "this "
      "project's reading of the header: the simulated stations and the theory share it."};
}

}  // namespace

EmcTotal total_of(const EmcCampaign& campaign) {
  EmcTotal total;
  for (const EmcTest& test : campaign.tests) {
    total.corrupted += test.result.ledger.corrupted;
    total.detected += test.result.ledger.detected;
    total.accepted_wrong += test.result.ledger.accepted_wrong();
  }
  if (total.corrupted > 0) {
    total.upper_bound_of_share =
        emc::upper_bound_of_share(std::min(total.accepted_wrong, total.corrupted), total.corrupted);
  }
  total.expected_at_most = static_cast<double>(total.corrupted) * campaign.residual.worst_share;
  return total;
}

std::string emc_table_head(bool has_bursts) {
  if (!has_bursts) {
    return fmt::format("{:<16} {:>9} {:>10} {:>10} {:>8} {:>6} {:>6} {:>12} {:>8}\n", "channel", "cycles",
                       "corrupted", "rejected", "longest", "stops", "wrong", "at most", "chance");
  }
  return fmt::format("{:<14} {:>8} {:>3}  {:>9} {:>8} {:>10} {:>9} {:>9} {:>8} {:>14} {:>6} {:>8} {:>6}\n",
                     "level", "pulses", "pol", "criterion", "cycles", "corrupted", "rejected", "held",
                     "longest", "recovery", "stops", "cleared", "wrong");
}

std::string emc_line(const EmcTest& test) {
  if (!test.has_bursts()) return channel_line(test);
  const emc::ImmunityResult& result = test.result;
  const std::string where = fmt::format("{:<14} {:>8} {:>3}", test.level.text(),
                                        emc::text_of(test.repetition), emc::text_of(test.polarity));
  if (!result.came_up) return where + "  the network does not come up on a quiet line\n";
  const interbus::ErrorLedger& ledger = result.ledger;
  return fmt::format("{}  {:>9} {:>8} {:>10} {:>9} {:>9} {:>8} {:>14} {:>6} {:>8} {:>6}\n", where,
                     emc::name(result.criterion), ledger.sent, ledger.corrupted, ledger.detected,
                     ledger.detected - std::min(ledger.detected, ledger.partly_latched),
                     result.longest_bad_run, recovery_text(result), result.bus_stops, ledger.cleared_outputs,
                     ledger.accepted_wrong());
}

std::string emc_summary(const EmcCampaign& campaign) {
  const EmcTotal total = total_of(campaign);
  std::string text;
  if (campaign.has_bursts) {
    text = "\ncriterion  what it means (a choice of this project)\n";
    for (const auto criterion : kCriteria) {
      text += fmt::format("{:>9}  {}\n", emc::name(criterion), emc::text_of(criterion));
    }
  } else {
    text =
        "\nwrong: cycles in which a wrong word was accepted; chance: of so many or more, where as many come "
        "on "
        "average as theory allows at most:\nflips that are a code word of the frame check (exact), a flipped "
        "control level that moves the end of the data by an octet,\nand an octet lost or inserted where the "
        "check fits by chance (both from this project's reading of the header, unverified)\n";
  }
  text += fmt::format(
      "\nledger: {} cycles corrupted, {} rejected, {} words accepted wrong; of corrupted cycles at most "
      "{:.3g} pass "
      "unseen (one-sided 95 %)\n",
      total.corrupted, total.detected, total.accepted_wrong, total.upper_bound_of_share);
  text += frame_residual_text(campaign.residual, total);
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
  const ordered_json document = {{"schema", "fieldproof/emc/1"},
                                 {"protocol", "interbus"},
                                 {"network", campaign.network},
                                 {"implementations", campaign.implementations},
                                 {"profile", has_bursts ? campaign.profile.name : ""},
                                 {"threshold_volts", has_bursts ? campaign.threshold_volts : 0},
                                 {"unverified", unverified_of(campaign)},
                                 {"criteria", std::move(criteria)},
                                 {"seed", std::to_string(campaign.seed)},
                                 {"duration_s", static_cast<double>(campaign.duration.count()) / 1e12},
                                 {"tests", std::move(tests)},
                                 {"channels", std::move(channels)},
                                 {"residual", frame_residual_json(campaign.residual, total)},
                                 {"total",
                                  {{"corrupted", total.corrupted},
                                   {"detected", total.detected},
                                   {"accepted_wrong", total.accepted_wrong},
                                   {"upper_bound_of_share", total.upper_bound_of_share}}}};
  return document.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fieldproof::cli
