#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "conformance/interbus/slave_scene.hpp"

// IS-43: cycles that are shorter than the register and the loopback word, with their right check.
namespace fieldproof::conformance {
namespace {

constexpr std::size_t kLoopbackOctets = 2;
constexpr std::size_t kIdRegisterOctets = 2;

// A cycle of random octets as the station in front of the slave would send it.
FoundCycle drive_random_octets(SlaveBench& bench, bool is_id_cycle, std::size_t octets) {
  std::vector<std::uint8_t> drawn(octets);
  for (std::uint8_t& octet : drawn) octet = static_cast<std::uint8_t>(bench.random().next());
  TrainWriter writer(bench.rules());
  writer.cycle(is_id_cycle, drawn, bench.model().check().of(drawn), bench.rules().status_clean);
  line::Waveform wave{bench.now(), bench.rules().bit_rate, writer.levels()};
  bench.drive_at_receiver(wave);
  FoundCycle left;
  find_last_cycle(bench.out().data_telegrams(), left);
  return left;
}

void reject_short_cycle(SlaveBench& bench, CaseJudge& judge, bool is_id_cycle, std::size_t octets) {
  const FoundCycle left = drive_random_octets(bench, is_id_cycle, octets);
  const std::uint16_t marked = bench.rules().status_marked;
  judge.expect(
      left.is_found && (left.status & marked) == marked, "short_cycle_accepted",
      fmt::format("{} cycle of {} octets leaves marked: the register and the loopback word do not fit in",
                  is_id_cycle ? "an ID" : "a data", octets),
      left.is_found ? fmt::format("status word {:04X}h", left.status) : "no whole cycle left");
  expect_no_change(bench, judge, "output_changed_by_rejected_cycle",
                   fmt::format("a cycle of {} octets is too short", octets));
}

// Lengths below `least`: the shortest ones, the longest ones and some between.
std::vector<std::size_t> short_lengths(SlaveBench& bench, std::size_t least) {
  std::vector<std::size_t> lengths;
  const std::size_t most = bench.volume<std::size_t>(12, 200);
  for (std::size_t n = 1; n < least; ++n) {
    const bool is_at_an_end = n <= 2 || n + 4 >= least;
    if (is_at_an_end || bench.random().below(least) < most) lengths.push_back(n);
  }
  return lengths;
}

std::size_t least_octets(const SlaveScene& scene) {
  return 2 * scene.bench.words() + kLoopbackOctets;
}

void reject_short_data_cycles(SlaveScene& scene) {
  for (const std::size_t octets : short_lengths(scene.bench, least_octets(scene)))
    reject_short_cycle(scene.bench, scene.judge, false, octets);
}

void reject_short_id_cycles(SlaveScene& scene) {
  for (std::size_t octets = 1; octets < kIdRegisterOctets + kLoopbackOctets; ++octets)
    reject_short_cycle(scene.bench, scene.judge, true, octets);
}

void accept_shortest_data_cycle(SlaveScene& scene) {
  const std::size_t least = least_octets(scene);
  drive_random_octets(scene.bench, false, least);
  scene.judge.expect(left_clean(scene.bench), "valid_cycle_rejected",
                     "a cycle of register and loopback word is accepted",
                     "its status word did not leave clean");
  const std::span<const SeenTelegram> in = scene.bench.in().data_telegrams();
  if (in.size() < least) return;
  expect_outputs(scene.bench, scene.judge, words_held(in.first(least), scene.bench.words()),
                 "valid_cycle_rejected");
}

}  // namespace

std::vector<SlaveCase> slave_short_cycle_cases() {
  using namespace slave_chart;
  const std::string right =
      "of 1 octet up to one less than register and loopback word have, random, with their right check";
  return {slave_case(
      "frame_check/cycle_shorter_than_the_register_is_rejected", "IS-43",
      "A ring is never shorter than a slave's register and the loopback word: a cycle with fewer octets is "
      "an error, however well its check fits.",
      sources::own("fewer telegrams than register and loopback word are an error"),
      {{"takes_a_cycle_one_telegram_short", "short_cycle_accepted"},
       {"does_not_look_at_the_length", "short_cycle_accepted"},
       {"tells_no_check_error", "message_missing"}},
      {.steps = {identified(),
                 good_cycle(),
                 {"data cycles " + right, "they leave marked, no output changes", reject_short_data_cycles},
                 check_error(true, "message_missing", "cycles were too short"),
                 {"ID cycles " + right, "they leave marked, no output changes", reject_short_id_cycles},
                 {"a data cycle of exactly register and loopback word", "it is accepted",
                  accept_shortest_data_cycle}}},
      {.details = {details::message()}})};
}

}  // namespace fieldproof::conformance
