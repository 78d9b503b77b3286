#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// PT: what a device sends under a token, and how it returns it.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

constexpr unsigned kAmple = 3'000;     // octet durations: more than all that is queued needs
constexpr std::size_t kDt1Header = 5;  // with short addresses

std::vector<DrivenDlpdu> use_pt(FfBench& bench, CaseJudge& judge, Priority least, unsigned duration) {
  const kernel::Time end = bench.send(bench.pt(least, duration));
  return expect_token_used(bench, judge, end);
}

void only_what_is_urgent_enough_is_sent(FfBench& bench, CaseJudge& judge) {
  const Octets urgent = expect_submitted(bench, judge, Priority::urgent, 10);
  const Octets normal = expect_submitted(bench, judge, Priority::normal, 10);
  const Octets available = expect_submitted(bench, judge, Priority::time_available, 10);
  expect_dlsdus(judge, use_pt(bench, judge, Priority::normal, 1'000), {urgent, normal}, "frames_missing",
                "lower_priority_sent");
  expect_dlsdus(judge, use_pt(bench, judge, Priority::urgent, 1'000), {}, "", "lower_priority_sent");
  expect_dlsdus(judge, use_pt(bench, judge, Priority::time_available, 1'000), {available}, "frames_missing",
                "sent_twice");
}

void all_is_sent_in_order(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(1, 10); ++n) {
    std::vector<Octets> in_order(6);
    for (std::size_t i = 0; i < 2; ++i) {
      in_order[4 + i] = expect_submitted(bench, judge, Priority::time_available, 12);
      in_order[2 + i] = expect_submitted(bench, judge, Priority::normal, 12);
      in_order[i] = expect_submitted(bench, judge, Priority::urgent, 12);
    }
    expect_dlsdus(judge, use_pt(bench, judge, Priority::time_available, kAmple), in_order, "frames_missing",
                  "sent_twice", "wrong_order");
  }
}

void ff_an_empty_queue_returns_the_token(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    for (const Priority least : {Priority::urgent, Priority::normal, Priority::time_available}) {
      expect_dlsdus(judge, use_pt(bench, judge, least, 280), {}, "", "unexpected_dlpdu");
    }
  }
}

// In octet durations, a begun one counted.
unsigned in_whole_octets(const FfBench& bench, kernel::Duration duration) {
  const kernel::Duration one = bench.octets(1);
  return static_cast<unsigned>((duration + one - kLinkRounding) / one);
}

// Was the one DT1 that waits sent? A station may begin a little sooner or later than it did before: what
// counts is whether the DT1 ends within the duration, from where it began to send.
bool fit_is_judged(FfBench& bench, CaseJudge& judge, unsigned duration, std::size_t size) {
  const kernel::Time end = bench.send(bench.pt(Priority::normal, duration));
  const kernel::Time over = end + bench.octets(duration);
  const std::vector<DrivenDlpdu> sent = expect_token_used(bench, judge, end);
  const DrivenDlpdu& last = bench.driven().back();
  const auto sighting = [&] {
    return Mismatch{{fmt::format("a DT1 that ends until {}, and is sent then", kernel::describe(over))},
                    fmt::format("{} from {} to {}", last.text(), kernel::describe(last.begin),
                                kernel::describe(last.end)),
                    last.begin};
  };
  if (!sent.empty()) judge.expect(last.end <= over + kLinkRounding, "sends_what_does_not_fit", sighting);
  const bool has_room = last.begin + bench.frame(kDt1Header + size) <= over + kLinkRounding;
  judge.expect(!sent.empty() || !has_room, "exact_fit_not_sent", sighting);
  return !sent.empty();
}

void what_fits_exactly_is_sent_and_no_more(FfBench& bench, CaseJudge& judge) {
  const Octets first = expect_submitted(bench, judge, Priority::normal, 8);
  const kernel::Time end = bench.send(bench.pt(Priority::normal, 500));
  const std::vector<DrivenDlpdu> sent = expect_token_used(bench, judge, end);
  expect_dlsdus(judge, sent, {first}, "frames_missing", "sent_twice");
  const kernel::Duration latency = sent[0].begin - end;
  judge.measure("start latency", "octets", static_cast<double>(latency / bench.octets(1)));
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    const Octets data = expect_submitted(bench, judge, Priority::normal, 20 + bench.random().below(100));
    const unsigned fit = in_whole_octets(bench, latency + bench.frame(kDt1Header + data.size()));
    const bool has_room_for_rt = fit - 1 >= in_whole_octets(bench, latency + bench.frame(1));
    bool is_sent = false;
    if (has_room_for_rt) is_sent = fit_is_judged(bench, judge, fit - 1, data.size());
    if (!is_sent) is_sent = fit_is_judged(bench, judge, fit, data.size());
    if (!is_sent)
      expect_dlsdus(judge, use_pt(bench, judge, Priority::normal, 2 * fit), {data}, "frames_missing",
                    "sent_twice");
  }
}

void ff_nothing_is_sent_behind_the_duration(FfBench& bench, CaseJudge& judge) {
  // Short frames, too: of those some end just after a duration.
  for (int n = 0; n < bench.volume(60, 300); ++n) {
    const std::uint64_t longest = n % 6 == 0 ? 250 : 12;
    const auto duration = static_cast<unsigned>(32 + bench.random().below(4 * longest));
    for (int i = 0; i < 8; ++i) {
      bench.submit(Priority::time_available, bench.numbered_data(2 + bench.random().below(longest)));
    }
    const kernel::Time over =
        bench.send(bench.pt(Priority::time_available, duration)) + bench.octets(duration);
    for (const DrivenDlpdu& one : bench.listen()) {
      judge.expect(one.end <= over + kLinkRounding, "talks_behind_duration", [&] {
        return Mismatch{
            {fmt::format("silence after {}, {} octets after the PT", kernel::describe(over), duration)},
            fmt::format("{} until {}", one.text(), kernel::describe(one.end)),
            one.begin};
      });
    }
    for (int i = 0; i < 2; ++i) {
      bench.send(bench.pt(Priority::time_available, kAmple));
      judge.expect(!bench.listen().empty(), "token_not_returned",
                   fmt::format("under a token of {} octets data, or RT", kAmple), "silence");
    }
  }
}

void what_does_not_fit_is_sent_next_time(FfBench& bench, CaseJudge& judge) {
  std::vector<Octets> left;
  for (int n = 0; n < 12; ++n) left.push_back(expect_submitted(bench, judge, Priority::normal, 60));
  for (int tokens = 0; !left.empty(); ++tokens) {
    judge.expect(tokens < 12, "queued_data_lost", "each token takes at least one DT1", "some are left");
    const std::vector<DrivenDlpdu> sent = use_pt(bench, judge, Priority::normal, 250);
    judge.expect(!sent.empty() && sent.size() <= left.size(), "frames_missing", "at least one DT1", "none");
    const auto first = left.begin();
    const auto last = first + static_cast<std::ptrdiff_t>(sent.size());
    expect_dlsdus(judge, sent, {first, last}, "frames_missing", "sent_twice", "wrong_order");
    left.erase(first, last);
  }
}

void ff_tokens_of_others_are_left(FfBench& bench, CaseJudge& judge) {
  expect_submitted(bench, judge, Priority::urgent, 6);
  for (unsigned node = 0; node < 256; node += static_cast<unsigned>(bench.volume(7, 1))) {
    if (node == bench.node()) continue;
    Octets pt = bench.pt(Priority::time_available, 500);
    pt[1] = static_cast<std::uint8_t>(node);
    bench.send(pt);
    expect_silence(bench, judge, "uses_token_of_others", fmt::format("the PT is for node {:02X}", node));
  }
  expect_serves(bench, judge);
}

void ff_the_longest_is_sent_and_no_longer(FfBench& bench, CaseJudge& judge) {
  for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
    const std::size_t most = fieldbus_dll::most_data(bench.link(), priority);
    const Octets longest = bench.numbered_data(most);
    judge.expect(bench.submit(priority, longest), "longest_refused",
                 fmt::format("{} octets are accepted", most), "they were refused");
    judge.expect(!bench.submit(priority, bench.numbered_data(most + 1)), "too_long_taken",
                 fmt::format("{} octets are refused", most + 1), "they were accepted");
    expect_dlsdus(judge, use_pt(bench, judge, Priority::time_available, kAmple), {longest},
                  "longest_not_sent", "too_long_sent");
  }
}

}  // namespace

std::vector<FfCase> ff_token_cases() {
  using link_sources::ff_paper;
  using link_sources::memory;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/ff_device/token/only_what_is_urgent_enough_is_sent",
        .purpose = "FF-03",
        .requirement = "Under a PT a station sends data whose priority is at least that of the PT.",
        .reference = ff_paper("priority of the token"),
        .stimulus = "Data of all priorities; PT normal, urgent, time-available.",
        .expected = "Urgent and normal; nothing; the rest.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"priority_ignored", "lower_priority_sent"},
                    {"priority_inverted", "data_wrong"},
                    {"sends_to_another", "dlpdu_wrong"},
                    {"sends_as_another", "dlpdu_wrong"}}},
       only_what_is_urgent_enough_is_sent},
      {{.id = "fieldbus_dll/ff_device/token/all_is_sent_in_order",
        .purpose = "FF-04",
        .requirement = "Data of the higher priority is sent first, of one priority as submitted.",
        .reference = ff_paper("three priorities"),
        .stimulus = "Two DLSDUs of each priority, the least urgent first; PT time-available.",
        .expected = "Urgent, normal, time-available.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"fifo_across_priorities", "wrong_order"},
                    {"one_frame_a_token", "frames_missing"}}},
       all_is_sent_in_order},
      {{.id = "fieldbus_dll/ff_device/token/an_empty_queue_returns_the_token",
        .purpose = "FF-05",
        .requirement = "A token that is not used is returned within V(MRD) x V(ST).",
        .reference = ff_paper("RT: the token returns to the scheduler"),
        .stimulus = "PTs, nothing submitted.",
        .expected = "One RT each.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"no_return_when_empty", "token_not_returned"},
                    {"marked_token_unknown", "token_not_returned"},
                    {"answers_late", "answers_too_late"}}},
       ff_an_empty_queue_returns_the_token},
      {{.id = "fieldbus_dll/ff_device/token/what_fits_exactly_is_sent_and_no_more",
        .purpose = "FF-06",
        .requirement = "A DT1 is sent when it ends within the duration of the PT.",
        .reference = ff_paper("duration of the token"),
        .details = {{own("the duration begins with the end of the PT and holds whole frames; the last DT1 "
                         "returns the token"),
                     {"exact_fit_not_sent", "sends_what_does_not_fit"}}},
        .stimulus = "The start latency is measured; PT for exactly what a DT1 needs, and for an octet less.",
        .expected = "The DT1; a RT.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"duration_in_bits", "token_not_returned"},
                    {"fit_is_strict", "exact_fit_not_sent"},
                    {"duration_from_begin_of_pt", "exact_fit_not_sent"},
                    {"overhead_not_charged", "sends_what_does_not_fit"}}},
       what_fits_exactly_is_sent_and_no_more},
      {{.id = "fieldbus_dll/ff_device/token/nothing_is_sent_behind_the_duration",
        .purpose = "FF-07",
        .requirement = "A station sends nothing after the duration of its token.",
        .reference = ff_paper("duration of the token"),
        .stimulus = "More data than fits; 300 random durations.",
        .expected = "The last frame ends within the duration.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"overhead_not_charged", "talks_behind_duration"},
                    {"duration_ignored", "talks_behind_duration"},
                    {"duration_in_two_octets", "talks_behind_duration"}}},
       ff_nothing_is_sent_behind_the_duration},
      {{.id = "fieldbus_dll/ff_device/token/what_does_not_fit_is_sent_next_time",
        .purpose = "FF-08",
        .requirement = "Data that does not fit waits for the next token, in order.",
        .reference = memory("use of a token"),
        .stimulus = "Twelve DLSDUs; PTs for some three of them.",
        .expected = "All of them, in order, and each token returned.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"queue_lost_with_token", "frames_missing"}}},
       what_does_not_fit_is_sent_next_time},
      {{.id = "fieldbus_dll/ff_device/token/is_returned_once",
        .purpose = "FF-09",
        .requirement = "A token is returned by F in the last DT1 or by RT, not by both.",
        .reference = memory("final use, RT"),
        .stimulus = "PTs with and without data.",
        .expected = "Exactly one return each.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"returns_twice", "token_returned_twice"},
                    {"never_final", "token_not_returned"}}},
       all_is_sent_in_order},
      {{.id = "fieldbus_dll/ff_device/token/others_are_left",
        .purpose = "FF-10",
        .requirement = "A station uses no token of another.",
        .reference = ff_paper("the token is passed to a node"),
        .stimulus = "Data, and PTs to other nodes.",
        .expected = "Silence.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"answers_for_all_nodes", "uses_token_of_others"}}},
       ff_tokens_of_others_are_left},
      {{.id = "fieldbus_dll/ff_device/token/the_longest_is_sent_and_no_longer",
        .purpose = "FF-39",
        .requirement = "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
        .reference = memory("the longest DLSDU of each priority"),
        .stimulus = "DLSDUs of these lengths and of one octet more are submitted.",
        .expected = "The first are accepted and sent, the others refused.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"urgent_as_long_as_normal", "too_long_taken"}}},
       ff_the_longest_is_sent_and_no_longer},
  };
}

}  // namespace fieldproof::conformance
