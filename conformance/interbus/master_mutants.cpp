#include "conformance/interbus/master_mutants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "conformance/interbus/master_seeded_faults.hpp"
#include "conformance/interbus/master_sequence_seeded_faults.hpp"
#include "harness/config/nearest.hpp"
#include "harness/kernel/error.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::MasterConfiguration;
using interbus::MasterDevice;
using interbus::MasterState;

template <typename Mutant>
std::unique_ptr<MasterDevice> make(const MasterConfiguration& configuration) {
  return std::make_unique<Mutant>(configuration);
}

// The reference under rules with one number changed.
template <typename Change>
MasterBench::MakeMaster with_rules(Change change) {
  return [change](const MasterConfiguration& configuration) {
    MasterConfiguration changed = configuration;
    change(changed.rules);
    return std::make_unique<interbus::Master>(changed);
  };
}

struct Row {
  std::string_view name;
  std::string_view label;
  std::string_view description;
  MasterBench::MakeMaster make_master;
  bool is_for_check = false;
};

const std::vector<Row>& rows() {
  using namespace seeded_faults;
  using interbus::Rules;
  static const std::vector<Row> table = {
      {"loopback_not_compared", "MM1", "takes any word for the loopback word", make<LoopbackNotCompared>},
      {"loopback_position_not_compared", "MM2", "takes the loopback word wherever it comes back",
       make<LoopbackPositionNotCompared>},
      {"own_check_ignored", "MM3", "does not compare the check of what came back", make<OwnCheckIgnored>},
      {"status_word_ignored", "MM4", "takes a cycle whose status word is marked", make<StatusWordIgnored>},
      {"inputs_taken_before_check", "MM5", "gives the application the inputs of rejected cycles",
       make<InputsTakenBeforeCheck>},
      {"inputs_zeroed_on_error", "MM6", "sets all inputs to 0 on a rejected cycle",
       make<InputsZeroedOnError>},
      {"no_id_cycle_after_error", "MM7", "goes on with data cycles after a rejected one",
       make<NoIdCycleAfterError>},
      {"consecutive_never_cleared", "MM8", "a good data cycle does not clear the count of bad ones in a row",
       make<ConsecutiveNeverCleared>},
      {"stop_one_late", "MM9", "stops the bus one bad cycle too late",
       with_rules([](Rules& rules) { ++rules.stop_after_bad_cycles; })},
      {"quality_window_too_short", "MM10", "counts bad cycles over a tenth of the window",
       with_rules([](Rules& rules) { rules.quality_window_cycles /= 10; })},
      {"quality_bit_early", "", "sets the quality bit one bad cycle too early",
       with_rules([](Rules& rules) { --rules.quality_bad_cycles; })},
      {"first_station_first", "MM11", "sends the outputs of the first station first",
       make<FirstStationFirst>},
      {"length_code_binary", "MM12", "reads the length code as a binary number of words",
       make<LengthCodeBinary>},
      {"check_omits_loopback", "MM13", "leaves the loopback word out of the sent check",
       make<CheckOmitsLoopback>},
      {"check_covers_headers", "MM13", "takes the headers into the sent check", make<CheckCoversHeaders>},
      {"outputs_torn", "MM14", "sends the second half of the outputs as they were a cycle before",
       make<OutputsTorn>},
      {"silent_in_long_pauses", "MM15", "sends no status telegrams in pauses longer than 25 ms",
       make<SilentInLongPauses>},
      {"cycle_time_without_ring_delay", "MM16", "leaves the delay of the stations out of the cycle time",
       make<CycleTimeWithoutRingDelay>},
      {"ring_longer_by_an_octet_accepted", "MM17", "also takes a loopback word that comes one octet late",
       make<RingLongerByAnOctetAccepted>},
      {"id_type_ignored", "MM18", "compares only the length of ID codes", make<IdTypeIgnored>},
      {"counter_saturates", "MM19", "its error counters stay at 255", make<CounterSaturates>},
      {"wrong_segment", "MM20", "names the segment behind the disturbed one", make<WrongSegment>},
      {"copied_one_cycle_late", "MM21", "copies the inputs of the cycle before", make<CopiedOneCycleLate>},
      {"restart_without_id_cycle", "MM22", "restarts with data cycles", make<RestartWithoutIdCycle>},
      {"id_cycle_without_select", "", "sends ID cycles with the headers of data cycles",
       make<IdCycleWithoutSelect>},
      {"select_dropped_in_check", "", "sends the check phase of ID cycles with the headers of data cycles",
       make<SelectDroppedInCheck>},
      {"branches_not_searched", "", "never looks behind a second outgoing interface",
       make<BranchesNotSearched>},
      {"station_limit_ignored", "", "takes more stations than allowed",
       with_rules([](Rules& rules) { rules.max_stations *= 2; })},
      {"point_limit_ignored", "", "takes more I/O points than allowed",
       with_rules([](Rules& rules) { rules.max_io_points *= 2; })},
      {"cycle_start_wanders", "", "starts every second cycle late by 2 % of the cycle time",
       make<CycleStartWanders>},
      {"telegram_count_ignored", "", "does not count the telegrams that come back",
       make<TelegramCountIgnored>},
      {"implausible_inputs_rejected", "", "rejects cycles in which more than three input bits change",
       make<ImplausibleInputsRejected>},
      {"silence_taken_for_good", "", "takes a cycle that does not come back for a good one",
       make<SilenceTakenForGood>},
      {"fault_not_searched", "", "stays stopped without looking for the fault", make<FaultNotSearched>},
      {"copies_every_second_cycle", "", "runs the copy task only after every second cycle",
       make<CopiesEverySecondCycle>},
      {"request_taken_as_it_is", "", "takes a requested cycle time below the shortest possible",
       make<RequestTakenAsItIs>},
      {"changed_ring_ignored", "", "goes on when an ID cycle shows another ring", make<ChangedRingIgnored>},
      {"peripheral_fault_not_reported", "", "does not report peripheral faults",
       make<PeripheralFaultNotReported>},
      {"reconfiguration_not_reported", "", "does not report reconfiguration requests",
       make<ReconfigurationNotReported>},
      {"stop_bit_ignored", "", "takes telegrams without a stop bit", make<StopBitIgnored>},
      {"no_clock_tolerance", "", "hears only a return line of exactly its own rate", make<NoClockTolerance>},
      {"telegrams_without_gap", "", "leaves no gap between the telegrams of a cycle",
       with_rules([](Rules& rules) { rules.telegram_gap_millibits = 0; })},
      {"drives_over_itself", "", "begins a transmission before the one before has left",
       make<DrivesOverItself>},
      {"stop_keeps_outputs", "", "stops without setting the outputs to 0", make<StopKeepsOutputs>},
      {"inputs_frozen", "", "gives the application the inputs of its first data cycle for ever",
       make<InputsFrozen>},
      {"id_cycle_only_claimed", "", "counts an ID cycle after a rejected one, but sends none",
       make<IdCycleOnlyClaimed>},
      {"outputs_one_cycle_late", "", "sends the outputs as they were a cycle before",
       make<OutputsOneCycleLate>},
      {"silent_after_first_data_cycle", "", "falls silent after its first data cycle",
       make<SilentAfterFirstDataCycle>},
      {"silent_after_error", "", "falls silent after the first cycle that it rejects",
       make<SilentAfterError>},
      {"id_cycles_for_ever_after_error", "", "sends ID cycles only after the first cycle that it rejects",
       make<IdCyclesForEverAfterError>},
      {"first_cycles_rejected", "", "rejects its first data cycle", make<FirstCyclesRejected>},
      {"pauses_in_identification", "", "waits 30 ms in silence between the cycles of the recognition",
       make<PausesIn<MasterState::identification>>},
      {"pauses_in_locating", "", "waits 30 ms in silence between the cycles of the search for a fault",
       make<PausesIn<MasterState::locating>>},
      {"pulse_widths_even", "", "copies pulses of an odd number of cycles one cycle shorter",
       make<PulseWidthsEven>},
      {"second_mark_accepted", "", "takes a marked status word when the one before was marked, too",
       make<SecondMarkAccepted>, true},
      {"stop_one_early_after_restart", "", "once stopped and started, stops the bus one bad cycle too early",
       make<StopOneEarlyAfterRestart>, true},
      {"inputs_stale_after_id_cycle", "",
       "keeps the inputs in the first data cycle after an ID cycle that was asked for",
       make<InputsStaleAfterIdCycle>, true},
      {"output_after_error_lost", "", "does not take outputs that are written after a rejected cycle",
       make<OutputAfterErrorLost>, true},
      {"first_fault_reported_only", "", "reports the peripheral fault of one station only",
       make<FirstFaultReportedOnly>, true},
      {"copy_skipped_after_error", "",
       "does not run the copy task after the first good cycle after a bad one", make<CopySkippedAfterError>,
       true},
  };
  return table;
}

}  // namespace

const std::vector<Mutant>& master_mutants() {
  static const std::vector<Mutant> mutants = [] {
    std::vector<Mutant> all;
    for (const Row& row : rows()) {
      all.push_back({std::string(row.name), std::string(row.label), "master", std::string(row.description),
                     row.is_for_check});
    }
    return all;
  }();
  return mutants;
}

MasterBench::MakeMaster mutant_master(std::string_view name) {
  const auto row = std::ranges::find(rows(), name, &Row::name);
  return row == rows().end() ? nullptr : row->make_master;
}

std::unique_ptr<MasterDevice> make_master_mutant(std::string_view name,
                                                 const MasterConfiguration& configuration) {
  if (const auto made = mutant_master(name)) return made(configuration);
  std::vector<std::string_view> names;
  for (const Row& row : rows()) names.push_back(row.name);
  throw kernel::Error(kernel::ErrorKind::usage,
                      fmt::format("there is no mutant master \"{}\"; near are {}", name,
                                  fmt::join(config::nearest(name, names, 3), ", ")));
}

MasterBench::MakeMaster make_master(std::string_view uri) {
  if (uri == "ref") return make<interbus::Master>;
  constexpr std::string_view kMutant = "mutant:";
  if (!uri.starts_with(kMutant)) {
    throw kernel::Error(kernel::ErrorKind::usage,
                        fmt::format("\"{}\" is no INTERBUS master; use ref or mutant:NAME", uri));
  }
  const std::string name(uri.substr(kMutant.size()));
  make_master_mutant(name, {});  // while it is the caller's mistake
  return mutant_master(name);
}

}  // namespace fieldproof::conformance
