// Chapter identification: what a master finds on a ring (IM-02 to IM-05).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/length_codes.hpp"
#include "conformance/interbus/master_cases.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::FoundStation;
using interbus::MasterState;
using interbus::SeenCycle;
using interbus::VirtualStation;
using judge::Standing;

constexpr std::uint16_t kOneWord = 0x0103;

void first_cycle(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(interbus::line_of(1, kOneWord, 1));
  judge.use_clock([&bench] { return bench.now(); });
  judge.use_decode([&bench] { return bench.ring().describe_last(6); });
  bench.run_until([&bench] { return bench.ring().cycle_count() > 1; }, kernel::kSecond);
  judge.expect(bench.ring().cycle_count() > 1, "no_cycle", "cycles within 1 s", "none");
  const SeenCycle& first = bench.ring().first_cycle();
  judge.expect(first.is_id_cycle, "first_cycle_no_id_cycle", "the first cycle is an ID cycle",
               "it is a data cycle");
  judge.expect(first.word(0) == bench.rules().loopback_word, "loopback_word_not_first",
               "the loopback word comes first", "another word comes first");
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

void expect_found(MasterBench& bench, CaseJudge& judge, const std::vector<VirtualStation>& ring) {
  bench.power_up(ring);
  const bool is_running = bench.wait_for_run();
  const auto status = bench.status();
  if (ring.empty()) {
    judge.expect(status.state == MasterState::ready || status.state == MasterState::identification,
                 "configuration_differs", "without a station the master stays ready", "it does not");
    return;
  }
  std::vector<FoundStation> expected;
  for (const VirtualStation& s : ring) expected.push_back({s.id_code, s.words, s.before, s.on_branch});
  judge.expect(is_running && status.stations == expected, "configuration_differs", [&] {
    return Mismatch{
        {fmt::format("{} stations as emulated", ring.size())},
        fmt::format("{} stations, error \"{}\"", status.stations.size(), status.configuration_error)};
  });
}

void configuration_equals_ring(MasterBench& bench, CaseJudge& judge) {
  expect_found(bench, judge, {});
  expect_found(bench, judge, interbus::line_of(1, kOneWord, 1));
  expect_found(bench, judge, interbus::line_of(2, kOneWord, 1));
  expect_found(bench, judge, mixed_tree());
  expect_found(bench, judge, interbus::line_of(10, 0x0203, 2));
  if (bench.volume(0, 1) == 0) return;
  expect_found(bench, judge, interbus::line_of(64, kOneWord, 1));
  expect_found(bench, judge, interbus::line_of(512, 0x0003, 0));
}

void expect_refused(MasterBench& bench, CaseJudge& judge, std::vector<VirtualStation> ring,
                    std::string_view what) {
  bench.power_up(std::move(ring));
  const bool is_running = bench.wait_for_run();
  const auto status = bench.status();
  judge.expect(!is_running && !status.configuration_error.empty(), "limit_not_refused", [&] {
    return Mismatch{{fmt::format("{} are refused with a configuration error", what)},
                    is_running ? "the master runs" : "no configuration error"};
  });
}

void limits_are_refused(MasterBench& bench, CaseJudge& judge) {
  // 513 stations take half a minute of bus time; the limit is a number, and a smaller one is the same rule.
  if (bench.volume(0, 1) == 0) bench.rules().max_stations = 6;
  const unsigned stations = bench.rules().max_stations;
  expect_refused(bench, judge, interbus::line_of(stations + 1, 0x0003, 0), "more stations than allowed");
  std::vector<VirtualStation> ring = interbus::line_of(5, 0x1103, 26);
  std::vector<VirtualStation> more = interbus::line_of(6, 0x1103, 26);
  if (bench.volume(0, 1) != 0) {
    ring = interbus::line_of(8, 0x1403, 32);
    more = ring;
    more.push_back({kOneWord, 1, 7, false});
  } else {
    bench.rules().max_io_points = 5 * 26 * 16;
  }
  bench.bring_up(judge, ring);
  expect_refused(bench, judge, more, "more I/O points than allowed");
}

constexpr std::string_view kCodeFromMemoryMisread = "length_code_from_memory_misread";
constexpr unsigned kEndOfCodes = 0x20;

std::uint16_t id_code_with(unsigned length_code) {
  return static_cast<std::uint16_t>(length_code << 8 | 0x03);
}

void length_codes(MasterBench& bench, CaseJudge& judge) {
  const std::size_t stride = bench.volume<std::size_t>(5, 1);
  for (std::size_t n = 1; n < kLengthCodes.size(); n += stride) {
    const auto [code, words] = kLengthCodes.at(n);
    bench.power_up(interbus::line_of(1, id_code_with(code), words));
    judge.expect(
        bench.wait_for_run() && bench.status().stations.at(0).words == words && bench.finished().is_accepted,
        code == kLengthCodeFromMemory ? kCodeFromMemoryMisread : "length_code_misread", [&] {
          return Mismatch{{fmt::format("code {:02X}h is {} words", code, words)},
                          "the ring has another length"};
        });
  }
  for (unsigned code = kFirstUndefinedLengthCode; code < kEndOfCodes; code += bench.volume(6U, 1U)) {
    bench.power_up(interbus::line_of(1, id_code_with(code), 1));
    const bool is_running = bench.wait_for_run();
    judge.expect(!is_running && !bench.status().configuration_error.empty(), "length_code_misread", [&] {
      return Mismatch{{fmt::format("the undefined code {:02X}h is refused", code)}, "it is taken"};
    });
  }
}

}  // namespace

std::vector<MasterCase> master_identification_cases() {
  std::vector<MasterCase> cases;
  const auto add = [&cases](TestCase test_case, auto procedure) {
    cases.push_back({std::move(test_case), procedure});
  };
  add({.id = "interbus/master/identification/first_cycle_is_an_id_cycle",
       .purpose = "IM-02",
       .requirement =
           "A master begins with an ID cycle; every cycle begins with the loopback word, and SL and "
           "CR tell cycle and phase",
       .reference = {"Beckhoff BC4000 documentation; Buesing/Meyer, Practical Guide", "ID cycle; SL and CR",
                     Standing::searched},
       .stimulus = "power up with one station on the ring",
       .expected = "an ID cycle first, loopback word first, headers constant within each phase",
       .tags = {"must"},
       .catches = {{"id_cycle_without_select", "first_cycle_no_id_cycle"},
                   {"select_dropped_in_check", "phase_bits_wrong"}},
       .not_applicable = {}},
      first_cycle);
  add({.id = "interbus/master/identification/configuration_equals_ring",
       .purpose = "IM-03",
       .requirement = "The master finds every station of the ring with ID code, length and place",
       .reference = {"literature from memory", "topology recognition", Standing::memory},
       .stimulus = "rings of 0, 1, 2, 10, 64 and 512 stations, and a tree with branches",
       .expected = "the list of stations is that of the ring; without a station it stays ready",
       .tags = {"must"},
       .catches = {{"branches_not_searched", "configuration_differs"}},
       .not_applicable = {}},
      configuration_equals_ring);
  add({.id = "interbus/master/identification/limits_are_refused",
       .purpose = "IM-04",
       .requirement = "More than 512 stations or 4096 I/O points are refused",
       .reference = {"Park 2004, section 2; Schneider INTERBUS manual", "limits", Standing::seed},
       .stimulus = "a ring with one station, or one word, too much",
       .expected = "a configuration error and no run",
       .tags = {"must"},
       .catches = {{"station_limit_ignored", "limit_not_refused"},
                   {"point_limit_ignored", "limit_not_refused"}},
       .not_applicable = {}},
      limits_are_refused);
  add({.id = "interbus/master/identification/length_codes_are_decoded",
       .purpose = "IM-05",
       .requirement =
           "The length code is read by its table, not as a binary number; an undefined one is refused",
       .reference = {"Schneider 890USE196, table of length codes", "ID code", Standing::searched},
       .details = {{{"literature from memory", "length code 14h", Standing::memory},
                    {std::string(kCodeFromMemoryMisread)}}},
       .stimulus = "a station with each length code of whole words, and with the codes 18h to 1Fh",
       .expected = "the expected length of the ring; an error for undefined codes",
       .tags = {"must"},
       .catches = {{"length_code_binary", "length_code_misread"}},
       .not_applicable = {}},
      length_codes);
  return cases;
}

}  // namespace fieldproof::conformance
