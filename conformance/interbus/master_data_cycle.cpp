// Chapter data_cycle: the summation frame as a master sends it (IM-06, IM-07).
#include <fmt/format.h>

#include <utility>

#include "conformance/interbus/master_cases.hpp"

namespace fieldproof::conformance {

namespace {

using interbus::SeenCycle;
using interbus::VirtualStation;
using judge::Standing;

void expect_frame(MasterBench& bench, CaseJudge& judge, const std::vector<VirtualStation>& ring) {
  bench.bring_up(judge, ring);
  const auto words = static_cast<unsigned>(bench.ring().word_count());
  for (unsigned word = 0; word < words; ++word) {
    bench.write_output(word, static_cast<std::uint16_t>(0x4000 + word));
  }
  bench.run_data_cycles(judge, 2);
  const SeenCycle& seen = bench.ring().last_cycle();
  judge.expect_equal(seen.octets.size(), 6 + 2 * words + bench.rules().end_telegrams, "telegram_count",
                     "telegrams of a data cycle");
  judge.expect(seen.word(0) == bench.rules().loopback_word, "loopback_word_not_first",
               "two octets of loopback word first", "another word");
  std::size_t octet = 2;
  unsigned end = words;
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

void frame_order(MasterBench& bench, CaseJudge& judge) {
  expect_frame(bench, judge, interbus::line_of(1, 0x0103, 1));
  expect_frame(bench, judge, paper_ring());
  expect_frame(bench, judge, interbus::line_of(4, 0x0603, 8));
  if (bench.volume(0, 1) != 0) expect_frame(bench, judge, interbus::line_of(8, 0x1403, 32));
}

void check_of_what_was_sent(MasterBench& bench, CaseJudge& judge) {
  bench.power_up(interbus::line_of(2, 0x0203, 2));
  judge.use_clock([&bench] { return bench.now(); });
  judge.use_decode([&bench] { return bench.ring().describe_last(6); });
  const auto expect_good = [&] {
    judge.expect(bench.ring().statistics().bad_checks == 0, "check_not_of_sent_bits",
                 "the check is that of the loopback word and the transferred octets", "another check");
  };
  bench.run_until([&bench] { return bench.ring().cycle_count() > 1; }, kernel::kSecond);
  expect_good();
  judge.expect(bench.wait_for_run(), "not_in_run", "the master runs", "it does not");
  for (std::uint64_t n = bench.volume<std::uint64_t>(20, 2000); n > 0; --n) {
    for (unsigned word = 0; word < 4; ++word) {
      bench.write_output(word, static_cast<std::uint16_t>(bench.random().next()));
    }
    bench.run_data_cycles(judge, 1);
    const SeenCycle& seen = bench.ring().last_cycle();
    judge.expect(seen.status_clean, "status_word_not_clean", "status word 0000h", "another status word");
    const std::uint16_t own = interbus::RingEmulator::check_of({seen.octets.data(), seen.transfer_octets});
    judge.expect(seen.word(seen.transfer_octets) == own, "check_not_of_sent_bits", [&] {
      return Mismatch{{fmt::format("check word {:04X}h", own)}, seen.describe_word(seen.transfer_octets)};
    });
  }
  expect_good();
}

}  // namespace

std::vector<MasterCase> master_data_cycle_cases() {
  std::vector<MasterCase> cases;
  cases.push_back(
      {{.id = "interbus/master/data_cycle/last_station_comes_first",
        .purpose = "IM-06",
        .requirement =
            "A data cycle has the loopback word, the output data of the last station first, and the "
            "frame check: 6 + n telegrams",
        .reference = {"Park 2004, section 2.2", "frame information", Standing::seed},
        .stimulus = "rings with 2, 4, 64 and 512 user octets, each output word another value",
        .expected = "6 + n telegrams in the order of the ring from its end",
        .tags = {"must"},
        .catches = {{"first_station_first", "data_order"}},
        .not_applicable = {}},
       frame_order});
  cases.push_back(
      {{.id = "interbus/master/data_cycle/check_covers_what_was_sent",
        .purpose = "IM-07",
        .requirement =
            "The master's check covers the loopback word and the data, not the headers; its status "
            "word is clean",
        .reference = {"Buesing/Meyer, Practical Guide", "check per segment", Standing::searched},
        .details = {{{"this project", "status word 0000h of a clean cycle", Standing::own},
                     {"status_word_not_clean"}}},
        .stimulus = "random outputs",
        .expected = "the check of an independent computation over the bits on the line; status word 0000h",
        .tags = {"must"},
        .catches = {{"check_omits_loopback", "check_not_of_sent_bits"},
                    {"check_covers_headers", "check_not_of_sent_bits"}},
        .not_applicable = {}},
       check_of_what_was_sent});
  return cases;
}

}  // namespace fieldproof::conformance
