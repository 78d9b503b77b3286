#include <array>

#include "conformance/fieldbus_dll/isa_scene.hpp"
#include "conformance/fieldbus_dll/link_transmission.hpp"

// What is no token for the IUT.
namespace fieldproof::conformance {
namespace {

using fieldbus_dll::Priority;

// The half bits of an ET with symbols that are no data in place of a bit of its second octet.
line::Levels with_violation(const line::Levels& frame, std::size_t bit, bool high) {
  constexpr std::size_t kBeforeOctets = 32;  // preamble and start delimiter
  line::Levels levels = frame;
  const std::size_t first = kBeforeOctets + 16 + 2 * bit;
  levels.set(first, high);
  levels.set(first + 1, high);
  return levels;
}

Octets for_other(const IsaScene& scene, Octets token) {
  token[1] = static_cast<std::uint8_t>(1 + (scene.bench.address() + scene.turn) % 247);
  return token;
}

line::Levels right_et(IsaScene& scene) {
  return half_bits_of_frame(with_frame_check(scene.bench.et(Priority::time_available)));
}

line::Levels isa_with_other_check(IsaScene& scene) {
  const Octets octets = scene.turn < kOtherChecks ? scene.bench.et(Priority::time_available)
                                                  : scene.bench.es(Priority::time_available, 1'000);
  return half_bits_with_other_check(octets, scene.turn % kOtherChecks);
}

// The last bit of the last octet is left out, the end delimiter follows.
line::Levels with_short_octet(IsaScene& scene) {
  const line::Levels right = right_et(scene);
  line::Levels levels = right.slice(0, right.size() - 18);
  levels.append(right, right.size() - 16, 16);
  return levels;
}

// The n-th.
std::uint8_t unknown_control(const IsaBench& bench, unsigned n) {
  constexpr unsigned kPriorities = 4;
  unsigned control = 0;
  for (;; ++control) {
    const unsigned code = control & 0xF0U;
    const bool is_right = (control & 0x0CU) == 0 && control % kPriorities != 0 &&
                          (code == bench.rules().codes.et || code == bench.rules().codes.cd);
    if (!is_right && n-- == 0) return static_cast<std::uint8_t>(control);
  }
}

Octets of_other_length(IsaScene& scene) {
  const bool is_et = scene.turn < 5;
  Octets octets =
      is_et ? scene.bench.et(Priority::time_available) : scene.bench.es(Priority::time_available, 1'000);
  const std::size_t size = 1 + (is_et ? scene.turn : scene.turn - 5);
  octets.resize(size < octets.size() ? size : size + 1);
  return octets;
}

}  // namespace

std::vector<IsaCase> isa_rejection_cases() {
  using namespace isa_chart;
  const LinkStep something = submit({Priority::urgent}, 4);
  using link_sources::isa_paper;
  using link_sources::line;
  using link_sources::own;
  return {
      on_chart(must_case("fieldbus_dll/isa_dle/rejection/tokens_of_others_are_left", "ISA-14",
                         "A station acts on tokens that are delegated to it, and on no others.",
                         isa_paper("the token is delegated to a station"),
                         {{"takes_any_token", "acts_on_others"}}),
               {{},
                {something,
                 repeat({20, 246}, {send("an ET for another station, each in its turn",
                                         [](IsaScene& scene) {
                                           return for_other(scene, scene.bench.et(Priority::time_available));
                                         }),
                                    silence("acts_on_others", "the ET is for another station"),
                                    send("an ES for it",
                                         [](IsaScene& scene) {
                                           return for_other(scene,
                                                            scene.bench.es(Priority::time_available, 1'000));
                                         }),
                                    silence("acts_on_others", "the ES is for another station")}),
                 serves()}}),
      on_chart(must_case("fieldbus_dll/isa_dle/rejection/single_bit_errors_are_seen", "ISA-15",
                         "A DLPDU whose frame check does not fit is ignored.", line("frame check 1DCF"),
                         {{"short_frames_not_checked", "acts_on_wrong_check"}}),
               {{},
                {something,
                 repeat({40, 40}, {drive("an ET with one wrong bit, each of its 40 in its turn",
                                         [](IsaScene& scene) {
                                           return half_bits_of_frame(with_wrong_bits(
                                               with_frame_check(scene.bench.et(Priority::time_available)),
                                               {scene.turn}));
                                         }),
                                   silence("acts_on_wrong_check", "its check does not fit")}),
                 serves()}}),
      on_chart(must_case("fieldbus_dll/isa_dle/rejection/other_checks_are_refused", "ISA-16",
                         "The frame check is that of the line: 1DCF, preset to ones, complemented, the high "
                         "octet first.",
                         line("frame check 1DCF"), {{"check_from_zero_too", "acts_on_other_check"}}),
               {{},
                {something,
                 repeat({14, 14},
                        {drive("an ET, then an ES, with a check without complement, beginning with 0, both, "
                               "reflected, CCITT, CCITT with complement, with its octets exchanged, in turn",
                               isa_with_other_check),
                         silence("acts_on_other_check", "its check is of another kind")}),
                 serves()}}),
      on_chart(
          must_case(
              "fieldbus_dll/isa_dle/rejection/broken_frames_are_left", "ISA-17",
              "A frame with symbols that are no data between its delimiters, without an end or with a "
              "part of an octet is ignored.",
              line("delimiters"),
              {{"violations_are_bits", "acts_on_violation"}, {"stuck_behind_violation", "does_not_recover"}}),
          {{},
           {something,
            repeat({16, 16},
                   {drive("an ET with N+, N- in place of a bit of its second octet, each in its turn",
                          [](IsaScene& scene) {
                            return with_violation(right_et(scene), scene.turn / 2, scene.turn % 2 == 0);
                          }),
                    silence("acts_on_violation", "it has a symbol that is no data")}),
            drive("an ET without its end delimiter",
                  [](IsaScene& scene) {
                    const line::Levels right = right_et(scene);
                    return right.slice(0, right.size() - 16);
                  }),
            silence("acts_without_end", "the frame has no end delimiter"),
            drive("an ET with seven bits in its last octet", with_short_octet),
            silence("acts_on_part_of_octet", "the last octet has seven bits"), serves()}}),
      on_chart(must_case(
                   "fieldbus_dll/isa_dle/rejection/unknown_control_octets_are_left", "ISA-18",
                   "A DLPDU with a reserved bit or an unknown control octet is ignored.",
                   own("control octets of the profile"),
                   {{"reserved_bit_ignored", "acts_on_unknown"}, {"priority_zero_taken", "acts_on_unknown"}}),
               {{},
                {something,
                 repeat({250, 250}, {send("a control octet that makes no ET and no CD, with addresses and a "
                                          "right check, each of the 250 in its turn",
                                          [](IsaScene& scene) {
                                            return Octets{unknown_control(scene.bench, scene.turn),
                                                          scene.bench.address(), IsaBench::kScheduler};
                                          }),
                                     silence("acts_on_unknown", "it is no token")}),
                 serves()}}),
      on_chart(
          must_case("fieldbus_dll/isa_dle/rejection/other_lengths_are_left", "ISA-18",
                    "An ET has five octets, an ES seven, with their checks.", own("encoding of the profile"),
                    {{"length_not_checked", "acts_on_other_length"}}),
          {{},
           {something,
            repeat({12, 12},
                   {send("an ET of 1 to 6 octets but 3, an ES of 1 to 8 but 5, with right checks, in turn",
                         of_other_length),
                    silence("acts_on_other_length", "it has another length")}),
            serves()}}),
  };
}

}  // namespace fieldproof::conformance
