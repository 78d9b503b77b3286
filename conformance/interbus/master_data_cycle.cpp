// Chapter data_cycle: the summation frame as a master sends it (IM-06, IM-07).
#include <fmt/format.h>

#include <array>
#include <utility>

#include "conformance/interbus/master_scene.hpp"

namespace fieldproof::conformance {

namespace {

using namespace master_chart;
using interbus::SeenCycle;
using judge::Standing;

// With 2, 4, 64 and 512 user octets.
void run_ring(RingScene& scene) {
  const std::array<Ring, 4> rings{interbus::line_of(1, kOneWord, 1), paper_ring(),
                                  interbus::line_of(4, 0x0603, 8), interbus::line_of(8, 0x1403, 32)};
  scene.bench.bring_up(scene.judge, rings.at(scene.round));
  for (unsigned word = 0; word < scene.bench.ring().word_count(); ++word)
    scene.bench.write_output(word, static_cast<std::uint16_t>(0x4000 + word));
  scene.bench.run_data_cycles(scene.judge, 2);
}

void expect_order(MasterBench& bench, CaseJudge& judge) {
  const auto words = static_cast<unsigned>(bench.ring().word_count());
  const SeenCycle& seen = bench.ring().last_cycle();
  judge.expect_equal(seen.octets.size(), 6 + 2 * words + bench.rules().end_telegrams, "telegram_count",
                     "telegrams of a data cycle");
  judge.expect(seen.word(0) == bench.rules().loopback_word, "loopback_word_not_first",
               "two octets of loopback word first", "another word");
  std::size_t octet = 2;
  unsigned end = words;
  const Ring& ring = bench.ring().stations();
  for (auto station = ring.rbegin(); station != ring.rend(); ++station) {
    for (unsigned word = end - station->words; word < end; ++word, octet += 2) {
      judge.expect(seen.word(octet) == 0x4000 + word, "data_order", [&] {
        return Mismatch{{fmt::format("word {} of the image at octet {}", word, octet)},
                        seen.describe_word(octet),
                        seen.start,
                        fmt::format("octet {} of the frame", octet)};
      });
    }
    end -= station->words;
  }
}

void expect_good_checks(MasterBench& bench, CaseJudge& judge) {
  judge.expect(bench.ring().statistics().bad_checks == 0, "check_not_of_sent_bits",
               "the check is that of the loopback word and the transferred octets", "another check");
}

void begin_cycles(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(interbus::line_of(2, 0x0203, 2));
  bench.run_until([&bench] { return bench.ring().cycle_count() > 1; }, kernel::kSecond);
  expect_good_checks(bench, judge);
  judge.expect(bench.wait_for_run(), "not_in_run", "the master runs", "it does not");
}

void expect_check_of_outputs(MasterBench& bench, CaseJudge& judge) {
  for (unsigned word = 0; word < 4; ++word)
    bench.write_output(word, static_cast<std::uint16_t>(bench.random().next()));
  bench.run_data_cycles(judge, 1);
  const SeenCycle& seen = bench.ring().last_cycle();
  judge.expect(seen.status_clean, "status_word_not_clean", "status word 0000h", "another status word");
  const std::uint16_t own = bench.ring().check_of({seen.octets.data(), seen.transfer_octets});
  judge.expect(seen.word(seen.transfer_octets) == own, "check_not_of_sent_bits",
               fmt::format("check word {:04X}h", own), seen.describe_word(seen.transfer_octets));
  expect_good_checks(bench, judge);
}

}  // namespace

std::vector<MasterCase> master_data_cycle_cases() {
  const std::string computed = "the check is that of an independent computation over the bits on the line";
  return {
      master_case("data_cycle/last_station_comes_first", "IM-06",
                  "A data cycle has the loopback word, the output data of the last station first, and the "
                  "frame check: 6 + n telegrams",
                  {"Park 2004, section 2.2", "frame information", Standing::seed}, {"must"},
                  {{"first_station_first", "data_order"}},
                  {.steps = {stimulus<RingScene>("2 data cycles, each output word another value", run_ring),
                             step("", "6 + n telegrams in the order of the ring from its end", expect_order)},
                   .walk = {"rings with 2, 4, 64 and 512 user octets",
                            [](RingScene& scene) { return scene.bench.volume<std::size_t>(3, 4); }}}),
      resting_also_on(
          {{"this project", "status word 0000h of a clean cycle", Standing::own}, {"status_word_not_clean"}},
          master_case("data_cycle/check_covers_what_was_sent", "IM-07",
                      "The master's check covers the loopback word and the data, not the headers; its status "
                      "word is clean",
                      {"Buesing/Meyer, Practical Guide", "check per segment", Standing::searched}, {"must"},
                      {{"check_omits_loopback", "check_not_of_sent_bits"},
                       {"check_covers_headers", "check_not_of_sent_bits"}},
                      {{20, 2000},
                       {step("a data cycle with random outputs", computed + "; status word 0000h",
                             expect_check_of_outputs)},
                       {step("power up with two stations", computed, begin_cycles)}}))};
}

}  // namespace fieldproof::conformance
