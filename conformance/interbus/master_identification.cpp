// Chapter identification: what a master finds on a ring (IM-02 to IM-05).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/length_codes.hpp"
#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::FoundStation;
using interbus::MasterState;
using interbus::SeenCycle;
using interbus::VirtualStation;
using judge::Standing;

void begin_with_id_cycle(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(interbus::line_of(1, kOneWord, 1));
  bench.run_until([&bench] { return bench.ring().cycle_count() > 1; }, kernel::kSecond);
  judge.expect(bench.ring().cycle_count() > 1, "no_cycle", "cycles within 1 s", "none");
  const SeenCycle& first = bench.ring().first_cycle();
  judge.expect(first.is_id_cycle, "first_cycle_no_id_cycle", "the first cycle is an ID cycle",
               "it is a data cycle");
  judge.expect(first.word(0) == bench.rules().loopback_word, "loopback_word_not_first",
               "the loopback word comes first", "another word comes first");
}

void expect_data_cycles(MasterBench& bench, CaseJudge& judge) {
  const bool is_running = bench.wait_for_run();
  judge.expect(bench.ring().statistics().wrong_phases == 0, "phase_bits_wrong",
               "SL the same in all telegrams of a cycle", "SL changes within a cycle");
  judge.expect(is_running, "not_in_run", "the master runs", "it does not");
  const SeenCycle& data = bench.ring().last_cycle();
  judge.expect(!data.is_id_cycle && data.word(0) == bench.rules().loopback_word, "loopback_word_not_first",
               "data cycles begin with the loopback word", "they do not");
}

std::vector<VirtualStation> mixed_tree() {
  // A coupler with three local stations, a plain station, a coupler with a branch that branches again.
  return {{0x0008, 0, -1, false}, {0x01BE, 1, 0, true},  {0x02BD, 2, 1, false}, {0x0E7F, 6, 2, false},
          {0x0103, 1, 0, false},  {0x0008, 0, 4, false}, {0x0004, 0, 5, true},  {0x01BE, 1, 6, true},
          {0x0333, 3, 6, false},  {0x0603, 8, 5, false}};
}

// The dear ones last.
const std::vector<Ring>& rings() {
  static const std::vector<Ring> all{{},
                                     interbus::line_of(1, kOneWord, 1),
                                     interbus::line_of(2, kOneWord, 1),
                                     mixed_tree(),
                                     interbus::line_of(10, 0x0203, 2),
                                     interbus::line_of(64, kOneWord, 1),
                                     interbus::line_of(512, 0x0003, 0)};
  return all;
}

void expect_found(RingScene& scene) {
  const Ring& ring = rings().at(scene.round);
  scene.bench.power_up(ring);
  const bool is_running = scene.bench.wait_for_run();
  const auto status = scene.bench.status();
  if (ring.empty()) {
    scene.judge.expect(status.state == MasterState::ready || status.state == MasterState::identification,
                       "configuration_differs", "without a station the master stays ready", "it does not");
    return;
  }
  std::vector<FoundStation> expected;
  for (const VirtualStation& s : ring) expected.push_back({s.id_code, s.words, s.before, s.on_branch});
  scene.judge.expect(
      is_running && status.stations == expected, "configuration_differs",
      fmt::format("{} stations as emulated", ring.size()),
      fmt::format("{} stations, error \"{}\"", status.stations.size(), status.configuration_error));
}

void expect_refused(MasterBench& bench, CaseJudge& judge, Ring ring, std::string_view reason,
                    const std::string& what) {
  bench.power_up(std::move(ring));
  const bool is_running = bench.wait_for_run();
  judge.expect(!is_running && !bench.status().configuration_error.empty(), reason,
               what + " refused with a configuration error",
               is_running ? "the master runs" : "no configuration error");
}

// 513 stations take half a minute of bus time; the limit is a number, and a smaller one is the same rule.
void refuse_stations(MasterBench& bench, CaseJudge& judge) {
  if (bench.volume(0, 1) == 0) bench.rules().max_stations = 6;
  expect_refused(bench, judge, interbus::line_of(bench.rules().max_stations + 1, 0x0003, 0),
                 "limit_not_refused", "more stations than allowed are");
}

void refuse_points(MasterBench& bench, CaseJudge& judge) {
  const bool is_full = bench.volume(0, 1) != 0;
  if (!is_full) bench.rules().max_io_points = 5 * 26 * 16;
  const Ring most = is_full ? interbus::line_of(8, 0x1403, 32) : interbus::line_of(5, 0x1103, 26);
  Ring more = is_full ? most : interbus::line_of(6, 0x1103, 26);
  if (is_full) more.push_back({kOneWord, 1, 7, false});
  bench.bring_up(judge, most);
  expect_refused(bench, judge, more, "limit_not_refused", "more I/O points than allowed are");
}

constexpr std::string_view kCodeFromMemoryMisread = "length_code_from_memory_misread";
constexpr unsigned kEndOfCodes = 0x20;

std::uint16_t id_code_with(unsigned length_code) {
  return static_cast<std::uint16_t>(length_code << 8 | 0x03);
}

void decode_lengths(MasterBench& bench, CaseJudge& judge) {
  const std::size_t stride = bench.volume<std::size_t>(5, 1);
  for (std::size_t n = 1; n < kLengthCodes.size(); n += stride) {
    const auto [code, words] = kLengthCodes.at(n);
    bench.power_up(interbus::line_of(1, id_code_with(code), words));
    judge.expect(
        bench.wait_for_run() && bench.status().stations.at(0).words == words && bench.finished().is_accepted,
        code == kLengthCodeFromMemory ? kCodeFromMemoryMisread : "length_code_misread",
        fmt::format("code {:02X}h is {} words", code, words), "the ring has another length");
  }
}

void refuse_undefined_lengths(MasterBench& bench, CaseJudge& judge) {
  for (unsigned code = kFirstUndefinedLengthCode; code < kEndOfCodes; code += bench.volume(6U, 1U)) {
    expect_refused(bench, judge, interbus::line_of(1, id_code_with(code), 1), "length_code_misread",
                   fmt::format("the undefined code {:02X}h is", code));
  }
}

}  // namespace

std::vector<MasterCase> master_identification_cases() {
  return {
      master_case(
          "identification/first_cycle_is_an_id_cycle", "IM-02",
          "A master begins with an ID cycle; every cycle begins with the loopback word, and SL and CR tell "
          "cycle and phase",
          {"Beckhoff BC4000 documentation; Buesing/Meyer, Practical Guide", "ID cycle; SL and CR",
           Standing::searched},
          {"must"},
          {{"id_cycle_without_select", "first_cycle_no_id_cycle"},
           {"select_dropped_in_check", "phase_bits_wrong"}},
          {.steps = {step("power up with one station on the ring",
                          "an ID cycle first, which begins with the loopback word", begin_with_id_cycle),
                     step("", "headers constant within each phase, data cycles with the loopback word first",
                          expect_data_cycles)}}),
      master_case(
          "identification/configuration_equals_ring", "IM-03",
          "The master finds every station of the ring with ID code, length and place",
          {"literature from memory", "topology recognition", Standing::memory}, {"must"},
          {{"branches_not_searched", "configuration_differs"}},
          {.steps = {{"power up",
                      "the list of stations is that of the ring; without a station it stays ready",
                      expect_found}},
           .walk = {"rings of 0, 1, 2, 10, 64 and 512 stations, and a tree with branches",
                    [](RingScene& scene) { return scene.bench.volume<std::size_t>(5, rings().size()); }}}),
      master_case(
          "identification/limits_are_refused", "IM-04",
          "More than 512 stations or 4096 I/O points are refused",
          {"Park 2004, section 2; Schneider INTERBUS manual", "limits", Standing::seed}, {"must"},
          {{"station_limit_ignored", "limit_not_refused"}, {"point_limit_ignored", "limit_not_refused"}},
          {.steps = {step("power up with one station too much", "a configuration error and no run",
                          refuse_stations),
                     step("power up with as many I/O points as allowed, then with a word more",
                          "it runs; then a configuration error and no run", refuse_points)}}),
      resting_also_on(
          {{"literature from memory", "length code 14h", Standing::memory},
           {std::string(kCodeFromMemoryMisread)}},
          master_case(
              "identification/length_codes_are_decoded", "IM-05",
              "The length code is read by its table, not as a binary number; an undefined one is refused",
              {"Schneider 890USE196, table of length codes", "ID code", Standing::searched}, {"must"},
              {{"length_code_binary", "length_code_misread"}},
              {.steps = {step("power up with a station with each length code of whole words",
                              "the length of the ring is that of the table", decode_lengths),
                         step("power up with a station with each of the codes 18h to 1Fh",
                              "a configuration error and no run", refuse_undefined_lengths)}}))};
}

}  // namespace fieldproof::conformance
