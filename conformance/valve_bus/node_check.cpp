#include <fmt/format.h>

#include <utility>

#include "conformance/valve_bus/bit_pairs.hpp"
#include "conformance/valve_bus/blind_check.hpp"
#include "conformance/valve_bus/node_lateness.hpp"
#include "conformance/valve_bus/node_scene.hpp"

// The block check: what it must refuse, and what it cannot see. Faults are written into the octets of whole
// characters here; faults of single levels are in node_line.cpp.
namespace fieldproof::conformance {
namespace {

using Frame = std::vector<std::uint8_t>;

constexpr unsigned kCommandBits = 8 * valve_bus::kCommandOctets;

Frame one_wrong_bit(NodeScene& scene) {
  const auto& rules = scene.bench.rules();
  Frame frame = scene.command(scene.round < kCommandBits ? rules.write_command : rules.read_command);
  invert(frame, scene.round % kCommandBits);
  return frame;
}

void send_many_wrong_frames(NodeScene& scene) {
  constexpr unsigned kMany = 300;  // more than a counter of 8 bits has
  scene.bench.clear_observations();
  for (unsigned n = 0; n < kMany; ++n) {
    Frame frame = scene.moving_write();
    frame.back() ^= static_cast<std::uint8_t>(1 + n % 255);
    scene.send_next(std::move(frame));
  }
}

constexpr unsigned kFrameColumnPairs = 80;
constexpr unsigned kFrameOtherPairs = 700;

constexpr Rounds kPairRounds{kFrameColumnPairs + kFrameOtherPairs / 7, kFrameColumnPairs + kFrameOtherPairs};

// A wrong DATA octet must move a valve: both differ from what stands in every bit.
Frame with_wrong_pair(NodeScene& scene, unsigned number) {
  static const auto pairs = bit_pairs(valve_bus::kCommandOctets);
  Frame frame = scene.write(0xA5, 0x5A);
  invert(frame, pairs.at(number).first);
  invert(frame, pairs.at(number).second);
  return frame;
}

Frame two_wrong_bits(NodeScene& scene) {
  scene.bench.require(&iut::Capabilities::process_side);
  return with_wrong_pair(scene, scene.round);
}

bool is_own_command(const NodeScene& scene, const Frame& frame) {
  const auto& rules = scene.bench.rules();
  return frame[0] == scene.bench.address() &&
         (frame[1] == rules.write_command || frame[1] == rules.read_command);
}

// Behind the last round: that the node took each of them, its round has shown.
void warn_of_taken_pairs(NodeScene& scene) {
  if (scene.round + 1 != scene.bench.volume(kPairRounds.quick, kPairRounds.full)) return;
  unsigned taken = 0;
  for (unsigned pair = 0; pair < kFrameColumnPairs; ++pair)
    if (is_own_command(scene, with_wrong_pair(scene, pair))) ++taken;
  warn_of_blind_check(scene.judge, taken, kFrameColumnPairs,
                      "commands with two wrong bits in a column were taken");
}

// The exclusive or cannot see two wrong bits in one column. A node that refuses such a frame has another
// check; one that takes any other double error has none.
void expect_what_the_octets_say(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  const auto& rules = bench.rules();
  if (scene.round >= kFrameColumnPairs) {
    node_chart::ignored("acts_on_wrong_check", "the check does not fit").run(scene);
  } else if (!is_own_command(scene, scene.frame)) {
    node_chart::ignored("acts_on_foreign_frame", "another ID or another command").run(scene);
  } else if (scene.frame[1] == rules.write_command) {
    if (bench.boards().changes().empty()) {
      expect_not_late(bench, scene.judge, scene.valves());
      scene.judge.fail(
          "right_check_refused",
          {{"the exclusive or fits although two bits are wrong: the write is taken"}, "no valve moved"});
    }
    expect_valves(bench, scene.judge, scene.valves(), "valves_wrong");
  } else {
    scene.judge.expect(bench.has_driven(), "right_check_refused",
                       "the exclusive or fits although two bits are wrong: the read is answered",
                       "no answer");
    expect_answer(bench, scene.judge, scene.switches, scene.end);
  }
  warn_of_taken_pairs(scene);
}

// Of writes and of reads.
NodeStep other_check(std::string text, std::function<unsigned(NodeScene&)> check) {
  return node_chart::sent(
      fmt::format("a write or a read with {} for a check", text),
      [check = std::move(check)](NodeScene& scene) {
        const auto& rules = scene.bench.rules();
        scene.frame = scene.command(scene.round % 2 == 0 ? rules.write_command : rules.read_command);
        Frame frame = scene.frame;
        frame.back() = static_cast<std::uint8_t>(check(scene));
        if (frame.back() == scene.frame.back()) frame.back() ^= 0xFFU;
        return frame;
      });
}

unsigned sum_of(const NodeScene& scene) {
  return 0U + scene.frame[0] + scene.frame[1] + scene.frame[2] + scene.frame[3];
}

}  // namespace

std::vector<NodeCase> node_check_cases() {
  using namespace node_chart;
  const NodeStep no_check = ignored("acts_on_wrong_check", "the check is no exclusive or");
  return {
      on_chart(
          {.id = "valve_bus/node/check/wrong_frames_in_a_row_change_nothing",
           .purpose = "RN-09",
           .requirement = "However many frames with a wrong check come in a row, the node takes the next "
                          "right one.",
           .reference = valve_sources::paper("node on a wrong block check"),
           .tags = {"must"},
           .catches = {{"deaf_after_100_wrong_checks", "does_not_recover"}},
           // They take longer than its valves hold.
           .not_applicable = for_answer("loss_limit", kernel::Duration{})},
          {{1, 4},
           {valves_on(), stimulus("300 writes with a wrong check", send_many_wrong_frames),
            ignored("acts_on_wrong_check", "no check is right"), serves()}},
          {.loss_limit = kernel::Duration{}}),
      on_chart(
          {.id = "valve_bus/node/check/single_bit_errors_are_refused",
           .purpose = "RN-09",
           .requirement = "A frame whose block check does not fit is ignored.",
           .reference = valve_sources::paper("node on a wrong block check"),
           .tags = {"must"},
           .catches = {{"read_not_checked", "acts_on_wrong_check"},
                       {"write_not_checked", "acts_on_wrong_check"},
                       {"valves_off_on_wrong_check", "acts_on_wrong_check"}}},
          {{2 * kCommandBits, 2 * kCommandBits},
           {valves_on(), sent("a write, then a read, with each of its 40 bits wrong in turn", one_wrong_bit),
            ignored("acts_on_wrong_check", "one bit is wrong"), serves()}}),
      on_chart(
          {.id = "valve_bus/node/check/double_errors_show_the_exclusive_or",
           .purpose = "RN-10",
           .requirement = "The block check is the exclusive or of ID, COMMAND, DATA0 and DATA1: it fits "
                          "whenever each of its eight columns has an even number of wrong bits, and "
                          "only then.",
           .reference = valve_sources::calculated("80 double errors in one column, 700 others"),
           .tags = {"must"},
           .catches = {{"check_is_crc", "right_check_refused"}, {"check_is_parity", "acts_on_wrong_check"}}},
          {kPairRounds,
           {valves_on(),
            sent("a write with two wrong bits: all 80 pairs in one column, then the 700 others",
                 two_wrong_bits),
            expected("of the 80, 24 are executed with wrong data, 3 are answered as reads, 21 have "
                     "another command and 32 another ID and are ignored; all others are refused",
                     expect_what_the_octets_say)}}),
      on_chart(
          {.id = "valve_bus/node/check/other_checks_are_refused",
           .purpose = "RN-11",
           .requirement = "Nothing but the exclusive or is a right check.",
           .reference = valve_sources::paper("block check"),
           .tags = {"must"},
           .catches = {{"check_or_complement", "acts_on_wrong_check"},
                       {"read_not_checked", "acts_on_wrong_check"}}},
          {{16, 400},
           {valves_on(),
            other_check("the complement", [](NodeScene& scene) { return ~unsigned{scene.frame[4]}; }),
            no_check, other_check("the sum", sum_of), no_check,
            other_check("the negative of the sum", [](NodeScene& scene) { return -sum_of(scene); }), no_check,
            other_check("a random octet",
                        [](NodeScene& scene) { return unsigned{scene.bench.random_octet()}; }),
            no_check, other_check("FF", [](NodeScene&) { return 0xFFU; }), no_check,
            other_check("0", [](NodeScene&) { return 0U; }), no_check, serves()}}),
  };
}

}  // namespace fieldproof::conformance
