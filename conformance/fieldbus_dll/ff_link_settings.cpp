#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"

// A link whose numbers are not the usual ones, and numbers and lengths at the end of their range.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfCodes;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kFarPublisher = 0x1000'2230;

void with_long_preamble(FfConfiguration& configuration) {
  configuration.rules.link.preamble_octets = 4;
}
void with_other_codes(FfConfiguration& configuration) {
  FfCodes& codes = configuration.rules.codes;
  codes.cd = 0xC0;
  codes.dt1 = 0xE0;
  codes.dt3 = 0x60;
  codes.sr = 0x1B;
  codes.pn = 0x2E;
  codes.pr = 0x2F;
  codes.pt = 0x40;
  codes.rt = 0x44;
}
void with_far_publisher(FfConfiguration& configuration) {
  configuration.subscribed = {kFarPublisher};
}

// The answer to a PN or a CD: the first that it drives.
DrivenDlpdu expect_answered(FfBench& bench, CaseJudge& judge, const Octets& asked, std::string_view reason,
                            std::string_view what) {
  bench.send(asked);
  const std::vector<DrivenDlpdu> all = bench.listen();
  judge.expect(!all.empty(), reason, what, "silence");
  return all.front();
}

// All that a device of this link does, once.
void expect_all_served(FfBench& bench, CaseJudge& judge) {
  const auto& codes = bench.rules().codes;
  const DrivenDlpdu pr =
      expect_answered(bench, judge, {codes.pn, bench.node()}, "no_probe_response", "a PR of this link");
  judge.expect(pr.octets == Octets{codes.pr, bench.node()}, "dlpdu_wrong",
               [&] { return Mismatch{{"PR with the station's node"}, pr.text(), pr.begin}; });
  bench.send(bench.activation(bench.node()));
  bench.wait(bench.octets(20));
  const DrivenDlpdu sr =
      expect_answered(bench, judge, bench.cd(FfBench::kPublished), "not_published", "a SR");
  judge.expect((sr.octet(0) & ~fieldbus_dll::kFinalBit) == codes.sr, "dlpdu_wrong",
               [&] { return Mismatch{{"SR: nothing was written"}, sr.text(), sr.begin}; });
  const Octets buffer = bench.numbered_data(8);
  judge.expect(bench.write(FfBench::kPublished, buffer), "write_refused", "the buffer is written",
               "it was not");
  const DrivenDlpdu dt3 =
      expect_answered(bench, judge, bench.cd(FfBench::kPublished), "not_published", "a DT3");
  judge.expect(is_dt3(bench, dt3) && buffer_in(dt3).data == buffer, "dlpdu_wrong",
               [&] { return Mismatch{{"DT3 with the buffer"}, dt3.text(), dt3.begin}; });
  const Octets data = expect_submitted(bench, judge, Priority::normal, 10);
  const kernel::Time end = bench.send(bench.pt(Priority::normal, 500));
  expect_dlsdus(judge, expect_token_used(bench, judge, end), {data}, "frames_missing", "sent_twice");
  const kernel::Time again = bench.send(bench.pt(Priority::normal, 500));
  expect_dlsdus(judge, expect_token_used(bench, judge, again), {}, "", "sent_twice");
}

void a_link_with_a_long_preamble_is_served(FfBench& bench, CaseJudge& judge) {
  expect_all_served(bench, judge);
  for (const DrivenDlpdu& one : bench.driven()) {
    const kernel::Duration length = one.end - one.begin;
    const kernel::Duration wanted = bench.frame(one.octets.size());
    judge.expect(length + kLinkRounding >= wanted && length <= wanted + kLinkRounding, "frame_length_wrong",
                 [&] {
                   return Mismatch{{fmt::format("{}: {} octets of preamble", kernel::describe(wanted),
                                                bench.link().preamble_octets)},
                                   fmt::format("{} of {}", one.text(), kernel::describe(length)),
                                   one.begin};
                 });
  }
}

// Each is more than the greatest number of a bit less, and all that waits fits into it alone.
void a_long_duration_is_used(FfBench& bench, CaseJudge& judge) {
  for (const unsigned duration : {4'096U, 4'100U, 8'192U, 16'384U, 32'768U, 32'780U, 65'535U}) {
    std::vector<Octets> all;
    for (int n = 0; n < 3; ++n) all.push_back(expect_submitted(bench, judge, Priority::time_available, 200));
    const kernel::Time end = bench.send(bench.pt(Priority::time_available, duration));
    expect_dlsdus(judge, expect_token_used(bench, judge, end), all, "frames_missing", "sent_twice");
  }
}

void the_longest_is_delivered(FfBench& bench, CaseJudge& judge) {
  const FfAddress mine = fieldbus_dll::address_of(bench.node(), 0x30);
  for (const Priority priority : {Priority::urgent, Priority::normal, Priority::time_available}) {
    const Octets longest = bench.numbered_data(fieldbus_dll::most_data(bench.link(), priority));
    bench.send(bench.dt1(priority, mine, FfBench::kPeersAddress, longest));
    bench.wait(bench.octets(20));
    judge.expect(bench.user().was_delivered(longest), "longest_not_delivered",
                 fmt::format("a DT1 of {} octets of data is delivered", longest.size()), "it was not");
  }
  expect_serves(bench, judge);
}

void a_publisher_of_another_link_is_another(FfBench& bench, CaseJudge& judge) {
  constexpr FfAddress kNodeAndSelector = 0xFFFF;
  constexpr FfAddress kOtherLink = 0x2000'0000;
  for (const FfAddress other :
       {kOtherLink | (kFarPublisher & kNodeAndSelector), kFarPublisher & kNodeAndSelector}) {
    bench.send(bench.dt3(other, bench.numbered_data(8)));
    bench.wait(bench.octets(20));
    judge.expect(bench.user().published.empty(), "other_buffer_delivered",
                 fmt::format("nothing: {:X} is not {:X}", other, kFarPublisher), "a buffer");
  }
  const Octets data = bench.numbered_data(8);
  bench.send(bench.dt3(kFarPublisher, data));
  bench.wait(bench.octets(20));
  const auto& published = bench.user().published;
  judge.expect(published.size() == 1 && published[0].data == data, "subscription_not_delivered",
               "the subscribed buffer is delivered", fmt::format("{} buffers", published.size()));
  expect_serves(bench, judge);
}

}  // namespace

std::vector<FfCase> ff_link_settings_cases() {
  using link_sources::ff_paper;
  using link_sources::line;
  using link_sources::memory;
  using link_sources::own;
  return {
      {{.id = "fieldbus_dll/ff_device/settings/a_long_preamble_is_sent",
        .purpose = "FF-43",
        .requirement = "A station sends as many octets of preamble as its link has.",
        .reference = line("preamble and delimiters"),
        .stimulus = "PN, CD and PT on a link with four octets of preamble.",
        .expected = "Each DLPDU has four octets of preamble.",
        .tags = {"must"},
        .catches = {{"preamble_of_the_usual_link", "frame_length_wrong"},
                    {"mute_after_activation", "not_published"}}},
       a_link_with_a_long_preamble_is_served,
       {.change = with_long_preamble, .is_live = false}},
      {{.id = "fieldbus_dll/ff_device/settings/other_codes_are_used",
        .purpose = "FF-43",
        .requirement = "The first octets of DLPDUs are those of the link.",
        .reference = own("codes are settings, because their standard was not at hand"),
        .stimulus = "PN, activation, CD and PT on a link with other codes.",
        .expected = "PR, SR, DT3, DT1 and RT with these codes.",
        .tags = {"must"},
        .catches = {{"codes_of_the_usual_link", "no_probe_response"},
                    {"mute_after_activation", "not_published"}}},
       expect_all_served,
       {.change = with_other_codes, .is_live = false}},
      {{.id = "fieldbus_dll/ff_device/token/a_long_duration_is_used",
        .purpose = "FF-44",
        .requirement = "The duration of a PT has 16 bits, of which none is a sign.",
        .reference = ff_paper("duration of the token"),
        .details = {{memory("the size of the duration"), {"frames_missing", "token_not_returned"}}},
        .stimulus = "Three DLSDUs of 200 octets; PTs of 4096 to 65535 octets.",
        .expected = "All three.",
        .tags = {"must"},
        .catches = {{"duration_of_12_bits", "token_not_returned"},
                    {"duration_with_sign", "token_not_returned"},
                    {"mute_after_activation", "token_not_returned"}}},
       a_long_duration_is_used},
      {{.id = "fieldbus_dll/ff_device/frame/the_longest_is_delivered",
        .purpose = "FF-39",
        .requirement = "A DLSDU has at most 64, 128, 256 octets when it is urgent, normal, time-available.",
        .reference = memory("the longest DLSDU of each priority"),
        .stimulus = "DT1 to the station with DLSDUs of these lengths.",
        .expected = "Each is delivered.",
        .tags = {"must"},
        .catches = {{"deaf_to_long_frames", "longest_not_delivered"},
                    {"mute_after_activation", "does_not_recover"}}},
       the_longest_is_delivered},
      {{.id = "fieldbus_dll/ff_device/publisher/one_of_another_link_is_another",
        .purpose = "FF-45",
        .requirement = "A publisher is known by its whole address, the link with it.",
        .reference = own("subscription by address"),
        .stimulus = "A subscription to an address of another link; DT3 with the same node and selector of a "
                    "third link, without a link, and of this one.",
        .expected = "The last is delivered, the others are not.",
        .tags = {"must"},
        .catches = {{"subscribed_without_link", "other_buffer_delivered"},
                    {"mute_after_activation", "does_not_recover"}}},
       a_publisher_of_another_link_is_another,
       {.change = with_far_publisher}},
  };
}

}  // namespace fieldproof::conformance
