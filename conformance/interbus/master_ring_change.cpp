// Chapter ring_change: cut cables, stations that come, go and change, messages (IM-17, IM-28 to IM-32).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::FaultLocation;
using interbus::MasterState;
using judge::Standing;

constexpr std::size_t kStations = 3;  // of the ring that most of these cases use

Ring plain_line(std::size_t stations) {
  return interbus::line_of(stations, kOneWord, 1);
}

int stations_to_cut(const MasterBench& bench) {
  return bench.volume(3, 8);
}

constexpr std::uint16_t kOutput = 0x0001;

void run_with_outputs(MasterBench& bench, CaseJudge& judge) {
  bench.bring_up(judge, plain_line(static_cast<std::size_t>(stations_to_cut(bench))));
  for (unsigned word = 0; word < bench.ring().word_count(); ++word) bench.write_output(word, kOutput);
  bench.run_data_cycles(judge, 2);
}

MasterStep leaves_run(std::string reason) {
  const auto leave_run = [reason = std::move(reason)](RingScene& scene) {
    const unsigned most = scene.bench.rules().stop_after_bad_cycles;
    for (unsigned n = 0; n < most && scene.bench.is_in_run(); ++n) scene.bench.run_cycle();
    scene.judge.expect(!scene.bench.is_in_run(), reason,
                       fmt::format("the master leaves run within {} cycles", most), "it is in run");
  };
  return {"", "the master leaves run within the declared number of cycles", leave_run};
}

// Between station round - 1 + `more` and the next one.
MasterStep fault_located(int more) {
  return expected<RingScene>("it searches, and names the place of the fault", [more](RingScene& scene) {
    MasterBench& bench = scene.bench;
    bench.run_for(2 * bench.rules().silence_limit);
    bench.run_until([&] { return bench.status().state == MasterState::bus_stop; },
                    500 * kernel::kMillisecond);
    const int from = static_cast<int>(scene.round) - 1 + more;
    const auto status = bench.status();
    scene.judge.expect(
        status.has_fault_location && status.fault_location == FaultLocation{from, from + 1},
        "fault_not_located", fmt::format("fault between {} and {}", from, from + 1),
        status.has_fault_location
            ? fmt::format("between {} and {}", status.fault_location.from, status.fault_location.to)
            : "no location");
  });
}

void expect_declared_outputs(MasterBench& bench, CaseJudge& judge) {
  const auto all_are = [&bench](std::uint16_t value) {
    for (unsigned word = 0; word < bench.ring().word_count(); ++word) {
      if (bench.master().output(word) != value) return false;
    }
    return true;
  };
  constexpr std::string_view kItem = "outputs_after_bus_stop";
  judge.expect((all_are(0) && bench.may_answer(kItem, "zero")) ||
                   (all_are(kOutput) && bench.may_answer(kItem, "held")),
               "outputs_not_safe", "as declared, all outputs are 0 or held after the bus stop",
               "they are not");
}

MasterStep three_stations() {
  return in_run("three stations", plain_line(kStations));
}

MasterStep replaced(std::string text, Ring (*ring)(unsigned round)) {
  return stimulus<RingScene>(
      std::move(text), [ring](RingScene& scene) { scene.bench.ring().replace_ring(ring(scene.round)); });
}

Ring with_another_station(unsigned round) {
  Ring ring = plain_line(kStations);
  ring.at(round).id_code = 0x0133;
  return ring;
}

MasterStep id_cycle_asked_for() {
  return step("the application asks for an ID cycle", "",
              [](MasterBench& bench, CaseJudge&) { bench.request_id_cycle(); });
}

using StationList = const std::vector<int> interbus::MasterStatus::*;

// The first station, one in the middle and the last one.
std::size_t station_in_turn(const RingScene& scene) {
  return scene.round == 0 ? 0 : scene.round + 1;
}

MasterChart message_chart(std::uint16_t interbus::Rules::* bit, StationList list, std::string reason) {
  const auto set_bit = [bit](RingScene& scene) {
    scene.bench.ring().set_messages(station_in_turn(scene), scene.bench.rules().*bit);
  };
  const auto clear_bit = [](RingScene& scene) { scene.bench.ring().set_messages(station_in_turn(scene), 0); };
  const auto expect_none = [list](RingScene& scene) {
    scene.judge.expect((scene.bench.status().*list).empty(), "message_in_data_cycle",
                       "a message bit is visible in ID cycles only", "it is reported without one");
  };
  const auto expect_station = [list, reason = std::move(reason)](RingScene& scene) {
    const auto station = static_cast<int>(station_in_turn(scene));
    scene.judge.expect(scene.bench.is_in_run(), "message_stops_bus", "the bus stays in run", "it does not");
    scene.judge.expect(scene.bench.status().*list == std::vector<int>{station}, reason,
                       fmt::format("station {} is reported", station), "it is not, or others are");
  };
  return {.steps = {{"its message bit is set", "", set_bit},
                    data_cycles(3),
                    {"", "nothing is reported without an ID cycle", expect_none},
                    id_cycle_asked_for(),
                    data_cycles(2),
                    {"", "the station is reported, the bus stays in run", expect_station},
                    {"the bit is cleared", "", clear_bit},
                    id_cycle_asked_for(),
                    data_cycles(2)},
          .first = {in_run("four stations", plain_line(4))},
          .walk = each("each of the first, the third and the last station", 3)};
}

// Which bit means what is this project's choice, and that they show in ID cycles only is from memory.
const judge::Reference kMessages{"this project; WAGO 750-304 manual",
                                 "meaning of the bits; dynamic messages in the ID register", Standing::own};

}  // namespace

std::vector<MasterCase> master_ring_change_cases() {
  const judge::Reference stopped{"Phoenix Contact, ABB-DSC manual", "look for failure", Standing::searched};
  const judge::Reference compared{"IEC 61158-4-8, table of contents: acquiring and comparing configuration",
                                  "", Standing::searched};
  const std::string error = "a configuration error is reported";
  return {
      master_case(
          "ring_change/cut_ring_is_located", "IM-17",
          "When the ring is cut the bus stops, the outputs are as declared and the master finds the place",
          stopped, {"must"}, {{"fault_not_searched", "fault_not_located"}},
          {.steps = {step("the master runs on 8 stations with outputs that are set", "", run_with_outputs),
                     stimulus<RingScene>("the cable is cut",
                                         [](RingScene& scene) {
                                           scene.bench.ring().cut_after(static_cast<int>(scene.round) - 1);
                                         }),
                     leaves_run("cut_not_detected"), fault_located(0),
                     step("", "the outputs are as declared", expect_declared_outputs)},
           .walk = {"each cable of the ring",
                    [](RingScene& scene) {
                      return static_cast<std::size_t>(stations_to_cut(scene.bench));
                    }}}),
      master_case("ring_change/added_station_is_reported", "IM-28",
                  "A station that is added in run is a configuration error", compared, {"must"},
                  {{"changed_ring_ignored", "changed_ring_not_reported"}},
                  {.steps = {three_stations(),
                             replaced("a fourth station is added", [](unsigned) { return plain_line(4); }),
                             leaves_run("changed_ring_not_reported"),
                             configuration_error(error, "changed_ring_not_reported"),
                             expected<RingScene>("the old configuration stays",
                                                 [](RingScene& scene) {
                                                   scene.judge.expect_equal(
                                                       scene.bench.status().stations.size(), kStations,
                                                       "silently_remapped", "stations of the configuration");
                                                 })}}),
      master_case(
          "ring_change/removed_station_is_located", "IM-29",
          "A station that is removed in run is reported with its place", stopped, {"must"},
          {{"changed_ring_ignored", "removed_station_not_reported"}},
          {.steps = {three_stations(),
                     replaced("the others are removed", [](unsigned round) { return plain_line(round + 1); }),
                     leaves_run("removed_station_not_reported"),
                     configuration_error(error, "removed_station_not_reported"), fault_located(1)},
           .walk = each("each of one and two stations that stay", kStations - 1)}),
      master_case("ring_change/replaced_station_is_detected", "IM-30",
                  "A station of the same length but another type is detected", compared, {"must"},
                  {{"id_type_ignored", "replaced_station_not_detected"}},
                  {.steps = {three_stations(),
                             replaced("it has another ID code of the same length", with_another_station),
                             data_cycles(3), id_cycle_asked_for(),
                             stimulus<RingScene>("3 cycles",
                                                 [](RingScene& scene) {
                                                   for (int n = 0; n < 3; ++n) scene.bench.run_cycle();
                                                 }),
                             configuration_error(error, "replaced_station_not_detected")},
                   .walk = each("each station", kStations)}),
      master_case("ring_change/peripheral_fault_is_reported", "IM-31",
                  "A peripheral fault is reported and leaves the bus in run", kMessages, {"must"},
                  {{"peripheral_fault_not_reported", "peripheral_fault_missed"}},
                  message_chart(&interbus::Rules::message_peripheral_fault,
                                &interbus::MasterStatus::peripheral_faults, "peripheral_fault_missed")),
      master_case("ring_change/reconfiguration_request_is_reported", "IM-32",
                  "A reconfiguration request is reported", kMessages, {"must"},
                  {{"reconfiguration_not_reported", "reconfiguration_missed"}},
                  message_chart(&interbus::Rules::message_reconfiguration,
                                &interbus::MasterStatus::reconfigurations, "reconfiguration_missed"))};
}

}  // namespace fieldproof::conformance
