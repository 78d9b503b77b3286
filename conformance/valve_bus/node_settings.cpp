#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "conformance/valve_bus/node_lateness.hpp"
#include "conformance/valve_bus/node_scene.hpp"

// The same commands to nodes that are set otherwise: each setting at its ends.
namespace fieldproof::conformance {
namespace {

using valve_bus::CharacterProfile;

// A write of all valves with so much silence in it, in front of another octet in each round.
NodeStep write_with_gap(double characters) {
  return stimulus(fmt::format("a write of all valves with a gap of {} characters", characters),
                  [characters](NodeScene& scene) {
                    const auto at = 1 + scene.round % (valve_bus::kCommandOctets - 1);
                    scene.bench.clear_observations();
                    scene.frame = scene.moving_write();
                    scene.bench.send(std::span(scene.frame).first(at));
                    scene.bench.wait(scene.bench.characters(characters));
                    scene.end = scene.bench.send(std::span(scene.frame).subspan(at));
                    scene.bench.await_response_window();
                  });
}

// The valves have stood like this, at least for a moment.
void expect_driven_once(NodeScene& scene, std::uint16_t valves, std::string_view reason) {
  if (!scene.bench.capabilities().process_side) return;
  const auto& changes = scene.bench.boards().changes();
  const bool has_stood =
      std::ranges::any_of(changes, [&](const auto& change) { return change.after == valves; });
  if (!has_stood) expect_not_late(scene.bench, scene.judge, valves);
  scene.judge.expect(has_stood, reason, [&] {
    return Mismatch{
        {fmt::format("first {}, by the write before the last", valves_text(valves))},
        fmt::format("{} moves, and {} at the end", changes.size(), valves_text(scene.bench.valves()))};
  });
}

void write_after_a_delimiter(NodeScene& scene) {
  scene.bench.clear_observations();
  // Neither is what the valves stand by.
  const std::uint16_t before = scene.bench.valves();
  scene.frame = scene.write((before & 0xFFU) ^ 0x0FU, (before >> 8U) ^ 0xF0U);
  const std::uint16_t first = scene.valves();
  scene.bench.send(scene.frame);
  scene.bench.wait_after_write();
  scene.send_next(scene.write((before & 0xFFU) ^ 0x33U, (before >> 8U) ^ 0x33U));
  expect_driven_once(scene, first, "misses_frames_behind_delimiter");
}

// An octet, and so little silence that what follows is no frame of its own.
void write_after_a_short_delimiter(NodeScene& scene) {
  constexpr double kTooShort = 3.3;  // of 3.5 characters
  scene.bench.clear_observations();
  scene.bench.send({0x55});
  scene.bench.wait(scene.bench.characters(kTooShort));
  scene.frame = scene.moving_write();
  scene.end = scene.bench.send(scene.frame);
  scene.bench.await_response_window();
}

// A write whose answer has not begun, and something that cancels it: the valves move all the same.
void expect_write_and_no_answer(NodeScene& scene) {
  NodeBench& bench = scene.bench;
  bench.clear_observations();
  scene.frame = scene.moving_write();
  const std::uint16_t first = scene.valves();
  bench.send(scene.frame);
  bench.wait(bench.delimiter() + bench.bits(1) / 4);
  const auto other = static_cast<unsigned>(bench.address() ^ 1U);
  const std::array frames{scene.write(0x3C, 0xC3),
                          scene.command(other, bench.rules().write_command, 0x12, 0x34),
                          std::vector<std::uint8_t>{0x55}};
  const bool is_own = scene.round % frames.size() == 0;
  scene.send_next(frames.at(scene.round % frames.size()));
  expect_driven_once(scene, first, "write_lost");
  if (!is_own) {
    expect_silence(bench, scene.judge, "answers_into_a_command", "something was sent before it had answered");
    return;
  }
  expect_valves(bench, scene.judge, scene.valves(), "write_lost");
  expect_one_answer(bench, scene.judge, scene.frame[2], scene.frame[3], scene.end);
}

NodeStep write_of(unsigned data0, unsigned data1) {
  return node_chart::sent(fmt::format("a write of {:02X} {:02X}", data0, data1),
                          [=](NodeScene& scene) { return scene.write(data0, data1); });
}

constexpr std::array<unsigned, 4> kUndefined{2, 3, 0x80, 0xFF};

std::vector<std::uint8_t> for_next_node(NodeScene& scene) {
  auto frame = scene.moving_write();
  frame.front() ^= 1U;
  frame.back() ^= 1U;
  return frame;
}

struct NodeSettingRow {
  std::string name;
  std::string what;
  std::vector<MustCatch> catches;
  Applicability not_applicable;
  NodeNeeds needs;
};

NodeCase settings_case(NodeSettingRow row) {
  using namespace node_chart;
  constexpr unsigned kRounds = valve_bus::kCommandOctets - 1;
  return on_chart(
      {.id = "valve_bus/node/settings/serves_" + row.name,
       .purpose = "RN-41",
       .requirement =
           fmt::format("A node {} takes writes, answers reads, and keeps its limits of silence.", row.what),
       .reference = valve_sources::own("what of a node can be set"),
       .tags = {"must"},
       .catches = std::move(row.catches),
       .not_applicable = std::move(row.not_applicable)},
      {{kRounds, 10 * kRounds},
       {write(),
        taken(),
        write_of(0xFF, 0xFF),
        taken(),
        read(),
        answered(),
        sent("a command 2, 3, 80h or FFh",
             [](NodeScene& scene) { return scene.command(kUndefined.at(scene.round % kUndefined.size())); }),
        ignored("acts_on_undefined_command", "nobody has defined it"),
        sent("a write for another node", for_next_node),
        ignored("acts_on_foreign_id", "it is for another node"),
        sent("a write with an octet more",
             [](NodeScene& scene) {
               auto frame = scene.moving_write();
               frame.push_back(0);
               return frame;
             }),
        ignored("acts_on_long_frame", "it has six octets"),
        sent("a write without its check",
             [](NodeScene& scene) {
               auto frame = scene.moving_write();
               frame.pop_back();
               return frame;
             }),
        ignored("acts_on_short_frame", "it has four octets"),
        write_of(0x00, 0x80),
        taken(),
        write_with_gap(1.4),
        taken(),
        write_with_gap(1.6),
        ignored("takes_long_gap", "1.6 characters of silence are in the frame"),
        stimulus("an octet, 3.3 characters of silence, and a write", write_after_a_short_delimiter),
        ignored("delimiter_too_short", "3.3 characters of silence end no frame"),
        stimulus("a write with the stop bit of another character missing in each round",
                 [](NodeScene& scene) { scene.write_with_wrong_level(scene.stop_level()); }),
        ignored("takes_frame_without_stop_bit", "an octet has no stop bit"),
        sent("a write with a wrong check",
             [](NodeScene& scene) {
               auto frame = scene.moving_write();
               frame.back() ^= 0x20U;
               return frame;
             }),
        ignored("acts_on_wrong_check", "its check does not fit"),
        stimulus("a write; 3.5 characters of silence after it, or after its answer, another",
                 write_after_a_delimiter),
        valves_stand("misses_frames_behind_delimiter"),
        serves()}},
      std::move(row.needs));
}

// Where the node holds its valves, however slow its line is.
Applicability for_bit_rate(std::int64_t rate) {
  return for_both(for_answer("bit_rate", rate), for_answer("loss_limit", kernel::Duration{}));
}

}  // namespace

std::vector<NodeCase> node_settings_cases() {
  constexpr std::int64_t kSlowest = 1'200;
  constexpr std::int64_t kFastest = 1'000'000;
  std::vector<NodeCase> all;
  for (NodeSettingRow& row : std::vector<NodeSettingRow>{
           {"1200_bits_per_second",
            "at 1200 bit/s",
            {{"gaps_of_one_bit_rate", "takes_long_gap"}},
            for_bit_rate(kSlowest),
            {.bit_rate = kSlowest, .loss_limit = kernel::Duration{}}},
           {"1000000_bits_per_second",
            "at 1 Mbit/s",
            {{"gaps_of_one_bit_rate", "write_not_taken"}},
            for_bit_rate(kFastest),
            {.bit_rate = kFastest, .loss_limit = kernel::Duration{}}},
           {"9600_bits_per_second",
            "at 9600 bit/s",
            {{"turns_round_in_1900_us", "answer_too_late"}},
            for_bit_rate(9'600),
            {.bit_rate = 9'600, .loss_limit = kernel::Duration{}}},
           {"62500_bits_per_second",
            "at 62.5 kbit/s",
            {{"turns_round_in_1900_us", "answer_too_late"}},
            for_bit_rate(62'500),
            {.bit_rate = 62'500, .loss_limit = kernel::Duration{}}},
           {"187500_bits_per_second",
            "at 187.5 kbit/s",
            {{"gaps_of_one_bit_rate", "takes_long_gap"}},
            for_bit_rate(187'500),
            {.bit_rate = 187'500, .loss_limit = kernel::Duration{}}},
           {"characters_with_parity",
            "with characters P1",
            {{"parity_inverted", "write_not_taken"},
             {"delimiter_of_ten_bits", "delimiter_too_short"},
             {"stop_bit_ignored_with_parity", "takes_frame_without_stop_bit"}},
            for_characters("P1"),
            {.characters = CharacterProfile::even_parity}},
           {"characters_of_ten_bits",
            "with characters P2",
            {{"long_gaps_of_ten_bit_characters", "takes_long_gap"}},
            for_characters("P2"),
            {.characters = CharacterProfile::eight_bits}},
           {"writes_with_answers",
            "that answers writes",
            {{"answers_writes", "no_answer"},
             {"answers_wrong_writes", "acts_on_wrong_check"},
             {"answers_undefined_commands", "acts_on_undefined_command"}},
            for_answer("answers_writes", true),
            {.answers_writes = true}},
           {"one_board",
            "with one board",
            {{"one_board_drives_both", "valves_wrong"}},
            for_answer("boards", std::int64_t{1}),
            {.boards = 1}},
           {"one_board_that_answers_writes",
            "with one board that answers writes",
            {{"acknowledges_what_it_drives", "answer_data_wrong"}},
            for_both(for_answer("answers_writes", true), for_answer("boards", std::int64_t{1})),
            {.boards = 1, .answers_writes = true}}}) {
    all.push_back(settings_case(std::move(row)));
  }
  using namespace node_chart;
  all.push_back(
      on_chart({.id = "valve_bus/node/settings/what_follows_cancels_the_answer_to_a_write",
                .purpose = "RN-43",
                .requirement =
                    "What is sent after a write, before a node that answers writes has begun to, cancels the "
                    "answer, and not the write.",
                .reference = valve_sources::derived("a command before a response has begun cancels it"),
                .tags = {"must"},
                .catches = {{"drives_with_the_answer", "write_lost"}},
                .not_applicable = for_answer("answers_writes", true)},
               {{6, 60},
                {write(),
                 taken(),
                 {"3.5 characters after a write another one, a write for another node, an octet",
                  "the valves have moved as the first write says; only another write is answered",
                  expect_write_and_no_answer},
                 serves()}},
               {.answers_writes = true}));
  return all;
}

}  // namespace fieldproof::conformance
