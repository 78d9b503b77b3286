#include <fmt/format.h>

#include <algorithm>

#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/dual_channel_scene.hpp"

// A ring runs while a channel is cut: its station has the reference of a MAC, the tester plays all others.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

constexpr std::uint8_t kStation = 0x0A;
constexpr std::uint8_t kRingAbove = 0x0E;
constexpr std::uint8_t kRingBelow = 0x04;
constexpr unsigned kMostLost = 1;

struct RingScene : ManagerScene {
  using ManagerScene::ManagerScene;

  bool is_a_cut = false;
  unsigned lost = 0;  // passes, since the ring began or A was repaired

  static std::string control(TokenControl kind, std::uint8_t destination, std::uint8_t source) {
    const std::vector<std::uint8_t> octets{static_cast<std::uint8_t>(kind), destination, 0, source, 0};
    return indicated_as(frame_text(with_crc_32(octets)));
  }
  // On both channels, or on B alone; after as long a silence as a tester leaves.
  void send(const std::string& frame) {
    constexpr std::int64_t kGap = 64;
    bench.wait(bench.symbols(kGap));
    bench.clear_requests();
    bench.carry({is_a_cut ? "" : frame}, {frame});
  }
  // The station sends it within so many slot times; what it sends besides does not matter.
  bool comes(const std::string& frame, std::int64_t slot_times) {
    const std::string symbols = from_delimiter(frame);
    const kernel::Time until = bench.now() + slot_times * bench.slot();
    while (bench.now() < until) {
      bench.wait(bench.symbols(8));
      if (bench.requested(Channel::b).text().find(symbols) != std::string::npos) return true;
    }
    return false;
  }
  // The token goes round once: the station has it, and passes it on.
  bool rotates() {
    constexpr std::int64_t kWithWindow = 6;
    send(control(TokenControl::token, kStation, kRingAbove));
    if (!comes(control(TokenControl::token, kRingBelow, kStation), kWithWindow)) return false;
    send(control(TokenControl::token, kRingAbove, kRingBelow));
    return true;
  }
  void rotate(unsigned times) {
    for (unsigned n = 0; n < times; ++n) lost += rotates() ? 0U : 1U;
  }
};

void begin_ring(RingScene& scene) {
  scene.power_anew();
  scene.is_a_cut = false;
  scene.bench.begin_ring(kStation);
  scene.send(RingScene::control(TokenControl::solicit_1, kRingBelow, kRingAbove));
  scene.bench.wait(2 * scene.bench.slot());
  scene.lost = 0;
  scene.rotate(4);
  if (scene.lost == 0) return;
  scene.judge.inconclusive("precondition_not_met",
                           {{"a ring that runs on both channels"}, "the token is lost"});
}

// After a frame, within one, or in front of one. The one within which it is cut is lost.
void cut_a_of_ring(RingScene& scene) {
  scene.is_a_cut = true;
  if (scene.round % 3 != 1) return;
  const std::string token = RingScene::control(TokenControl::token, kStation, kRingAbove);
  scene.bench.carry({token.substr(0, 60)}, {token});
  scene.bench.wait(2 * scene.bench.slot());
  scene.lost = 1;
}

void expect_ring(RingScene& scene) {
  constexpr unsigned kRotations = 10;
  scene.rotate(kRotations);
  scene.judge.expect(scene.lost <= kMostLost, "token_lost",
                     fmt::format("{} passes are lost at most", kMostLost), fmt::format("{} are", scene.lost));
}

// A cut within a frame may be the error that is one too many.
void expect_fault_of_a(RingScene& scene) {
  const auto& events = scene.bench.events();
  scene.expect_events(
      {events.empty() || events.front() != "A: frame errors" ? "A: no start delimiter" : "A: frame errors"},
      "report_wrong");
}

// In which a station of 16 bits finds the answers of its ring in time.
ManagerNeeds with_a_slot_for_rings() {
  return {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
    const token_bus::Rules usual;
    one.rules.address_length = token_bus::AddressLength::bits_16;
    one.rules.slot_time_octets = std::max(one.rules.slot_time_octets, usual.slot_time_octets);
    one.rules.most_octets = usual.most_octets;
    // Of its station, which shall not claim while a pass is repeated.
    one.rules.bus_idle_slots = usual.bus_idle_slots;
    one.rules.lowest_bus_idle_slots = usual.lowest_bus_idle_slots;
  }};
}

}  // namespace

std::vector<ManagerCase> manager_ring_cases() {
  const auto step = [](std::string stimulus, std::string expected, std::function<void(RingScene&)> run) {
    return ChartStep<RingScene>{std::move(stimulus), std::move(expected), std::move(run)};
  };
  return {charted<ManagerCase>(
      manager_must("ring/survives_the_cut_of_a_channel", "PST-16",
                   "A ring loses one pass of the token at most when a channel is cut, goes on with the other "
                   "one, and the fault and the repair are reported.",
                   "how many passes a cut may cost",
                   {{"never_leaves_a", "token_lost"}, {"reports_nothing", "report_wrong"}}),
      Chart<RingScene>{
          {3, 12},
          {step("a ring of three runs on both channels, one of them through the manager", "", begin_ring),
           step("A is cut in front of a frame, within one or after one", "", cut_a_of_ring),
           step("the token goes round ten times", "one pass is lost at most", expect_ring),
           step("", "one fault is reported, of A", expect_fault_of_a),
           step("A is repaired", "the ring goes on, and that is reported",
                [](RingScene& scene) {
                  scene.is_a_cut = false;
                  scene.bench.clear();
                  expect_ring(scene);
                  scene.expect_events({"A: clean again"}, "report_wrong");
                })}},
      with_a_slot_for_rings())};
}

}  // namespace fieldproof::conformance
