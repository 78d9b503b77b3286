#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/dual_channel_scene.hpp"

// To the symbol: where the skew and the slot time end, at both ends of the settings and between them.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

// Times by which a symbol lasts a whole number of nanoseconds, so that a limit can be met exactly.
struct Times {
  std::string_view text;
  std::int64_t bit_rate;
  unsigned slot_octets;
  unsigned skew;
  unsigned delay;
};
constexpr std::array kTimes{Times{"least", 1'000'000, 12, 1, 2}, Times{"usual", 10'000'000, 28, 8, 8},
                            Times{"most", 100'000'000, 1'362, 32, 64}};

// Nothing but time makes a fault.
template <std::size_t which>
void adjust_times(token_bus::ChannelManagerConfiguration& one) {
  constexpr Times times = kTimes.at(which);
  one.rules.phy_bit_rate = times.bit_rate;
  one.rules.slot_time_octets = times.slot_octets;
  one.rules.most_octets = token_bus::Rules{}.most_octets;
  one.channels.skew_symbols = times.skew;
  one.channels.errors_in_a_row = 16;
  one.delay_symbols = times.delay;
}

// One symbol less than a limit, the limit, and one symbol more; each on both channels.
constexpr unsigned kPlaces = 6;
std::int64_t limit_place(const ManagerScene& scene) {
  return std::int64_t{scene.round / 2 % 3} - 1;
}
bool is_over_limit(const ManagerScene& scene) {
  return limit_place(scene) > 0;
}

// The preamble of the preferred channel is indicated until the other one has its start delimiter.
void select_at_the_skew(ManagerScene& scene) {
  const Channel preferred = scene.here();
  const std::int64_t later = scene.skew() + limit_place(scene);
  const std::string there = scene.frame();
  scene.prefer(preferred);
  scene.carry_from(preferred, {scene.frame(), later}, {there});
  if (!is_over_limit(scene)) return scene.expect_all_of(preferred, "wrong_channel");
  const std::int64_t before = std::max<std::int64_t>(kManagerPreamble - later, 0);
  scene.expect_indicated(std::string(static_cast<std::size_t>(before), '1') + from_delimiter(there),
                         "wrong_channel");
}

// After the limit it is a new transmission: the other channel misses that one, unless its own still goes on.
void copy_at_the_slot(ManagerScene& scene) {
  const Channel late = scene.here();
  const std::string frame = scene.frame();
  const std::int64_t later = scene.slot_symbols() + limit_place(scene);
  const std::string first = late == Channel::a ? from_delimiter(frame) : frame;
  scene.power_anew();
  scene.carry_from(late, {frame, later}, {frame});
  if (!is_over_limit(scene)) {
    scene.expect_events({}, "reported_without_fault");
    return scene.expect_indicated(first, "wrong_channel");
  }
  scene.bench.settle();
  const std::string missing = fmt::format("{}: no start delimiter", text_of(late));
  const auto& events = scene.bench.events();
  scene.judge.expect(!events.empty() && events.front() == missing, "report_wrong", missing,
                     events.empty() ? "nothing" : events.front());
  const std::int64_t between = later + kManagerPreamble - std::ssize(frame);
  if (between <= 0) return;
  const std::string silence(static_cast<std::size_t>(between), 'S');
  scene.expect_indicated(first + silence + from_delimiter(frame), "wrong_channel");
}

std::string spoiled_at(std::string frame, std::size_t at) {
  frame.at(at) = 'B';
  return frame;
}

void collide_at_the_skew(ManagerScene& scene) {
  constexpr std::size_t kAt = kManagerHead + 10;
  const Channel first = scene.here();
  const std::string frame = scene.frame();
  scene.power_anew();
  scene.carry_from(first, {spoiled_at(frame, kAt)},
                   {spoiled_at(frame, kAt + static_cast<std::size_t>(scene.skew() + limit_place(scene)))});
  scene.expect_event_of(first, is_over_limit(scene) ? "bad signal" : "", "report_wrong");
}

void spoil_at_the_slot(ManagerScene& scene) {
  constexpr std::size_t kOctetsAfterASlot = 8;
  const std::string frame =
      scene.frame(scene.bench.configuration().rules.slot_time_octets + kOctetsAfterASlot);
  // It counts when it is complete.
  const std::size_t at =
      kManagerHead + static_cast<std::size_t>(scene.slot_symbols() + limit_place(scene)) - 1;
  scene.power_anew();
  scene.carry_from(scene.here(), {spoiled_at(frame, at)}, {frame});
  scene.expect_event_of(scene.here(), is_over_limit(scene) ? "" : "bad signal", "report_wrong");
}

struct Limit {
  std::string_view id;
  std::string_view requirement;
  std::string_view place;
  std::string_view stimulus;
  std::string_view expected;
  void (*run)(ManagerScene&);
  std::vector<MustCatch> catches;
  std::vector<MustCatch> catches_with_least{};  // times that are not the usual ones
};

const std::vector<Limit>& limit_rows() {
  static const std::vector<Limit> all{
      {"skew",
       "The preferred channel is selected up to the skew, to the symbol.",
       "the skew that is borne",
       "the preferred channel carries a frame a symbol less than the skew, the skew and a symbol more later "
       "than the other one, on each channel",
       "up to the skew that of the preferred channel is indicated, in time, else that of the other one",
       select_at_the_skew,
       {{"skew_a_symbol_long", "wrong_channel"}, {"skew_a_symbol_short", "wrong_channel"}},
       {{"knows_no_skew", "indicated_too_late"}}},
      {"copy",
       "A start delimiter that comes up to a slot time after that of the other channel is the same "
       "transmission again, and no fault; a symbol later it is a fault.",
       "no start delimiter for a slot time",
       "a channel carries the frame of the other one a symbol less than a slot time, a slot time and a "
       "symbol "
       "more later, on each channel",
       "up to the slot time it is not indicated, and nothing is reported; later, no start delimiter is, and "
       "it is "
       "indicated where the other one is over",
       copy_at_the_slot,
       {{"slot_a_symbol_long", "report_wrong"}, {"slot_a_symbol_short", "reported_without_fault"}},
       {{"knows_no_slot_time", "report_wrong"}}},
      {"collision",
       "bad_signal on both channels up to the skew apart is a collision, to the symbol.",
       "what both channels spoil says nothing about either",
       "both carry a frame with one bad_signal in it, a symbol less than the skew, the skew and a symbol "
       "more "
       "apart, on each channel first",
       "bad signal of the first one is reported where they are more than the skew apart, else nothing",
       collide_at_the_skew,
       {{"collisions_a_symbol_long", "report_wrong"}, {"collisions_a_symbol_short", "report_wrong"}}},
      {"bad_signal",
       "bad_signal is a fault up to a slot time after the start delimiter of the other channel, to the "
       "symbol.",
       "bad_signal for a slot time",
       "both carry a frame; one has a bad_signal that ends a symbol less than a slot time, a slot time and a "
       "symbol more after the start delimiter, on each channel",
       "up to the slot time bad signal is reported, later nothing",
       spoil_at_the_slot,
       {{"bad_signal_a_symbol_long", "report_wrong"}, {"bad_signal_a_symbol_short", "report_wrong"}}},
  };
  return all;
}

ManagerCase limit_case(const Limit& limit, const Times& times, ManagerNeeds needs) {
  std::vector<MustCatch> catches = limit.catches;
  if (&times == kTimes.data())
    catches.insert(catches.end(), limit.catches_with_least.begin(), limit.catches_with_least.end());
  return on_chart(
      manager_must(fmt::format("limits/{}_with_{}_times", limit.id, times.text), "",
                   fmt::format("{} Here with {} octets of slot time and {} symbols of skew.",
                               limit.requirement, times.slot_octets, times.skew),
                   std::string(limit.place), std::move(catches)),
      {{kPlaces, 10 * kPlaces}, {{std::string(limit.stimulus), std::string(limit.expected), limit.run}}},
      needs);
}

}  // namespace

std::vector<ManagerCase> manager_limit_cases() {
  constexpr std::array kNeeds{ManagerNeeds{adjust_times<0>}, ManagerNeeds{adjust_times<1>},
                              ManagerNeeds{adjust_times<2>}};
  std::vector<ManagerCase> all;
  for (const Limit& limit : limit_rows()) {
    for (std::size_t n = 0; n < kTimes.size(); ++n)
      all.push_back(limit_case(limit, kTimes.at(n), kNeeds.at(n)));
  }
  return all;
}

}  // namespace fieldproof::conformance
