#include <fmt/format.h>

#include <algorithm>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// Frames on the line: preambles, clocks and jitter that a receiver must take.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr unsigned kMostPreamble = 8;
constexpr std::size_t kLongData = 200;

// A DU to the IUT with data that no other has.
Octets long_du(IsaBench& bench, Octets& data) {
  data = bench.numbered_data(kLongData);
  Octets octets{bench.control(bench.rules().codes.du, Priority::time_available), bench.address(),
                IsaBench::kPeer};
  octets.insert(octets.end(), data.begin(), data.end());
  return with_frame_check(octets);
}

void expect_heard(IsaBench& bench, CaseJudge& judge, const Octets& data, std::string_view reason,
                  const std::string& what) {
  const bool is_heard = bench.user().was_delivered(data);
  judge.expect(is_heard, reason, what, "it was not delivered");
  bench.user().deliveries.clear();
}

void all_preambles_are_taken(IsaBench& bench, CaseJudge& judge) {
  for (unsigned preamble = 1; preamble <= kMostPreamble; ++preamble) {
    Octets data;
    const Octets du = long_du(bench, data);
    bench.send_half_bits(half_bits_of_frame(du, preamble));
    bench.wait(bench.reply_wait());
    expect_heard(bench, judge, data, "preamble_not_taken",
                 fmt::format("a frame with {} octets of preamble is received", preamble));
    // What the station drives itself is held to the half bit after the case.
    bench.submit_unit_data(Priority::normal, bench.numbered_data(10));
    bench.send_half_bits(half_bits_of_frame(with_frame_check(bench.et(Priority::normal)), preamble));
    judge.expect(!bench.listen().empty(), "token_not_returned", "data, and EE", "silence");
  }
}

void other_clocks_are_taken(IsaBench& bench, CaseJudge& judge) {
  constexpr std::int64_t kParts = 1'000'000;
  for (const std::int64_t parts : {kParts, kParts + 2'000, kParts - 2'000}) {
    for (int n = 0; n < bench.volume(1, 10); ++n) {
      Octets data;
      line::Levels half_bits = half_bits_of_frame(long_du(bench, data));
      bench.send_wave({bench.now(), 2 * bench.rules().link.bit_rate * parts / kParts, std::move(half_bits)});
      bench.wait(bench.reply_wait());
      expect_heard(bench, judge, data, "clock_not_taken",
                   fmt::format("a frame at {:.1f} % of the bit rate is received",
                               100.0 * static_cast<double>(parts) / static_cast<double>(kParts)));
    }
  }
}

// Each edge moved by up to a tenth of a bit, in hundredths of a half bit.
line::Waveform jittered(IsaBench& bench, const line::Levels& half_bits) {
  constexpr std::int64_t kFiner = 100;
  constexpr std::uint64_t kMost = 20;
  line::Waveform wave{bench.now(), 2 * bench.rules().link.bit_rate * kFiner, {}};
  std::size_t written = 0;
  for (std::size_t at = 0; at < half_bits.size();) {
    const std::size_t end = half_bits.end_of_run(at);
    std::size_t edge = end * kFiner;
    if (end < half_bits.size()) edge += bench.random().below(2 * kMost + 1) - kMost;
    wave.levels.append_fill(half_bits[at], edge - written);
    written = edge;
    at = end;
  }
  return wave;
}

void jitter_is_taken(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 50); ++n) {
    Octets data;
    const line::Levels half_bits = half_bits_of_frame(long_du(bench, data));
    bench.send_wave(jittered(bench, half_bits));
    bench.wait(bench.reply_wait());
    expect_heard(bench, judge, data, "jitter_not_taken",
                 "a frame whose edges are up to a tenth of a bit off is received");
  }
}

void a_token_is_used(IsaBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    const Octets data = bench.numbered_data(2 + bench.random().below(100));
    bench.submit_unit_data(Priority::normal, data);
    const kernel::Time end = bench.send(bench.et(Priority::normal));
    expect_data(judge, expect_token_use(bench, judge, end), {data}, "no_data_frame", "more_than_one_frame");
  }
}

IsaCase at_rate(std::int64_t bit_rate, const std::string& name) {
  return {{.id = "fieldbus_dll/isa_dle/line/a_token_is_used_at_" + name,
           .purpose = "ISA-01",
           .requirement = "All that is counted in octets scales with the bit rate.",
           .reference = link_sources::line("bit rates"),
           .stimulus = "Data, and an ET, at " + name + ".",
           .expected = "As at 31.25 kbit/s: one DU, an EE.",
           .tags = {"must"},
           .catches = {{"timers_of_31250", "token_not_returned"}}},
          a_token_is_used,
          {.schedule = {}, .is_scheduler = true, .bit_rate = bit_rate}};
}

}  // namespace

std::vector<IsaCase> isa_line_cases() {
  using link_sources::line;
  using link_sources::memory;
  return {
      {{.id = "fieldbus_dll/isa_dle/line/all_preambles_are_taken",
        .purpose = "ISA-39",
        .requirement = "A frame has 1 to 8 octets of preamble and both delimiters, to the half bit.",
        .reference = line("preamble and delimiters"),
        .stimulus = "Frames with 1 to 8 octets of preamble; tokens under which the IUT sends some itself.",
        .expected = "All are received; what the IUT sends is exact, and has V(MID) of silence in front.",
        .tags = {"must"},
        .catches = {{"wants_one_preamble_octet", "preamble_not_taken"},
                    {"sends_no_preamble", "frame_malformed"},
                    {"end_delimiter_turned", "frame_malformed"},
                    {"least_significant_bit_first", "check_wrong"},
                    {"short_silence", "gap_too_short"}}},
       all_preambles_are_taken},
      {{.id = "fieldbus_dll/isa_dle/line/other_clocks_are_taken",
        .purpose = "ISA-40",
        .requirement = "A receiver takes frames whose clock is 0.2 % off.",
        .reference = memory("tolerance of the bit rate"),
        .stimulus = "Frames of 205 octets at 99.8, 100 and 100.2 % of the bit rate.",
        .expected = "All are received.",
        .tags = {"must", "timing"},
        .catches = {{"does_not_recover_clock", "clock_not_taken"}}},
       other_clocks_are_taken},
      {{.id = "fieldbus_dll/isa_dle/line/jitter_is_taken",
        .purpose = "ISA-40",
        .requirement = "A receiver takes frames whose edges are up to a tenth of a bit off.",
        .reference = memory("jitter at a receiver"),
        .stimulus = "Frames of 205 octets, each edge moved at random.",
        .expected = "All are received.",
        .tags = {"must", "timing"},
        .catches = {{"wants_exact_edges", "jitter_not_taken"}}},
       jitter_is_taken},
      at_rate(1'000'000, "1_Mbit_s"),
      at_rate(2'500'000, "2500_kbit_s"),
  };
}

}  // namespace fieldproof::conformance
