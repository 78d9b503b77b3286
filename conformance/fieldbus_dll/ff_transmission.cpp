#include <fmt/format.h>

#include "conformance/fieldbus_dll/ff_scene.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

// What is on the line beside a frame: in front of it, without one for long, and while the station sends or is
// asked by its user.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::FfAddress;
using fieldbus_dll::FfConfiguration;
using fieldbus_dll::Priority;

constexpr FfAddress kPublisherOnALink = 0x1000'2230;
constexpr std::size_t kLongestData = 256;
constexpr std::size_t kLongerThanItsFrame = 60;

void with_last_node(FfConfiguration& configuration) {
  configuration.node = 0xFF;
}
void without_long_addresses(FfConfiguration& configuration) {
  configuration.supports_long_addresses = false;
  configuration.subscribed = {kPublisherOnALink};
}

line::Levels probe_frame(const FfScene& scene) {
  return frame_of_link(scene.bench, Octets{scene.bench.rules().codes.pn, scene.bench.node()});
}

line::Levels in_front(FfScene& scene) {
  return in_front_of(probe_frame(scene), scene.turn / kMostInFront % kKindsInFront,
                     1 + scene.turn % kMostInFront);
}

// As long as a DT1 may be.
line::Levels long_dt1(FfScene& scene) {
  return frame_of_link(scene.bench, scene.bench.dt1(Priority::time_available,
                                                    fieldbus_dll::address_of(scene.bench.node(), 0x30),
                                                    FfBench::kPeersAddress, scene.fresh(kLongestData)));
}

// Two levels of each, which are no symbols.
line::Levels jabber(FfScene& scene) {
  constexpr std::int64_t kSeconds = 3;
  line::Levels levels;
  for (std::int64_t n = 0; n < kSeconds * scene.bench.link().bit_rate; ++n) levels.append_fill(n % 2 == 0, 2);
  return levels;
}

// Others begin when two octets of the station's first DT1 are on the line, and go on after it.
void send_into_its_frame(FfScene& scene) {
  FfBench& bench = scene.bench;
  bench.next_begins(bench.now() + bench.observation_timeout());
  bench.wait(bench.octets(2));
  bench.user().data.clear();
  scene.sent = bench.send(bench.dt1(Priority::normal, fieldbus_dll::address_of(bench.node(), 0x30),
                                    FfBench::kPeersAddress, scene.fresh(kLongerThanItsFrame)));
}

void expect_second_after_them(FfScene& scene) {
  FfBench& bench = scene.bench;
  expect_next(bench, scene.judge, "frames_missing", "the DT1 that the station was sending");
  const DrivenDlpdu second = expect_next(bench, scene.judge, "frames_missing", "its second DT1");
  const kernel::Time least = scene.sent + bench.least_gap();
  scene.judge.expect(second.begin + kLinkRounding >= least, "gap_too_short", [&] {
    return Mismatch{
        {fmt::format("V(MID) of silence after others, from {} on", kernel::describe(least - kernel::kStart))},
        kernel::describe(second.begin - kernel::kStart),
        second.begin};
  });
}

void ask_meanwhile(FfScene& scene) {
  FfBench& bench = scene.bench;
  const kernel::Time end = bench.send_at(
      bench.now(), bench.dt1(Priority::normal, 0x3530, FfBench::kPeersAddress, bench.numbered_data(40)));
  bench.wait(bench.octets(10));
  scene.submitted.push_back(bench.numbered_data(10));
  scene.written.push_back(bench.numbered_data(8));
  scene.judge.expect(bench.submit(Priority::normal, scene.submitted.back()), "data_refused",
                     "data is accepted", "it was refused");
  scene.judge.expect(bench.write(FfBench::kPublished, scene.written.back()), "write_refused",
                     "the buffer is written", "it was refused");
  bench.run_until(end);
}

}  // namespace

std::vector<FfCase> ff_transmission_cases() {
  using namespace ff_chart;
  using enum Priority;
  using link_sources::memory;
  using link_sources::own;
  return {
      on_chart(
          must_case("fieldbus_dll/ff_device/frame/what_is_in_front_is_left", "FF-37",
                    "A start delimiter begins a frame wherever it stands in a transmission.",
                    own("each frame of a transmission"),
                    {{"pairs_from_the_beginning", "no_probe_response"},
                     {"deaf_behind_no_symbol", "no_probe_response"},
                     {"deaf_behind_a_cut_frame", "no_probe_response"}}),
          {{},
           {repeat(
               {kKindsInFront * kMostInFront, kKindsInFront * kMostInFront},
               {drive("1 to 16 half bits of one level, alternating, two and two, and a frame cut off by 3 to "
                      "18 half bits of one level, in turn, in front of a PN with its preamble",
                      in_front),
                probe_response("no_probe_response")})}}),
      on_chart(
          must_in_time("fieldbus_dll/ff_device/frame/other_clocks_are_taken", "FF-37",
                       "A receiver takes frames whose clock is 0.2 % off.",
                       memory("tolerance of the bit rate"), {{"does_not_recover_clock", "clock_not_taken"}}),
          {{2, 20},
           {stimulus<FfScene>(
                "a DT1 with 256 octets to the station at 100.2 and 99.8 % of the bit rate, in turn",
                [](FfScene& scene) {
                  scene.bench.send_wave(
                      clocked(scene.bench, long_dt1(scene), scene.round % 2 == 0 ? 1'002 : 998));
                }),
            wait(32), delivered("clock_not_taken")}}),
      on_chart(
          must_in_time("fieldbus_dll/ff_device/frame/jitter_is_taken", "FF-37",
                       "A receiver takes frames whose edges are up to a tenth of a bit off.",
                       memory("jitter at a receiver"), {{"wants_exact_edges", "jitter_not_taken"}}),
          {{2, 50},
           {stimulus<FfScene>(
                "a DT1 with 256 octets to the station, each edge moved by up to a tenth of a bit, at random",
                [](FfScene& scene) { scene.bench.send_wave(jittered(scene.bench, long_dt1(scene))); }),
            wait(32), delivered("jitter_not_taken")}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/a_jabber_changes_nothing", "FF-37",
                         "What is no frame is left, however long it is.", own("each frame of a transmission"),
                         {{"restarts_on_a_long_jabber", "does_not_recover"}}),
               {{},
                {submit({normal}, 8), drive("two half bits of each level, in turn, for 3 s at once", jabber),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/token/others_within_its_frame_are_not_received", "FF-35",
                    "What begins while a station sends is not received; silence begins when it is over.",
                    own("reception while sending"),
                    {{"receives_while_sending", "received_while_sending"},
                     {"others_taken_for_its_echo", "gap_too_short"}}),
          {{2, 20},
           {submit({normal, normal}, 20), pt(normal, 1'000),
            stimulus<FfScene>("a DT1 to the station begins within its first DT1 and ends after it",
                              send_into_its_frame),
            expected<FfScene>("the second DT1 comes V(MID) after the end of that", expect_second_after_them),
            nothing_delivered("received_while_sending")}}),
      on_chart(must_case("fieldbus_dll/ff_device/requests/while_others_send_they_are_taken", "FF-48",
                         "What the user asks does not depend on what is on the line.",
                         own("what is submitted is sent or refused"),
                         {{"refuses_on_a_busy_line", "data_refused"}}),
               {{2, 20},
                {stimulus<FfScene>("within a DT1 of another to another the user submits normal data and "
                                   "writes a buffer",
                                   ask_meanwhile),
                 cd(), as_written(), pt(normal, 500), used({0}, {"frames_missing", "sent_twice"})}}),
      on_chart(must_case("fieldbus_dll/ff_device/settings/the_last_node_is_one", "FF-38",
                         "Each octet is the address of a node.", own("addresses"),
                         {{"node_ff_is_nobody", "no_probe_response"}}),
               {{}, {pn(), probe_response("no_probe_response")}},
               {.change = with_last_node, .is_live = false}),
      on_chart(must_case("fieldbus_dll/ff_device/publisher/a_long_address_needs_no_support", "FF-45",
                         "A station without long addresses delivers a DT3 that has one.",
                         own("long addresses"), {{"long_dt3_unsupported", "subscription_not_delivered"}}),
               {{},
                {send("a DT3 of a publisher of another link",
                      [](FfScene& scene) { return scene.bench.dt3(kPublisherOnALink, scene.fresh(8)); }),
                 wait(20), published_delivered(), serves()}},
               {.change = without_long_addresses}),
  };
}

}  // namespace fieldproof::conformance
