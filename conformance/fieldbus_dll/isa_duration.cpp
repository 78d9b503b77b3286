#include <fmt/format.h>

#include "conformance/fieldbus_dll/isa_cases.hpp"
#include "conformance/fieldbus_dll/isa_expect.hpp"

// The duration of an ES: what fits, to the octet.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::EndReason;
using fieldbus_dll::Priority;

constexpr std::size_t kHeader = 3;
constexpr std::size_t kEndOctets = 4;

// In octet durations, a begun one counted.
unsigned in_octets(const IsaBench& bench, kernel::Duration duration) {
  const kernel::Duration one = bench.octets(1);
  return static_cast<unsigned>((duration + one - kLinkRounding) / one);
}

// How long the IUT itself takes until it begins, after an ES.
kernel::Duration start_latency(IsaBench& bench, CaseJudge& judge) {
  const Octets data = bench.numbered_data(8);
  bench.submit_unit_data(Priority::normal, data);
  const kernel::Time end = bench.send(bench.es(Priority::time_available, 500));
  const TokenUse use = expect_token_use(bench, judge, end);
  expect_data(judge, use, {data}, "frames_missing", "sent_twice");
  return use.data[0].begin - end;
}

// The least duration into which a DU with `size` octets fits: it, V(MID), and the EE.
unsigned exact_fit(const IsaBench& bench, kernel::Duration latency, std::size_t size) {
  return in_octets(bench,
                   latency + bench.frame(kHeader + size) + bench.least_gap() + bench.frame(kEndOctets));
}

// In whole octet durations: a station that begins sooner than these does not.
kernel::Duration in_full_octets(const IsaBench& bench, kernel::Duration duration) {
  return bench.octets(duration / bench.octets(1));
}

void an_exact_fit_is_sent(IsaBench& bench, CaseJudge& judge) {
  const kernel::Duration latency = start_latency(bench, judge);
  judge.measure("start latency", "octets", static_cast<double>(latency / bench.octets(1)));
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    const Octets data = bench.numbered_data(2 + bench.random().below(120));
    bench.submit_unit_data(Priority::normal, data);
    const unsigned duration = exact_fit(bench, latency, data.size());
    const kernel::Time end = bench.send(bench.es(Priority::time_available, duration));
    const TokenUse use = expect_token_use(bench, judge, end);
    const kernel::Time over = end + bench.octets(duration);
    // It may begin a little later than it did before, so that nothing fits.
    const kernel::Duration needed =
        bench.frame(kHeader + data.size()) + bench.least_gap() + bench.frame(kEndOctets);
    const bool begins_late = use.data.empty() && use.end.begin + needed > over + kLinkRounding;
    if (begins_late) {
      const kernel::Time again = bench.send(bench.es(Priority::time_available, 2 * duration));
      expect_data(judge, expect_token_use(bench, judge, again), {data}, "frames_missing", "sent_twice");
      continue;
    }
    expect_data(judge, use, {data}, "exact_fit_not_sent", "sent_twice");
    judge.expect(use.end.end <= over + kLinkRounding, "talks_behind_duration", [&] {
      return Mismatch{{fmt::format("the EE ends until {}", kernel::describe(over))},
                      kernel::describe(use.end.end),
                      use.end.begin};
    });
  }
}

void what_does_not_fit_stays(IsaBench& bench, CaseJudge& judge) {
  const kernel::Duration latency = in_full_octets(bench, start_latency(bench, judge));
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    const Octets data = bench.numbered_data(2 + bench.random().below(120));
    bench.submit_unit_data(Priority::normal, data);
    const unsigned duration = exact_fit(bench, latency, data.size()) - 1;
    const kernel::Time end = bench.send(bench.es(Priority::time_available, duration));
    const TokenUse use = expect_token_use(bench, judge, end);
    expect_data(judge, use, {}, "", "sends_what_does_not_fit");
    expect_end_reason(judge, use, EndReason::no_time);
    const kernel::Time again = bench.send(bench.es(Priority::time_available, duration + 100));
    expect_data(judge, expect_token_use(bench, judge, again), {data}, "queued_data_lost", "sent_twice");
  }
}

void nothing_is_sent_behind_the_duration(IsaBench& bench, CaseJudge& judge) {
  for (const unsigned duration : {10U, 20U, 50U, 100U, 500U, 5'000U}) {
    for (int n = 0; n < 25; ++n) {
      bench.submit_unit_data(Priority::time_available, bench.numbered_data(2 + bench.random().below(250)));
    }
    const kernel::Time over =
        bench.send(bench.es(Priority::time_available, duration)) + bench.octets(duration);
    kernel::Duration left = bench.octets(duration);
    for (const DrivenDlpdu& one : bench.listen()) {
      judge.expect(one.end <= over + kLinkRounding, "talks_behind_duration", [&] {
        return Mismatch{
            {fmt::format("silence after {}, {} octets after the ES", kernel::describe(over), duration)},
            fmt::format("{} until {}", one.text(), kernel::describe(one.end)),
            one.begin};
      });
      left = over - one.end;
    }
    judge.measure(fmt::format("left of {} octets", duration), "octets",
                  static_cast<double>(left / bench.octets(1)));
    // All that is left goes before the next one.
    for (int n = 0; n < 3; ++n) {
      bench.send(bench.es(Priority::time_available, 8'000));
      judge.expect(!bench.listen().empty(), "token_not_returned", "under a token of 8000 octets data, and EE",
                   "silence");
    }
  }
}

void no_duration_is_no_token(IsaBench& bench, CaseJudge& judge) {
  const Octets data = bench.numbered_data(4);
  bench.submit_unit_data(Priority::urgent, data);
  for (const Priority least : {Priority::urgent, Priority::normal, Priority::time_available}) {
    bench.send(bench.es(least, 0));
    expect_silence(bench, judge, "acts_on_no_duration", "an ES for 0 octets is none");
  }
  const kernel::Time end = bench.send(bench.es(Priority::normal, 200));
  expect_data(judge, expect_token_use(bench, judge, end), {data}, "does_not_recover", "sent_twice");
}

}  // namespace

std::vector<IsaCase> isa_duration_cases() {
  using link_sources::isa_paper;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/isa_dle/duration/an_exact_fit_is_sent",
        .purpose = "ISA-08",
        .requirement = "A frame is sent under an ES when it, V(MID) and the EE end within its duration.",
        .reference = isa_paper("duration guarded on both sides"),
        .details = {{own("what the duration must hold"), {"exact_fit_not_sent"}}},
        .stimulus = "The start latency is measured; ES for exactly what a frame needs, of several lengths.",
        .expected = "The frame and the EE, which ends in time.",
        .tags = {"must", "timing"},
        .catches = {{"fit_is_strict", "exact_fit_not_sent"},
                    {"duration_from_begin_of_es", "exact_fit_not_sent"}}},
       an_exact_fit_is_sent},
      {{.id = "fieldbus_dll/isa_dle/duration/what_does_not_fit_stays",
        .purpose = "ISA-09",
        .requirement = "A frame that does not fit stays queued, and the token is returned.",
        .reference = own("what the duration must hold"),
        .stimulus = "ES for one octet less than a frame needs; then a longer one.",
        .expected = "An EE with reason 1; the frame under the second ES.",
        .tags = {"must", "timing"},
        .catches = {{"fit_without_end", "token_not_returned"},
                    {"fits_always", "sends_what_does_not_fit"},
                    {"queue_lost_without_time", "queued_data_lost"}}},
       what_does_not_fit_stays},
      {{.id = "fieldbus_dll/isa_dle/duration/nothing_is_sent_behind_it",
        .purpose = "ISA-12",
        .requirement = "A station sends nothing after the duration of its token, the EE included.",
        .reference = isa_paper("VC(RD) at the holder"),
        .stimulus = "More data than fits; ES for 10, 20, 50, 100, 500, 5000 octets.",
        .expected = "The last frame ends within the duration.",
        .tags = {"must", "timing"},
        .catches = {{"end_behind_duration", "talks_behind_duration"},
                    {"duration_little_endian", "talks_behind_duration"},
                    {"duration_ignored", "talks_behind_duration"}}},
       nothing_is_sent_behind_the_duration},
      {{.id = "fieldbus_dll/isa_dle/duration/zero_is_no_token",
        .purpose = "ISA-13",
        .requirement = "An ES for no duration is ignored.",
        .reference = own("0 is no duration"),
        .stimulus = "Data, and ES for 0 octets of each priority; then a right one.",
        .expected = "Silence; then the data.",
        .tags = {"must"},
        .catches = {{"zero_is_for_ever", "acts_on_no_duration"}}},
       no_duration_is_no_token},
  };
}

}  // namespace fieldproof::conformance
