#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_cases.hpp"
#include "conformance/fieldbus_dll/ff_expect.hpp"
#include "harness/line/frame_check.hpp"

// Frames: checks, addresses, lengths, unknown DLPDUs, silence.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

constexpr FfAddress kLink = 0x2130'0000;  // its upper half reads as an address of the station

void wrong_checks_are_seen(FfBench& bench, CaseJudge& judge) {
  bench.submit(Priority::urgent, bench.numbered_data(4));
  const Octets right = with_frame_check(bench.pt(Priority::time_available, 500));
  const std::size_t bits = 8 * right.size();
  const auto send_wrong = [&](const std::vector<std::size_t>& flips, std::string_view what) {
    Octets wrong = right;
    for (const std::size_t bit : flips)
      wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (0x80U >> bit % 8));
    bench.send_half_bits(half_bits_of_frame(wrong));
    expect_silence(bench, judge, "acts_on_wrong_check", what);
  };
  for (std::size_t bit = 0; bit < bits; ++bit) send_wrong({bit}, fmt::format("bit {} is wrong", bit));
  for (std::size_t n = 0; n < bench.volume(std::size_t{40}, bits); ++n) {
    const std::size_t first = bench.random().below(bits);
    for (std::size_t second = first + 1; second < std::min(bits, first + bench.volume(std::size_t{6}, bits));
         ++second)
      send_wrong({first, second}, fmt::format("bits {} and {} are wrong", first, second));
  }
  for (int n = 0; n < bench.volume(40, 2'000); ++n) {
    const std::size_t first = bench.random().below(bits - 15);
    std::vector<std::size_t> burst{first, first + 15};
    for (std::size_t bit = 1; bit < 15; ++bit) {
      if (bench.random().below(2) == 1) burst.push_back(first + bit);
    }
    send_wrong(burst, fmt::format("16 bits from {} are disturbed", first));
  }
  line::FrameCheckParameters no_complement = line::frame_check_named("CRC-16/PROFIBUS");
  no_complement.xorout = 0;
  Octets other = bench.pt(Priority::time_available, 500);
  const auto check = static_cast<unsigned>(line::FrameCheck(no_complement).compute(other));
  other.push_back(static_cast<std::uint8_t>(check >> 8));
  other.push_back(static_cast<std::uint8_t>(check & 0xFF));
  bench.send_half_bits(half_bits_of_frame(other));
  expect_silence(bench, judge, "acts_on_other_check", "its check is not complemented");
  expect_serves(bench, judge);
}

// Everything that a device acts on, with each bit wrong once.
void wrong_checks_are_seen_whatever_comes(FfBench& bench, CaseJudge& judge) {
  bench.write(FfBench::kPublished, bench.numbered_data(4));
  const Octets told = bench.dt1(Priority::normal, fieldbus_dll::address_of(bench.node(), 0x30),
                                FfBench::kPeersAddress, bench.numbered_data(6));
  for (const Octets& dlpdu : {Octets{bench.rules().codes.pn, bench.node()}, bench.cd(FfBench::kPublished),
                              bench.dt3(FfBench::kSubscribed, bench.numbered_data(6)), told}) {
    const Octets right = with_frame_check(dlpdu);
    for (std::size_t bit = 0; bit < 8 * right.size(); bit += bench.volume(std::size_t{3}, std::size_t{1})) {
      Octets wrong = right;
      wrong[bit / 8] = static_cast<std::uint8_t>(wrong[bit / 8] ^ (0x80U >> bit % 8));
      bench.send_half_bits(half_bits_of_frame(wrong));
      expect_silence(bench, judge, "acts_on_wrong_check", fmt::format("bit {} is wrong", bit));
      judge.expect(bench.user().data.empty() && bench.user().published.empty(), "acts_on_wrong_check",
                   "nothing is delivered: the check does not fit", "something was");
    }
  }
  bench.send(told);
  bench.wait(bench.octets(20));
  judge.expect(bench.user().data.size() == 1, "does_not_recover", "a right DT1 is delivered", "it was not");
  expect_serves(bench, judge);
}

// After the preamble, of which any part will do, each half bit is turned once.
void a_frame_without_its_code_is_none(FfBench& bench, CaseJudge& judge) {
  constexpr std::size_t kPreamble = 16;
  bench.submit(Priority::urgent, bench.numbered_data(4));
  const Octets told = bench.dt1(Priority::normal, fieldbus_dll::address_of(bench.node(), 0x30),
                                FfBench::kPeersAddress, bench.numbered_data(6));
  for (const Octets& dlpdu : {bench.pt(Priority::time_available, 500), told}) {
    const line::Levels right = half_bits_of_frame(with_frame_check(dlpdu));
    for (std::size_t n = kPreamble; n < right.size(); n += bench.volume(std::size_t{3}, std::size_t{1})) {
      line::Levels wrong = right;
      wrong.flip(n);
      bench.send_half_bits(std::move(wrong));
      expect_silence(bench, judge, "acts_on_violation", fmt::format("half bit {} is turned", n));
      judge.expect(bench.user().data.empty(), "acts_on_violation", "nothing is reported: there is no frame",
                   "something was");
    }
  }
  expect_serves(bench, judge);
}

void addresses_are_read_as_long_as_they_are(FfBench& bench, CaseJudge& judge) {
  const FfAddress mine = 0x2130;
  const Octets short_data = bench.numbered_data(12);
  bench.send(bench.dt1(Priority::normal, mine, FfBench::kPeersAddress, short_data));
  bench.wait(bench.octets(20));
  judge.expect(bench.user().was_delivered(short_data), "short_address_not_heard",
               "a DT1 to the station is delivered", "it was not");
  bench.user().data.clear();
  // To another node of a link whose number reads as the station's short address.
  bench.send(
      bench.dt1(Priority::normal, kLink | 0x5566, kLink | FfBench::kPeersAddress, bench.numbered_data(12)));
  bench.wait(bench.octets(20));
  judge.expect(bench.user().data.empty(), "long_address_misread", "a DT1 to another is not delivered",
               "it was");
  const Octets long_data = bench.numbered_data(12);
  bench.send(bench.dt1(Priority::normal, kLink | mine, kLink | FfBench::kPeersAddress, long_data));
  bench.wait(bench.octets(20));
  const auto& data = bench.user().data;
  judge.expect(data.empty() || data.front().data == long_data, "long_address_misread",
               "with long addresses, the DLSDU or nothing is delivered", "something else was");
  expect_serves(bench, judge);
}

// What is told is held to what was sent, whatever the case: see judge_end.
void what_comes_is_told_as_it_is(FfBench& bench, CaseJudge& judge) {
  constexpr FfAddress kOther = 0x3540;
  const FfAddress mine = fieldbus_dll::address_of(bench.node(), 0x30);
  const FfAddress entity_of_scheduler = fieldbus_dll::address_of(FfBench::kScheduler);
  for (int n = 0; n < bench.volume(2, 20); ++n) {
    for (const Priority priority : {Priority::time_available, Priority::normal, Priority::urgent}) {
      bench.send(bench.dt1(priority, mine, FfBench::kPeersAddress, bench.numbered_data(6)));
      bench.wait(bench.octets(20));
      bench.send(bench.dt1(priority, fieldbus_dll::kEverybody, kOther, bench.numbered_data(6)));
      bench.wait(bench.octets(20));
    }
    bench.send(bench.dt1(Priority::normal, fieldbus_dll::kEverybody, entity_of_scheduler,
                         fieldbus_dll::live_list_spdu(static_cast<std::uint8_t>(n), {})));
    bench.wait(bench.octets(20));
    Octets dt3 = bench.dt3(FfBench::kSubscribed, bench.numbered_data(6));
    dt3[3] = static_cast<std::uint8_t>(n + 7);
    bench.send(dt3);
    bench.wait(bench.octets(20));
  }
  const auto rounds = static_cast<std::size_t>(bench.volume(2, 20));
  judge.expect(bench.user().data.size() >= 6 * rounds, "not_told", [&] {
    return Mismatch{{fmt::format("{} DT1 are reported", 6 * rounds)},
                    fmt::format("{}", bench.user().data.size())};
  });
  judge.expect(bench.user().published.size() >= rounds, "not_told", [&] {
    return Mismatch{{fmt::format("{} DT3 are reported", rounds)},
                    fmt::format("{}", bench.user().published.size())};
  });
  expect_serves(bench, judge);
}

void frames_are_as_long_as_the_paper_says(FfBench& bench, CaseJudge& judge) {
  constexpr FfAddress kFar = 0x1000'2230;
  constexpr std::size_t kUrgent = 64;
  constexpr std::size_t kAvailable = 256;
  for (const auto& [priority, size] :
       {std::pair{Priority::urgent, kUrgent}, {Priority::time_available, kAvailable}}) {
    const Octets data = bench.numbered_data(size);
    judge.expect(bench.submit(priority, data, kFar), "data_refused", "data is accepted", "it was refused");
    const kernel::Time end = bench.send(bench.pt(priority, 1'000));
    const std::vector<DrivenDlpdu> sent = expect_token_used(bench, judge, end);
    judge.expect(sent.size() == 1, "frames_missing", "one DT1", fmt::format("{}", sent.size()));
    const kernel::Duration length = sent[0].end - sent[0].begin;
    // 11 octets around the DLSDU, and preamble and delimiters around those.
    const kernel::Duration wanted = bench.octets(static_cast<std::int64_t>(size) + 11 + 3);
    judge.expect(
        length + kLinkRounding >= wanted && length <= wanted + kLinkRounding, "frame_length_wrong",
        [&] { return Mismatch{{kernel::describe(wanted)}, kernel::describe(length), sent[0].begin}; });
    judge.measure(fmt::format("a DT1 of {} octets of data", size), "us",
                  static_cast<double>(length / kernel::kMicrosecond));
  }
}

// Those that mean something to a device and are answered.
bool is_for_device(const FfBench& bench, unsigned control) {
  const auto& codes = bench.rules().codes;
  const bool has_priority = (control & fieldbus_dll::kPriorityBits) != 0;
  return (control & ~0x0FU) == codes.cd || control == codes.pn ||
         (has_priority && (control & ~0x07U) == codes.pt);
}

void unknown_dlpdus_are_left(FfBench& bench, CaseJudge& judge) {
  bench.submit(Priority::urgent, bench.numbered_data(4));
  for (unsigned control = 0; control < 256; ++control) {
    if (is_for_device(bench, control)) continue;
    const auto octet = static_cast<std::uint8_t>(control);
    for (const Octets& octets :
         {Octets{octet}, Octets{octet, bench.node()}, Octets{octet, bench.node(), 0x01, 0xF4},
          Octets{octet, bench.node(), 0x20, 0x22, 0x20, 0x55}}) {
      bench.send(octets);
      expect_silence(bench, judge, "acts_on_unknown", fmt::format("{:02X} asks for nothing", control));
    }
  }
  const auto& codes = bench.rules().codes;
  const Octets pt = bench.pt(Priority::urgent, 500);
  const Octets cd = bench.cd(FfBench::kPublished);
  for (const Octets& whole : {Octets{codes.pn, bench.node()}, pt, cd}) {
    Octets longer = whole;
    longer.push_back(0);
    for (const Octets& octets : {longer, Octets(whole.begin(), whole.end() - 1)}) {
      bench.send(octets);
      expect_silence(bench, judge, "acts_on_unknown",
                     "a known first octet with another length asks for nothing");
    }
  }
  expect_serves(bench, judge);
}

void silence_is_kept(FfBench& bench, CaseJudge& judge) {
  for (int n = 0; n < bench.volume(3, 30); ++n) {
    bench.write(FfBench::kPublished, bench.numbered_data(8));
    for (int i = 0; i < 3; ++i) bench.submit(Priority::normal, bench.numbered_data(10));
    // judge_driven holds each gap.
    bench.send(bench.pt(Priority::normal, 800));
    judge.expect(bench.listen().size() >= 3, "frames_missing", "three DT1", "fewer");
    bench.send(bench.cd(FfBench::kPublished));
    judge.expect(!bench.listen().empty(), "not_published", "a DT3", "silence");
    bench.send({bench.rules().codes.pn, bench.node()});
    judge.expect(!bench.listen().empty(), "no_probe_response", "a PR", "silence");
  }
}

}  // namespace

std::vector<FfCase> ff_frame_cases() {
  using link_sources::ff_paper;
  using link_sources::line;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      {{.id = "fieldbus_dll/ff_device/frame/wrong_checks_are_seen",
        .purpose = "FF-37",
        .requirement = "A DLPDU whose frame check does not fit is ignored.",
        .reference = line("frame check 1DCF"),
        .stimulus = "PTs with one and two wrong bits, with bursts of 16 bits, with a check of another kind.",
        .expected = "Silence; a right PT is served then.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"takes_other_residue", "acts_on_other_check"},
                    {"check_of_high_octet", "acts_on_wrong_check"}}},
       wrong_checks_are_seen},
      {{.id = "fieldbus_dll/ff_device/frame/wrong_checks_are_seen_whatever_comes",
        .purpose = "FF-37",
        .requirement = "A DLPDU whose frame check does not fit is ignored.",
        .reference = line("frame check 1DCF"),
        .stimulus = "PN, CD, a DT3 of the publisher and a DT1 to the station, each with each bit wrong once.",
        .expected = "Silence, and nothing is delivered; a right DT1 is.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"check_of_tokens_only", "acts_on_wrong_check"}}},
       wrong_checks_are_seen_whatever_comes},
      {{.id = "fieldbus_dll/ff_device/frame/without_its_code_is_none",
        .purpose = "FF-37",
        .requirement = "A frame with a symbol that is none, or without a delimiter, is ignored.",
        .reference = line("Manchester code, N+ and N-, delimiters"),
        .stimulus = "A PT and a DT1 to the station with each half bit turned once, but for the preamble.",
        .expected = "Silence, and nothing is reported; a right PT is served then.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"takes_violated_frames", "acts_on_violation"},
                    {"stuck_behind_violation", "does_not_recover"}}},
       a_frame_without_its_code_is_none},
      {{.id = "fieldbus_dll/ff_device/frame/addresses_are_read_as_long_as_they_are",
        .purpose = "FF-38",
        .requirement = "Long and short addresses are distinguished by L.",
        .reference = memory("bit L"),
        .stimulus = "DT1 with short addresses to the station, with long ones to another and to the station.",
        .expected = "The first is delivered, the second not, the third whole or not at all.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"long_read_as_short", "long_address_misread"}}},
       addresses_are_read_as_long_as_they_are},
      {{.id = "fieldbus_dll/ff_device/frame/what_comes_is_told_as_it_is",
        .purpose = "FF-38",
        .requirement = "What was sent to a user is reported to it: data, source, destination, priority.",
        .reference = memory("DT1 and DT3 at the interface to the user"),
        .details = {{own("the number of writes in a DT3; what entities send each other"),
                     {"told_otherwise"}}},
        .stimulus =
            "DT1 of two stations in each priority, to the station and to everybody; a live list; DT3.",
        .expected = "Each DT1 and DT3 is reported once, as it was sent; the live list is not.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"tells_other_source", "told_otherwise"},
                    {"tells_normal_priority", "told_otherwise"},
                    {"tells_no_writes", "told_otherwise"},
                    {"tells_twice", "told_otherwise"},
                    {"tells_live_lists", "told_otherwise"},
                    {"deaf_to_broadcasts", "not_told"}}},
       what_comes_is_told_as_it_is},
      {{.id = "fieldbus_dll/ff_device/frame/are_as_long_as_the_paper_says",
        .purpose = "FF-40",
        .requirement = "Frames of 75 and 267 octets take 600 and 2136 us at 1 Mbit/s, and 24 us around them.",
        .reference = ff_paper("lengths of the data"),
        .stimulus = "Data of 64 and 256 octets with long addresses, at 1 Mbit/s.",
        .expected = "Frames of 624 and 2160 us.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "token_not_returned"},
                    {"two_octets_of_preamble", "frame_length_wrong"}}},
       frames_are_as_long_as_the_paper_says,
       {.change =
            [](fieldbus_dll::FfConfiguration& configuration) {
              configuration.rules.link.bit_rate = 1'000'000;
            }}},
      {{.id = "fieldbus_dll/ff_device/frame/unknown_dlpdus_are_left",
        .purpose = "FF-42",
        .requirement = "What is not known is ignored, and the link goes on.",
        .reference = memory("octets of the DLPDUs"),
        .stimulus =
            "All first octets that ask for nothing, with four kinds of rest and right checks; PN, PT and CD "
            "an octet too long and too short.",
        .expected = "Silence; a right PT is served then.",
        .tags = {"must"},
        .catches = {{"mute_after_activation", "does_not_recover"},
                    {"priority_zero_taken", "acts_on_unknown"},
                    {"es_is_pt", "acts_on_unknown"},
                    {"tail_ignored", "acts_on_unknown"}}},
       unknown_dlpdus_are_left},
      {{.id = "fieldbus_dll/ff_device/frame/silence_is_kept",
        .purpose = "FF-35",
        .requirement = "A station keeps V(MID) of silence after its own DLPDUs and those of others.",
        .reference = vendors("V(MID): silence after every DLPDU"),
        .stimulus = "Tokens, CDs and probes.",
        .expected = "No DLPDU of the station sooner than V(MID) after another.",
        .tags = {"must", "timing"},
        .catches = {{"mute_after_activation", "frames_missing"},
                    {"short_silence", "gap_too_short"},
                    {"no_silence_behind_own", "gap_too_short"}}},
       silence_is_kept},
  };
}

}  // namespace fieldproof::conformance
