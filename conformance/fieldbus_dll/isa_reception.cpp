#include <fmt/format.h>

#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

// What may stand in one transmission, how fine its levels may be, which errors are seen, and how long it may
// be silent before.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

Octets any_et(const IsaScene& scene) {
  return scene.bench.et(Priority::time_available);
}

Octets du_of_six(IsaScene& scene) {
  Octets octets{scene.bench.control(scene.bench.rules().codes.du, Priority::normal), scene.bench.address(),
                IsaBench::kPeer};
  for (const std::uint8_t octet : scene.fresh(6)) octets.push_back(octet);
  return octets;
}

// What a station acts on, by the round.
Octets acted_on(IsaScene& scene) {
  switch (scene.round) {
    case 0:
      return any_et(scene);
    case 1:
      return scene.bench.es(Priority::time_available, 1'000);
    case 2:
      return scene.bench.cd(Priority::normal);
    default:
      return du_of_six(scene);
  }
}

constexpr std::size_t kHalfBitsOfPreamble = 16;

line::Levels with_wrong_bit_of_turn(IsaScene& scene) {
  const Octets right = with_frame_check(acted_on(scene));
  return half_bits_of_frame(
      with_wrong_bits(right, {scene.turn * scene.bench.volume(3U, 1U) % (8 * right.size())}));
}

line::Levels with_half_bit_of_turn(IsaScene& scene) {
  line::Levels levels = half_bits_of_frame(with_frame_check(acted_on(scene)));
  levels.flip(kHalfBitsOfPreamble +
              scene.turn * scene.bench.volume(5U, 1U) % (levels.size() - kHalfBitsOfPreamble));
  return levels;
}

void expect_two_delivered(IsaScene& scene) {
  IsaBench& bench = scene.bench;
  line::Levels levels;
  std::array<Octets, 2> data;
  for (Octets& one : data) {
    levels.append(frame_of_link(bench, du_of_six(scene)));
    one = scene.data;
  }
  bench.user().deliveries.clear();
  bench.send_half_bits(levels);
  bench.wait(bench.octets(20));
  for (const Octets& one : data)
    scene.judge.expect(bench.user().was_delivered(one), "frame_of_transmission_lost",
                       "both DUs of the transmission are delivered",
                       fmt::format("{} of 2", bench.user().deliveries.size()));
}

IsaStep returns_token() {
  return isa_chart::answer<IsaScene>("an EE", "token_not_returned",
                                     [](const IsaScene& scene, const DrivenDlpdu& one) {
                                       return is_type(one, scene.bench.rules().codes.ee);
                                     });
}

IsaStep nothing_heard(const std::string& reason) {
  return isa_chart::require(
      "nothing is delivered", [](IsaScene& scene) { return scene.bench.user().deliveries.empty(); }, reason);
}

}  // namespace

std::vector<IsaCase> isa_reception_cases() {
  using namespace isa_chart;
  using enum Priority;
  using link_sources::line;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/isa_dle/line/a_start_delimiter_begins_anew", "ISA-17",
                         "A start delimiter begins a frame, also within an octet of another.",
                         line("start delimiter"), {{"bits_counted_on", "token_not_returned"}}),
               {{},
                {repeat({7, 21}, {drive("an ET that a start delimiter and a whole ET cut off after an octet "
                                        "and 1 to 7 bits, in turn",
                                        [](IsaScene& scene) {
                                          return begun_within_an_octet(scene.bench, any_et(scene),
                                                                       1 + scene.turn % 7);
                                        }),
                                  returns_token()})}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/line/a_tail_is_no_silence", "ISA-17",
                            "Silence begins where the transmission ends, whatever is behind the frame.",
                            own("a transmission ends when nobody drives the line any more"),
                            {{"silence_from_the_delimiter", "answers_too_early"}}),
               {{},
                {repeat({4, 40}, {drive("an ET with 1 to 19 octets behind its end delimiter",
                                        [](IsaScene& scene) {
                                          return with_tail(scene.bench, any_et(scene),
                                                           1 + 9 * scene.turn % 20);
                                        }),
                                  returns_token()})}}),
      on_chart(
          must_case("fieldbus_dll/isa_dle/line/two_in_one_transmission_are_received", "ISA-17",
                    "Of a transmission each frame is received.", own("each frame of a transmission"),
                    {{"last_of_a_transmission", "frame_of_transmission_lost"}}),
          {{2, 20},
           {IsaStep{"two DUs to the station in one transmission", "both are delivered", expect_two_delivered},
            serves()}}),
      on_chart(must_in_time("fieldbus_dll/isa_dle/line/levels_may_be_finer", "ISA-40",
                            "A pulse between the middles of half bits changes none of them.",
                            line("symbols of half bits"), {{"levels_are_half_bits", "token_not_returned"}}),
               {{},
                {repeat({6, 60}, {stimulus<IsaScene>("an ET at 4000000 levels/s with a pulse of 250 ns "
                                                     "between an edge and the middle of a half bit",
                                                     [](IsaScene& scene) {
                                                       scene.sent = scene.bench.send_wave(
                                                           with_pulse(scene.bench, any_et(scene)));
                                                     }),
                                  returns_token()})}}),
      on_chart(must_case("fieldbus_dll/isa_dle/line/after_72_minutes_it_is_what_it_was", "ISA-41",
                         "A station that hears nothing for long is what it was.",
                         own("silence is no event for a station without a token"),
                         {{"deaf_behind_71_minutes", "no_reply"}}),
               {{},
                {submit({normal}, 8), long_silence(), cd(urgent), says("an empty DT", "no_reply"),
                 es(normal, 500), used({1}, {"no_data_frame", "sent_twice"}), serves()}}),
      on_chart(must_case("fieldbus_dll/isa_dle/rejection/wrong_checks_are_seen_whatever_comes", "ISA-15",
                         "A DLPDU whose frame check does not fit is ignored.", line("frame check 1DCF"),
                         {{"short_frames_not_checked", "acts_on_wrong_check"}}),
               {{4, 4},
                {repeat({28, 88}, {drive("an ET, an ES, a CD, a DU to the station, round by round, with one "
                                         "wrong bit, each in its turn",
                                         with_wrong_bit_of_turn),
                                   silence("acts_on_wrong_check", "its check does not fit"),
                                   nothing_heard("acts_on_wrong_check")}),
                 serves()}}),
      on_chart(must_case("fieldbus_dll/isa_dle/rejection/without_its_code_is_none", "ISA-17",
                         "A frame with a symbol that is none, or without a delimiter, is ignored.",
                         line("Manchester code, N+ and N-, delimiters"),
                         {{"violations_are_bits", "acts_on_violation"},
                          {"stuck_behind_violation", "does_not_recover"}}),
               {{4, 4},
                {repeat({40, 208}, {drive("an ET, an ES, a CD, a DU to the station, round by round, with one "
                                          "half bit turned, each after the preamble in its turn",
                                          with_half_bit_of_turn),
                                    silence("acts_on_violation", "there is no frame"),
                                    nothing_heard("acts_on_violation")}),
                 serves()}}),
  };
}

}  // namespace fieldproof::conformance
