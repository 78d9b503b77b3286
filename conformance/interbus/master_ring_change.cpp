// Chapter ring_change: cut cables, stations that come, go and change, messages (IM-17, IM-28 to IM-32).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/master_cases.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::CycleFaults;
using interbus::FaultLocation;
using interbus::MasterState;
using interbus::VirtualStation;
using judge::Standing;

constexpr std::uint16_t kInOut = 0x0103;

// Runs until the master has left run; fails when it needs more cycles than allowed.
void expect_stop(MasterBench& bench, CaseJudge& judge, std::string_view reason) {
  for (unsigned n = 0; n < bench.rules().stop_after_bad_cycles && bench.is_in_run(); ++n) bench.run_cycle();
  judge.expect(!bench.is_in_run(), reason, [&] {
    return Mismatch{
        {fmt::format("the master leaves run within {} cycles", bench.rules().stop_after_bad_cycles)},
        "it is in run"};
  });
}

void wait_for_search(MasterBench& bench) {
  bench.run_for(2 * bench.rules().silence_limit);
  bench.run_until([&] { return bench.status().state == MasterState::bus_stop; }, 500 * kernel::kMillisecond);
}

void expect_location(MasterBench& bench, CaseJudge& judge, FaultLocation expected, std::string_view reason) {
  const auto status = bench.status();
  judge.expect(status.has_fault_location && status.fault_location == expected, reason, [&] {
    return Mismatch{{fmt::format("fault between {} and {}", expected.from, expected.to)},
                    status.has_fault_location ? fmt::format("between {} and {}", status.fault_location.from,
                                                            status.fault_location.to)
                                              : "no location"};
  });
}

constexpr std::uint16_t kOutput = 0x0001;

void expect_declared_outputs(MasterBench& bench, CaseJudge& judge) {
  const auto all_are = [&bench](std::uint16_t value) {
    for (unsigned word = 0; word < bench.ring().word_count(); ++word) {
      if (bench.ring().output(word) != value) return false;
    }
    return true;
  };
  constexpr std::string_view kItem = "outputs_after_bus_stop";
  judge.expect((all_are(0) && bench.may_answer(kItem, "zero")) ||
                   (all_are(kOutput) && bench.may_answer(kItem, "held")),
               "outputs_not_safe", "as declared, all outputs are 0 or held after the bus stop",
               "they are not");
}

void cut_ring(MasterBench& bench, CaseJudge& judge) {
  const int stations = bench.volume(3, 8);
  for (int cut = -1; cut < stations - 1; ++cut) {
    bench.bring_up(judge, interbus::line_of(static_cast<std::size_t>(stations), kInOut, 1));
    for (unsigned word = 0; word < bench.ring().word_count(); ++word) bench.write_output(word, kOutput);
    bench.run_data_cycles(judge, 2);
    bench.ring().cut_after(cut);
    expect_stop(bench, judge, "cut_not_detected");
    wait_for_search(bench);
    expect_location(bench, judge, {cut, cut + 1}, "fault_not_located");
    expect_declared_outputs(bench, judge);
  }
}

void added_station(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, interbus::line_of(3, kInOut, 1));
  bench.ring().replace_ring(interbus::line_of(4, kInOut, 1));
  expect_stop(bench, judge, "changed_ring_not_reported");
  const auto status = bench.status();
  judge.expect(!status.configuration_error.empty(), "changed_ring_not_reported", "a configuration error",
               "none");
  judge.expect_equal(status.stations.size(), 3, "silently_remapped", "stations of the configuration");
}

void removed_station(MasterBench& bench, CaseJudge& judge) {
  for (std::size_t left = 1; left <= 2; ++left) {
    bench.bring_up(judge, interbus::line_of(3, kInOut, 1));
    bench.ring().replace_ring(interbus::line_of(left, kInOut, 1));
    expect_stop(bench, judge, "removed_station_not_reported");
    judge.expect(!bench.status().configuration_error.empty(), "removed_station_not_reported",
                 "a configuration error", "none");
    wait_for_search(bench);
    const int last = static_cast<int>(left) - 1;
    expect_location(bench, judge, {last, last + 1}, "fault_not_located");
  }
}

void replaced_station(MasterBench& bench, CaseJudge& judge) {
  for (int station = 0; station < 3; ++station) {
    bench.bring_up(judge, interbus::line_of(3, kInOut, 1));
    std::vector<VirtualStation> ring = interbus::line_of(3, kInOut, 1);
    ring.at(static_cast<std::size_t>(station)).id_code = 0x0133;
    bench.ring().replace_ring(std::move(ring));
    bench.run_data_cycles(judge, 3);
    bench.request_id_cycle();
    for (int n = 0; n < 3; ++n) bench.run_cycle();
    const auto status = bench.status();
    judge.expect(status.state != MasterState::run && !status.configuration_error.empty(),
                 "replaced_station_not_detected", [&] {
                   return Mismatch{
                       {fmt::format("another ID code at station {} is a configuration error", station)},
                       "the master goes on"};
                 });
  }
}

void expect_message(MasterBench& bench, CaseJudge& judge, std::uint16_t message, std::string_view reason,
                    const std::vector<int> interbus::MasterStatus::* list) {
  bench.bring_up(judge, interbus::line_of(4, kInOut, 1));
  for (const std::size_t station : {std::size_t{0}, std::size_t{2}, std::size_t{3}}) {
    bench.ring().set_messages(station, message);
    bench.run_data_cycles(judge, 3);
    judge.expect((bench.status().*list).empty(), "message_in_data_cycle",
                 "a message bit is visible in ID cycles only", "it is reported without one");
    bench.request_id_cycle();
    bench.run_data_cycles(judge, 2);
    judge.expect(bench.is_in_run(), "message_stops_bus", "the bus stays in run", "it does not");
    judge.expect((bench.status().*list) == std::vector<int>{static_cast<int>(station)}, reason, [&] {
      return Mismatch{{fmt::format("station {} is reported", station)}, "it is not, or others are"};
    });
    bench.ring().set_messages(station, 0);
    bench.request_id_cycle();
    bench.run_data_cycles(judge, 2);
  }
}

void peripheral_fault(MasterBench& bench, CaseJudge& judge) {
  expect_message(bench, judge, bench.rules().message_peripheral_fault, "peripheral_fault_missed",
                 &interbus::MasterStatus::peripheral_faults);
}

void reconfiguration(MasterBench& bench, CaseJudge& judge) {
  expect_message(bench, judge, bench.rules().message_reconfiguration, "reconfiguration_missed",
                 &interbus::MasterStatus::reconfigurations);
}

}  // namespace

std::vector<MasterCase> master_ring_change_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](std::string_view words, std::string_view purpose, std::string_view requirement,
                            judge::Reference reference, std::string_view stimulus, std::string_view expected,
                            std::vector<MustCatch> catches, auto procedure) {
    TestCase test_case;
    test_case.id = fmt::format("interbus/master/ring_change/{}", words);
    test_case.purpose = purpose;
    test_case.requirement = requirement;
    test_case.reference = std::move(reference);
    test_case.stimulus = stimulus;
    test_case.expected = expected;
    test_case.tags = {"must"};
    test_case.catches = std::move(catches);
    cases.push_back({std::move(test_case), procedure});
  };
  const judge::Reference stopped{"Phoenix Contact, ABB-DSC manual", "look for failure", Standing::searched};
  const judge::Reference compared{"IEC 61158-4-8, table of contents: acquiring and comparing configuration",
                                  "", Standing::searched};
  // Which bit means what is this project's choice, and that they show in ID cycles only is from memory.
  const judge::Reference messages{"this project; WAGO 750-304 manual",
                                  "meaning of the bits; dynamic messages in the ID register", Standing::own};
  add("cut_ring_is_located", "IM-17",
      "When the ring is cut the bus stops, the outputs are as declared and the master finds the place",
      stopped, "the cable cut after each station in turn",
      "stop within the declared number of cycles; the place named",
      {{"fault_not_searched", "fault_not_located"}}, cut_ring);
  add("added_station_is_reported", "IM-28", "A station that is added in run is a configuration error",
      compared, "a ring with one station more", "configuration error; the old configuration stays",
      {{"changed_ring_ignored", "changed_ring_not_reported"}}, added_station);
  add("removed_station_is_located", "IM-29", "A station that is removed in run is reported with its place",
      stopped, "a ring with one, or two stations less", "configuration error and the place",
      {{"changed_ring_ignored", "removed_station_not_reported"}}, removed_station);
  add("replaced_station_is_detected", "IM-30", "A station of the same length but another type is detected",
      compared, "another ID code of the same length at each station in turn, then an ID cycle",
      "configuration error", {{"id_type_ignored", "replaced_station_not_detected"}}, replaced_station);
  add("peripheral_fault_is_reported", "IM-31", "A peripheral fault is reported and leaves the bus in run",
      messages, "the message bit of a station, then an ID cycle", "the station is reported; run",
      {{"peripheral_fault_not_reported", "peripheral_fault_missed"}}, peripheral_fault);
  add("reconfiguration_request_is_reported", "IM-32", "A reconfiguration request is reported", messages,
      "the message bit of a station, then an ID cycle", "the station is reported; run",
      {{"reconfiguration_not_reported", "reconfiguration_missed"}}, reconfiguration);
  return cases;
}

}  // namespace fieldproof::conformance
