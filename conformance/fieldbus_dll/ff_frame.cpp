#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/ff_scene.hpp"
#include "harness/line/frame_check.hpp"

// Frames: checks, addresses, lengths, unknown DLPDUs, silence.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

constexpr FfAddress kLink = 0x2130'0000;  // its upper half reads as an address of the station

// Those that mean something to a device and are answered.
bool is_for_device(const FfBench& bench, unsigned control) {
  const auto& codes = bench.rules().codes;
  const bool has_priority = (control & fieldbus_dll::kPriorityBits) != 0;
  return (control & ~0x0FU) == codes.cd || control == codes.pn ||
         (has_priority && (control & ~0x07U) == codes.pt);
}

FfAddress user_of(const FfScene& scene) {
  return fieldbus_dll::address_of(scene.bench.node(), 0x30);
}

line::Levels wrong_pt(FfScene& scene, const std::vector<std::size_t>& bits) {
  return half_bits_of_frame(
      with_wrong_bits(with_frame_check(scene.bench.pt(Priority::time_available, 500)), bits));
}

// Of the 48 bits of a PT and its check, the n-th two.
std::vector<std::size_t> two_bits(unsigned n) {
  std::size_t first = 0;
  for (std::size_t left = n;; left -= 47 - first++)
    if (left < 47 - first) return {first, first + 1 + left};
}

// The first and the last of 16, and any in between.
std::vector<std::size_t> burst(FfBench& bench) {
  const std::size_t first = bench.random().below(48 - 15);
  std::vector<std::size_t> bits{first, first + 15};
  for (std::size_t bit = 1; bit < 15; ++bit)
    if (bench.random().below(2) == 1) bits.push_back(first + bit);
  return bits;
}

line::Levels with_other_check(FfScene& scene) {
  line::FrameCheckParameters no_complement = line::frame_check_named("CRC-16/PROFIBUS");
  no_complement.xorout = 0;
  Octets other = scene.bench.pt(Priority::time_available, 500);
  const auto check = static_cast<unsigned>(line::FrameCheck(no_complement).compute(other));
  other.push_back(static_cast<std::uint8_t>(check >> 8));
  other.push_back(static_cast<std::uint8_t>(check & 0xFF));
  return half_bits_of_frame(other);
}

Octets dt1_to_user(FfScene& scene) {
  return scene.bench.dt1(Priority::normal, user_of(scene), FfBench::kPeersAddress,
                         scene.bench.numbered_data(6));
}

// What a device acts on, by the round; which bit, by the turn.
line::Levels with_wrong_bit(FfScene& scene) {
  FfBench& bench = scene.bench;
  const std::array all{Octets{bench.rules().codes.pn, bench.node()}, bench.cd(FfBench::kPublished),
                       bench.dt3(FfBench::kSubscribed, bench.numbered_data(6)), dt1_to_user(scene)};
  const Octets right = with_frame_check(all[scene.round]);
  return half_bits_of_frame(with_wrong_bits(right, {scene.turn * bench.volume(3U, 1U) % (8 * right.size())}));
}

// After the preamble, of which any part will do.
line::Levels with_turned_half_bit(FfScene& scene) {
  constexpr std::size_t kPreamble = 16;
  const Octets dlpdu = scene.round == 0 ? scene.bench.pt(Priority::time_available, 500) : dt1_to_user(scene);
  line::Levels levels = half_bits_of_frame(with_frame_check(dlpdu));
  levels.flip(kPreamble + scene.turn * scene.bench.volume(3U, 1U) % (levels.size() - kPreamble));
  return levels;
}

void submit_for_long_address(FfScene& scene) {
  const bool is_first = scene.round == 0;
  scene.submitted = {scene.bench.numbered_data(is_first ? 64 : 256)};
  const bool is_taken = scene.bench.submit(is_first ? Priority::urgent : Priority::time_available,
                                           scene.submitted[0], 0x1000'2230);
  scene.judge.expect(is_taken, "data_refused", "data is accepted", "it was refused");
}

// 11 octets around the DLSDU, and preamble and delimiters around those.
void expect_length(FfScene& scene) {
  const std::size_t size = scene.submitted[0].size();
  const kernel::Duration length = scene.answer.end - scene.answer.begin;
  const kernel::Duration right = scene.bench.octets(static_cast<std::int64_t>(size) + 11 + 3);
  scene.judge.expect(
      length + kLinkRounding >= right && length <= right + kLinkRounding, "frame_length_wrong",
      [&] { return Mismatch{{kernel::describe(right)}, kernel::describe(length), scene.answer.begin}; });
  scene.judge.measure(fmt::format("a DT1 of {} octets of data", size), "us",
                      static_cast<double>(length / kernel::kMicrosecond));
}

void expect_left(FfScene& scene, const Octets& octets, std::string_view why) {
  scene.bench.send(octets);
  expect_silence(scene.bench, scene.judge, "acts_on_unknown", why);
}

void expect_unknown_left(FfScene& scene) {
  const std::uint8_t node = scene.bench.node();
  for (unsigned control = 0; control < 256; ++control) {
    if (is_for_device(scene.bench, control)) continue;
    const auto octet = static_cast<std::uint8_t>(control);
    for (const Octets& octets : {Octets{octet}, Octets{octet, node}, Octets{octet, node, 0x01, 0xF4},
                                 Octets{octet, node, 0x20, 0x22, 0x20, 0x55}})
      expect_left(scene, octets, fmt::format("{:02X} asks for nothing", control));
  }
}

void expect_other_lengths_left(FfScene& scene) {
  FfBench& bench = scene.bench;
  for (const Octets& whole : {Octets{bench.rules().codes.pn, bench.node()}, bench.pt(Priority::urgent, 500),
                              bench.cd(FfBench::kPublished)}) {
    Octets longer = whole;
    longer.push_back(0);
    for (const Octets& octets : {longer, Octets(whole.begin(), whole.end() - 1)})
      expect_left(scene, octets, "a known first octet with another length asks for nothing");
  }
}

}  // namespace

std::vector<FfCase> ff_frame_cases() {
  using namespace ff_chart;
  using enum Priority;
  const LinkStep wrong_check = silence("acts_on_wrong_check", "its check does not fit");
  const auto dt1 = [](Priority priority) {
    return send(fmt::format("a DT1 to the station, {}", fieldbus_dll::text_of(priority)),
                [priority](FfScene& scene) {
                  return scene.bench.dt1(priority, user_of(scene), FfBench::kPeersAddress, scene.fresh(6));
                });
  };
  const auto to_everybody = [](Priority priority) {
    return send(fmt::format("a DT1 of another to everybody, {}", fieldbus_dll::text_of(priority)),
                [priority](FfScene& scene) {
                  return scene.bench.dt1(priority, fieldbus_dll::kEverybody, 0x3540, scene.fresh(6));
                });
  };
  using link_sources::ff_paper;
  using link_sources::line;
  using link_sources::memory;
  using link_sources::own;
  using link_sources::vendors;
  return {
      on_chart(
          must_case("fieldbus_dll/ff_device/frame/wrong_checks_are_seen", "FF-37",
                    "A DLPDU whose frame check does not fit is ignored.", line("frame check 1DCF"),
                    {{"mute_after_activation", "does_not_recover"},
                     {"takes_other_residue", "acts_on_other_check"},
                     {"check_of_high_octet", "acts_on_wrong_check"}}),
          {{},
           {submit({urgent}, 4),
            repeat({48, 48}, {drive("a PT with one wrong bit, each in its turn",
                                    [](FfScene& scene) { return wrong_pt(scene, {scene.turn}); }),
                              wrong_check}),
            repeat({226, 1'128}, {drive("a PT with two wrong bits, each two in their turn",
                                        [](FfScene& scene) {
                                          return wrong_pt(scene,
                                                          two_bits(scene.turn * scene.bench.volume(5U, 1U)));
                                        }),
                                  wrong_check}),
            repeat({40, 2'000}, {drive("a PT with a burst over 16 bits",
                                       [](FfScene& scene) { return wrong_pt(scene, burst(scene.bench)); }),
                                 wrong_check}),
            drive("a PT whose check is not complemented", with_other_check),
            silence("acts_on_other_check", "its check is not complemented"), serves()}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/wrong_checks_are_seen_whatever_comes", "FF-37",
                         "A DLPDU whose frame check does not fit is ignored.", line("frame check 1DCF"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"check_of_tokens_only", "acts_on_wrong_check"}}),
               {{4, 4},
                {write(4),
                 repeat({35, 104}, {drive("a PN, a CD, a DT3 of the publisher, a DT1 to the station, in "
                                          "turn, with one wrong bit, each in its turn",
                                          with_wrong_bit),
                                    wrong_check, nothing_delivered("acts_on_wrong_check")}),
                 dt1(normal), wait(20), delivered("does_not_recover"), serves()}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/without_its_code_is_none", "FF-37",
                         "A frame with a symbol that is none, or without a delimiter, is ignored.",
                         line("Manchester code, N+ and N-, delimiters"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"takes_violated_frames", "acts_on_violation"},
                          {"stuck_behind_violation", "does_not_recover"}}),
               {{2, 2},
                {submit({urgent}, 4),
                 repeat({80, 240}, {drive("a PT, a DT1 to the station, in turn, with one half bit turned, "
                                          "each after the preamble in its turn",
                                          with_turned_half_bit),
                                    silence("acts_on_violation", "there is no frame"),
                                    nothing_delivered("acts_on_violation")}),
                 serves()}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/addresses_are_read_as_long_as_they_are", "FF-38",
                         "Long and short addresses are distinguished by L.", memory("bit L"),
                         {{"mute_after_activation", "does_not_recover"},
                          {"long_read_as_short", "long_address_misread"}}),
               {{},
                {dt1(normal), wait(20), delivered("short_address_not_heard"),
                 send("a DT1 with long addresses to another, on a link whose number reads as the station's "
                      "short address",
                      [](FfScene& scene) {
                        return scene.bench.dt1(normal, kLink | 0x5566, kLink | FfBench::kPeersAddress,
                                               scene.fresh(12));
                      }),
                 wait(20), nothing_delivered("long_address_misread"),
                 send("one to the station, with long addresses",
                      [](FfScene& scene) {
                        return scene.bench.dt1(normal, kLink | user_of(scene), kLink | FfBench::kPeersAddress,
                                               scene.fresh(12));
                      }),
                 wait(20),
                 require(
                     "it is delivered whole or not at all",
                     [](FfScene& scene) {
                       const auto& all = scene.bench.user().data;
                       return all.empty() || all.front().data == scene.data;
                     },
                     "long_address_misread"),
                 serves()}}),
      on_chart(
          must_case(
              "fieldbus_dll/ff_device/frame/what_comes_is_told_as_it_is", "FF-38",
              "What was sent to a user is reported to it: data, source, destination, priority.",
              memory("DT1 and DT3 at the interface to the user"),
              {{"mute_after_activation", "does_not_recover"},
               {"tells_other_source", "told_otherwise"},
               {"tells_normal_priority", "told_otherwise"},
               {"tells_no_writes", "told_otherwise"},
               {"tells_twice", "told_otherwise"},
               {"tells_live_lists", "told_otherwise"},
               {"deaf_to_broadcasts", "not_told"}},
              {{own("the number of writes in a DT3; what entities send each other"), {"told_otherwise"}}}),
          {{2, 20},
           {dt1(time_available), wait(20), to_everybody(time_available), wait(20), dt1(normal), wait(20),
            to_everybody(normal), wait(20), dt1(urgent), wait(20), to_everybody(urgent), wait(20),
            send("a live list",
                 [](FfScene& scene) {
                   return scene.bench.dt1(
                       normal, fieldbus_dll::kEverybody, fieldbus_dll::address_of(FfBench::kScheduler),
                       fieldbus_dll::live_list_spdu(static_cast<std::uint8_t>(scene.round), {}));
                 }),
            wait(20),
            send("a DT3 of the publisher",
                 [](FfScene& scene) {
                   Octets dt3 = scene.bench.dt3(FfBench::kSubscribed, scene.bench.numbered_data(6));
                   dt3[3] = static_cast<std::uint8_t>(scene.round + 7);
                   return dt3;
                 }),
            wait(20),
            require(
                "each DT1 and DT3 is reported once, as it was sent; the live list is not",
                [](FfScene& scene) {
                  auto& user = scene.bench.user();
                  return user.data.size() >= 6 * (scene.round + 1) && user.published.size() > scene.round;
                },
                "not_told"),
            serves()}}),
      on_chart(
          must_in_time("fieldbus_dll/ff_device/frame/are_as_long_as_the_paper_says", "FF-40",
                       "Frames of 75 and 267 octets take 600 and 2136 us at 1 Mbit/s, and 24 us around them.",
                       ff_paper("lengths of the data"),
                       {{"mute_after_activation", "token_not_returned"},
                        {"two_octets_of_preamble", "frame_length_wrong"}}),
          {{2, 2},
           {stimulus<FfScene>("the user submits 64 octets of urgent data for a long address, 256 of "
                              "time-available data, in turn",
                              submit_for_long_address),
            pt(time_available, 1'000), used({1}, {"frames_missing", "sent_twice"}),
            expected<FfScene>("it takes 624 us, 2160 us", expect_length)}},
          {.change =
               [](fieldbus_dll::FfConfiguration& configuration) {
                 configuration.rules.link.bit_rate = 1'000'000;
               }}),
      on_chart(
          must_case("fieldbus_dll/ff_device/frame/unknown_dlpdus_are_left", "FF-42",
                    "What is not known is ignored, and the link goes on.", memory("octets of the DLPDUs"),
                    {{"mute_after_activation", "does_not_recover"},
                     {"priority_zero_taken", "acts_on_unknown"},
                     {"es_is_pt", "acts_on_unknown"},
                     {"tail_ignored", "acts_on_unknown"}}),
          {{},
           {submit({urgent}, 4),
            FfStep{"all first octets that ask for nothing, with four kinds of rest and right checks",
                   "silence", expect_unknown_left},
            FfStep{"PN, PT and CD an octet too long and too short", "silence", expect_other_lengths_left},
            serves()}}),
      on_chart(must_in_time("fieldbus_dll/ff_device/frame/silence_is_kept", "FF-35",
                            "A station keeps V(MID) of silence after its own DLPDUs and those of others.",
                            vendors("V(MID): silence after every DLPDU"),
                            {{"mute_after_activation", "frames_missing"},
                             {"short_silence", "gap_too_short"},
                             {"no_silence_behind_own", "gap_too_short"}}),
               {{3, 30},
                {write(8), submit({normal, normal, normal}, 10), pt(normal, 800),
                 says("three DT1", "frames_missing", 3), cd(), says("a DT3", "not_published"), pn(),
                 says("a PR, and no DLPDU sooner than V(MID) after another", "no_probe_response")}}),
  };
}

}  // namespace fieldproof::conformance
