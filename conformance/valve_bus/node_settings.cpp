#include <fmt/format.h>

#include <string>
#include <utility>

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

void write_after_a_delimiter(NodeScene& scene) {
  scene.bench.clear_observations();
  scene.frame = scene.moving_write();
  scene.bench.send(scene.frame);
  scene.bench.wait_after_write();
  scene.send(
      scene.write(static_cast<std::uint8_t>(~scene.frame[2]), static_cast<std::uint8_t>(~scene.frame[3])));
}

NodeStep write_of(unsigned data0, unsigned data1) {
  return node_chart::sent(fmt::format("a write of {:02X} {:02X}", data0, data1),
                          [=](NodeScene& scene) { return scene.write(data0, data1); });
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
  return on_chart({.id = "valve_bus/node/settings/serves_" + row.name,
                   .purpose = "RN-41",
                   .requirement = fmt::format(
                       "A node {} takes writes, answers reads, and keeps its limits of silence.", row.what),
                   .reference = valve_sources::own("what of a node can be set"),
                   .tags = {"must"},
                   .catches = std::move(row.catches),
                   .not_applicable = std::move(row.not_applicable)},
                  {{kRounds, 10 * kRounds},
                   {write(), taken(), write_of(0xFF, 0xFF), taken(), read(), answered(), write_of(0x00, 0x80),
                    taken(), write_with_gap(1.4), taken(), write_with_gap(1.6),
                    ignored("takes_long_gap", "1.6 characters of silence are in the frame"),
                    stimulus("a write; 3.5 characters of silence after it, or after its answer, another",
                             write_after_a_delimiter),
                    valves_stand("misses_frames_behind_delimiter"), serves()}},
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
           {"characters_with_parity",
            "with characters P1",
            {{"parity_inverted", "write_not_taken"}},
            for_characters("P1"),
            {.characters = CharacterProfile::even_parity}},
           {"characters_of_ten_bits",
            "with characters P2",
            {{"long_gaps_of_ten_bit_characters", "takes_long_gap"}},
            for_characters("P2"),
            {.characters = CharacterProfile::eight_bits}},
           {"writes_with_answers",
            "that answers writes",
            {{"answers_writes", "no_answer"}},
            for_answer("answers_writes", true),
            {.answers_writes = true}},
           {"one_board_that_answers_writes",
            "with one board that answers writes",
            {{"acknowledges_what_it_drives", "answer_data_wrong"}},
            for_both(for_answer("answers_writes", true), for_answer("boards", std::int64_t{1})),
            {.boards = 1, .answers_writes = true}}}) {
    all.push_back(settings_case(std::move(row)));
  }
  return all;
}

}  // namespace fieldproof::conformance
