#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/chart.hpp"
#include "conformance/token_bus/dual_channel_cases.hpp"

// The words of charts for a dual channel manager.
namespace fieldproof::conformance {

// What the steps of one round share. What a channel carries is written with ones for its preamble, as a
// translator indicates it.
struct ManagerScene : Scene<ManagerBench> {
  using Scene::Scene;

  ChannelText a{};  // carried last
  ChannelText b{};
  std::string requested{};
  kernel::Time begin{};  // of what was carried or requested last
  unsigned turn = 0;     // of steps that are repeated

  std::int64_t skew() const { return bench.configuration().channels.skew_symbols; }
  // So many symbols, or as many as the skew is.
  std::int64_t borne(std::int64_t later) const { return std::min(later, skew()); }
  std::int64_t slot_symbols() const { return 8 * std::int64_t{bench.configuration().rules.slot_time_octets}; }
  // Random octets with their check, between delimiters: as few as a frame has, and more.
  std::string frame(std::size_t more_octets = 0, bool more_follows = false);
  std::string longest_frame();
  std::string with_wrong_check();
  void request(std::string symbols);
  void carry(ChannelText on_a, ChannelText on_b);
  // The same frame.
  void carry_on_both() {
    const std::string one = frame();
    carry({one}, {one});
  }
  // `here` carries the one, the other channel the other.
  void carry_from(Channel here, ChannelText on_it, ChannelText on_the_other) {
    if (here == Channel::b) std::swap(on_it, on_the_other);
    carry(std::move(on_it), std::move(on_the_other));
  }
  // Each channel in turn.
  Channel here() const { return token_bus::kChannels.at(round % 2); }
  // The other channel is preferred from then on.
  void prefer(Channel channel) {
    power_anew();
    if (channel == Channel::b) carry_on(channel);
  }
  void carry_on(Channel channel) { channel == Channel::a ? carry({frame()}, {}) : carry({}, {frame()}); }
  // Off, and on again: channel A is preferred, and nothing is known of either.
  void power_anew();

  // ---- what must come; waits for it ----
  // Exactly what the channel carried last, in time.
  void expect_all_of(Channel channel, std::string_view reason);
  // From its start delimiter on.
  void expect_from_delimiter_of(Channel channel, std::string_view reason);
  void expect_indicated(const std::string& symbols, std::string_view reason);
  // "clean again" of the channel; nothing where the kind is empty.
  void expect_event_of(Channel channel, std::string_view kind, std::string_view reason);
  void expect_events(const std::vector<std::string>& events, std::string_view reason);
  void expect_on_both_channels(const std::string& symbols, std::string_view reason);
};

// Symbols in front of the octets: the preamble of what testers drive, and a start delimiter.
inline constexpr std::int64_t kManagerPreamble = 32;
inline constexpr std::size_t kManagerHead = 40;

using ManagerStep = ChartStep<ManagerScene>;

std::string from_delimiter(const std::string& symbols);

inline ManagerCase on_chart(TestCase test_case, Chart<ManagerScene> chart, ManagerNeeds needs = {}) {
  return charted<ManagerCase>(std::move(test_case), std::move(chart), needs);
}

// It rests on this project's choice; `place` says what was chosen.
TestCase manager_must(const std::string& id, std::string purpose, std::string requirement, std::string place,
                      std::vector<MustCatch> catches);

namespace manager_chart {

ManagerStep does(std::string text, std::function<void(ManagerScene&)> run);
ManagerStep requires_that(std::string text, std::function<void(ManagerScene&)> run);
ManagerStep powered_anew();
// Only B carries a frame: it is served, and A has a fault.
ManagerStep b_serves();
// Nothing has been reported since the channels carried something.
ManagerStep nothing_reported(std::string reason);
ManagerStep reported(std::vector<std::string> events, std::string reason);
// Both carry something else, as long as it takes to see whose is indicated.
ManagerStep indicates_of(Channel channel, std::string reason);
// Both carry the same frame, and it is indicated: `does_not_recover`.
ManagerStep still_serves();

}  // namespace manager_chart
}  // namespace fieldproof::conformance
