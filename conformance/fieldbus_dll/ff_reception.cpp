#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/ff_scene.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

// What may stand in one transmission, how fine its levels may be, who is everybody, and how long it may be
// silent before.
namespace fieldproof::conformance {
namespace {

constexpr std::size_t kManyFrames = 7;

using fieldbus_dll::FfAddress;
using fieldbus_dll::Priority;

Octets probe(const FfScene& scene) {
  return {scene.bench.rules().codes.pn, scene.bench.node()};
}

void expect_all_delivered(FfScene& scene) {
  FfBench& bench = scene.bench;
  line::Levels levels;
  std::vector<Octets> data(scene.round % 2 == 0 ? 2 : kManyFrames);
  for (Octets& one : data) {
    one = bench.numbered_data(6);
    const FfAddress user = fieldbus_dll::address_of(bench.node(), 0x30);
    levels.append(frame_of_link(bench, bench.dt1(Priority::normal, user, FfBench::kPeersAddress, one)));
  }
  bench.user().data.clear();
  bench.send_half_bits(levels);
  bench.wait(bench.octets(20));
  for (const Octets& one : data)
    scene.judge.expect(bench.user().was_delivered(one), "frame_of_transmission_lost",
                       "all DT1s of the transmission are delivered",
                       fmt::format("{} of {}", bench.user().data.size(), data.size()));
}

// Groups that there are not, in turn.
Octets to_nobody(FfScene& scene) {
  constexpr std::array<FfAddress, 6> kNobody{0x0001'FFFF, 0x30FF, 0x22FF, 0xFF30, 0x0001'30FF, 0x7FFF'FFFF};
  const FfAddress to = kNobody.at(scene.turn);
  const FfAddress link = to & 0xFFFF'0000U;
  return scene.bench.dt1(Priority::normal, to, link | FfBench::kPeersAddress, scene.fresh(6));
}

void send_finely(FfScene& scene) {
  FfBench& bench = scene.bench;
  scene.sent =
      bench.send_wave(with_pulse(bench, scene.turn % 2 == 0 ? probe(scene) : bench.cd(FfBench::kPublished)));
}

void expect_fine_answered(FfScene& scene) {
  const bool is_probe = scene.turn % 2 == 0;
  const std::string what = is_probe ? "a PR" : "a DT3";
  const DrivenDlpdu one = scene.expect_answer(what, "not_received");
  scene.judge.expect(is_probe ? is_of(one, scene.bench.rules().codes.pr) : is_dt3(scene.bench, one),
                     "dlpdu_wrong", [&] { return Mismatch{{what}, scene.bench.words(one), one.begin}; });
}

}  // namespace

std::vector<FfCase> ff_reception_cases() {
  using namespace ff_chart;
  using enum Priority;
  using link_sources::line;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/ff_device/frame/a_start_delimiter_begins_anew", "FF-37",
                         "A start delimiter begins a frame, also within an octet of another.",
                         line("start delimiter"), {{"bits_counted_on", "no_probe_response"}}),
               {{},
                {repeat({7, 21}, {drive("a PN that a start delimiter and a whole PN cut off after an octet "
                                        "and 1 to 7 bits, in turn",
                                        [](FfScene& scene) {
                                          return begun_within_an_octet(scene.bench, probe(scene),
                                                                       1 + scene.turn % 7);
                                        }),
                                  probe_response("no_probe_response")})}}),
      on_chart(must_in_time("fieldbus_dll/ff_device/frame/a_tail_is_no_silence", "FF-35",
                            "Silence begins where the transmission ends, whatever is behind the frame.",
                            own("a transmission ends when nobody drives the line any more"),
                            {{"silence_from_the_delimiter", "answers_too_early"}}),
               {{},
                {repeat({4, 40}, {drive("a PN with 1 to 19 octets behind its end delimiter",
                                        [](FfScene& scene) {
                                          return with_tail(scene.bench, probe(scene),
                                                           1 + 9 * scene.turn % 20);
                                        }),
                                  probe_response("no_probe_response")})}}),
      on_chart(must_case("fieldbus_dll/ff_device/frame/two_in_one_transmission_are_received", "FF-37",
                         "Of a transmission each frame is received.", own("each frame of a transmission"),
                         {{"last_of_a_transmission", "frame_of_transmission_lost"},
                          {"two_of_a_transmission", "frame_of_transmission_lost"}}),
               {{2, 20},
                {FfStep{"two DT1s to the station in one transmission, and seven, in turn",
                        "all are delivered", expect_all_delivered},
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/ff_device/frame/nobody_is_everybody", "FF-38",
                    "FFFF without a link is everybody, and no other address is.",
                    own("the address of everybody"),
                    {{"everybody_on_a_link", "delivers_others"}, {"everybody_of_a_node", "delivers_others"}}),
          {{},
           {repeat({6, 6},
                   {send("a DT1 to 0001FFFF, 30FF, 22FF, FF30, 000130FF, 7FFFFFFF, in turn", to_nobody),
                    wait(20), nothing_delivered("delivers_others")}),
            serves()}}),
      on_chart(must_in_time("fieldbus_dll/ff_device/frame/levels_may_be_finer", "FF-37",
                            "A pulse between the middles of half bits changes none of them.",
                            line("symbols of half bits"), {{"levels_are_half_bits", "not_received"}}),
               {{},
                {write(8),
                 repeat({8, 80},
                        {FfStep{"a PN and a CD, in turn, at 4000000 levels/s with a pulse of 250 ns between "
                                "an edge and the middle of a half bit",
                                "a PR, a DT3",
                                [](FfScene& scene) {
                                  send_finely(scene);
                                  expect_fine_answered(scene);
                                }}})}}),
      on_chart(must_case("fieldbus_dll/ff_device/probe/after_72_minutes_it_is_what_it_was", "FF-48",
                         "A station that hears nothing for long is what it was.",
                         own("silence is no event for a device"),
                         {{"deaf_behind_71_minutes", "no_probe_response"}}),
               {{},
                {long_silence(), pn(), probe_response("no_probe_response"), pt(normal, 500),
                 used({}, {"", "sent_twice"}), serves()}}),
  };
}

}  // namespace fieldproof::conformance
