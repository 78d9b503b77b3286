#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/dual_channel_scene.hpp"

// One thing after the other: each kind of fault after each, on one channel and on both; many in a row; times
// at which a counter of time begins anew; requests meanwhile, and the supply within them.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

template <unsigned errors, unsigned clean, unsigned slot_octets = 28>
ManagerNeeds in_series() {
  return {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
    one.rules.phy_bit_rate = token_bus::Rules{}.phy_bit_rate;
    one.rules.slot_time_octets = slot_octets;
    one.rules.most_octets = token_bus::Rules{}.most_octets;
    one.channels.errors_in_a_row = errors;
    one.channels.clean_in_a_row = clean;
  }};
}

// ---- kinds of faults ----

constexpr std::array<std::string_view, 3> kFaults{"no start delimiter", "bad signal", "frame errors"};
constexpr std::size_t kPairsOfFaults = kFaults.size() * kFaults.size();

// Does what makes the fault; reported is its kind at the end, or nothing.
void make_fault(ManagerScene& scene, Channel here, std::string_view kind, bool is_reported) {
  const std::string_view expected = is_reported ? kind : "";
  const std::string frame = scene.frame();
  if (kind == kFaults[0]) {
    scene.carry_on(other_than(here));
  } else if (kind == kFaults[1]) {
    std::string spoiled = frame;
    spoiled.at(kManagerHead + scene.bench.random_octet() % 64) = 'B';
    scene.carry_from(here, {spoiled}, {frame});
  } else {
    scene.carry_from(here, {scene.with_wrong_check()}, {frame});
    scene.expect_event_of(here, "", "reported_without_fault");
    scene.carry_from(here, {scene.with_wrong_check()}, {frame});
  }
  scene.expect_event_of(here, expected, is_reported ? "report_wrong" : "reported_without_fault");
}

void expect_preferred(ManagerScene& scene, Channel channel) {
  scene.carry({scene.frame()}, {scene.frame()});
  scene.expect_all_of(channel, "wrong_channel");
}

void carry_clean(ManagerScene& scene, Channel here, std::string_view event) {
  scene.carry_on_both();
  scene.expect_event_of(here, event, event.empty() ? "reported_without_fault" : "report_wrong");
}

// The first kind, the second one, and the channel in turn.
std::string_view first_fault(const ManagerScene& scene) {
  return kFaults.at(scene.round / kFaults.size() % kFaults.size());
}
std::string_view second_fault(const ManagerScene& scene) {
  return kFaults.at(scene.round % kFaults.size());
}

void have_faults_on_one(ManagerScene& scene) {
  const Channel here = scene.here();
  for (unsigned n = 0; n < 4; ++n) carry_clean(scene, here, "");
  make_fault(scene, here, first_fault(scene), true);
  expect_preferred(scene, other_than(here));
  make_fault(scene, here, second_fault(scene), false);
  expect_preferred(scene, other_than(here));
  for (unsigned n = 0; n < 2; ++n) carry_clean(scene, here, "");
  make_fault(scene, here, second_fault(scene), false);
  for (unsigned n = 0; n < 3; ++n) carry_clean(scene, here, "");
  carry_clean(scene, here, "clean again");
  carry_clean(scene, here, "");
  expect_preferred(scene, other_than(here));
}

void expect_alone(ManagerScene& scene, Channel channel) {
  const std::string frame = scene.frame();
  scene.carry_from(channel, {frame}, {});
  scene.bench.settle();
  const std::string seen = without_end(scene.bench.indicated().text(), 'S');
  scene.judge.expect(seen.ends_with(from_delimiter(frame)), "wrong_channel",
                     [&] { return difference(from_delimiter(frame), from_delimiter(seen)); });
}

void have_faults_on_both(ManagerScene& scene) {
  const Channel here = scene.here();
  const Channel there = other_than(here);
  scene.power_anew();
  make_fault(scene, here, first_fault(scene), true);
  make_fault(scene, there, second_fault(scene), true);
  expect_preferred(scene, here);
  make_fault(scene, here, first_fault(scene), false);
  expect_preferred(scene, there);
  expect_alone(scene, here);
  expect_alone(scene, there);
}

std::vector<ManagerCase> kinds_cases() {
  return {on_chart(
      manager_must("series/each_kind_after_each", "",
                   "A fault of a channel that has one is not reported, whatever its kind, and the channel is "
                   "clean again only after clean_in_a_row clean ones since; faults of the other channel are "
                   "reported all the same, and each changes the preference.",
                   "who has a fault is watched as before",
                   {{"reports_again_and_again", "reported_without_fault"},
                    {"stays_after_bad_signal", "wrong_channel"}}),
      {{1, 2},
       {powered_anew(),
        {"a channel that was clean has a fault, then another one, twice, and is clean as often as ends it",
         "the first one is reported, and that it is clean again; the other channel is preferred",
         have_faults_on_one},
        {"a channel has a fault, then the other one, then the first again; at last each carries a frame "
         "alone",
         "both are reported once; the channel without the last fault is preferred; each frame is indicated",
         have_faults_on_both}},
       {},
       {"each kind of fault after each", [](ManagerScene&) { return kPairsOfFaults; }}},
      in_series<2, 4>())};
}

// ---- many, and late ----

// One channel alone, then the other one: each is selected anew, is clean again, and the other has a fault.
void alternate(ManagerScene& scene) {
  for (const Channel alone : {Channel::b, Channel::a}) {
    const std::string frame = scene.frame();
    scene.carry_from(alone, {frame}, {});
    std::vector<std::string> events{fmt::format("{}: no start delimiter", text_of(other_than(alone)))};
    if (scene.round > 0 || alone == Channel::a)
      events.insert(events.begin(), fmt::format("{}: clean again", text_of(alone)));
    scene.expect_events(events, "report_wrong");
    scene.expect_indicated(from_delimiter(frame), "wrong_channel");
  }
}

// Each without a wait for what came of the one before.
void carry_close_together(ManagerScene& scene) {
  scene.bench.settle();
  scene.bench.clear();
  std::string all;
  for (unsigned n = 0; n < 8; ++n) {
    const std::string frame = scene.frame() + "SSSS";
    scene.bench.carry({frame}, {frame});
    all += frame;
  }
  scene.expect_indicated(without_end(all, 'S'), "indicated_wrong");
  scene.expect_events({}, "reported_without_fault");
}

// The next instant at which so much time has passed again.
void miss_across(ManagerScene& scene) {
  constexpr std::array kPeriods{kernel::Duration{(std::int64_t{1} << 16) * kernel::kMicrosecond.count()},
                                kernel::Duration{(std::int64_t{1} << 32) * kernel::kNanosecond.count()}};
  const kernel::Duration period = kPeriods.at(scene.round % kPeriods.size());
  scene.power_anew();
  const kernel::Duration since = scene.bench.now() - kernel::kStart;
  const kernel::Duration next = (since / period + 1) * period;
  scene.bench.wait(next - since - scene.bench.symbols(kManagerHead + 60));
  const std::string frame = scene.frame();
  scene.bench.clear();
  scene.bench.carry({}, {frame});
  scene.expect_events({"A: no start delimiter"}, "report_wrong");
  scene.expect_indicated(from_delimiter(frame), "wrong_channel");
  scene.power_anew();
  make_fault(scene, Channel::a, kFaults[0], true);
}

void carry_with_another_clock(ManagerScene& scene) {
  constexpr std::int64_t kMost = 100;  // ppm
  const std::string frame = scene.frame(1'000);
  scene.power_anew();
  scene.carry({frame, 0, scene.round % 2 == 0 ? kMost : -kMost}, {});
  scene.expect_indicated(frame, "indicated_wrong");
  const SideLog& log = scene.bench.indicated();
  if (log.text().size() < frame.size()) return;
  const kernel::Duration usual = scene.bench.symbols(static_cast<std::int64_t>(frame.size()) - 1);
  const kernel::Duration right = usual - usual / 10'000 * (scene.round % 2 == 0 ? 1 : -1);
  const kernel::Duration took = log.time_of(frame.size() - 1) - log.begin();
  const kernel::Duration apart = took < right ? right - took : took - right;
  scene.judge.expect(apart < scene.bench.symbols(1) / 4, "indicated_at_another_rate", kernel::describe(right),
                     kernel::describe(took));
}

std::vector<ManagerCase> many_cases() {
  return {
      on_chart(
          manager_must("series/hundreds_in_a_row", "",
                       "A manager selects and reports the hundredth time as it does the first time.",
                       "a manager knows no number",
                       {{"reports_16_faults", "report_wrong"}, {"reports_once_for_ever", "report_wrong"}}),
          {{130, 1'000},
           {{"B alone carries a frame, then both do",
             "each is indicated, and reported are the fault and that it is over, each time", alternate}}},
          in_series<16, 1>()),
      on_chart(manager_must("series/close_together", "",
                            "A transmission that begins while the one before is still to be indicated takes "
                            "nothing from it.",
                            "the skew that is borne", {{"drops_what_waits", "indicated_wrong"}}),
               {{2, 20},
                {{"both carry eight frames, four symbols apart", "all are indicated, and nothing is reported",
                  carry_close_together}}}),
      on_chart(
          manager_must("series/at_any_time", "", "A slot time is as long whenever it begins.",
                       "a manager knows no time", {{"misses_nothing_after_4_seconds", "report_wrong"}}),
          {{2, 6},
           {{"B alone carries a frame, and 2^16 microseconds or 2^32 nanoseconds are over within the slot "
             "time after its start delimiter; and once more later",
             "A has no start delimiter, and the frame is indicated", miss_across}}},
          in_series<3, 3>()),
      on_chart(manager_must(
                   "series/at_the_rate_of_the_channel", "",
                   "Each symbol lasts as long as it did on its channel, whose clock may be 100 ppm off.",
                   "clock of an indication", {{"indicates_at_its_own_rate", "indicated_at_another_rate"}}),
               {{2, 20},
                {{"A carries a frame of 1000 octets, 100 ppm faster and slower", "it is indicated as it is",
                  carry_with_another_clock}}},
               in_series<3, 3>()),
  };
}

// ---- both ways ----

void request_meanwhile(ManagerScene& scene) {
  scene.bench.settle();
  scene.bench.clear();
  const std::string request = frame_text(scene.bench.random_octets(9));
  const std::string frame = scene.frame(11);
  const kernel::Time requested = scene.bench.begin_request(request);
  const kernel::Time carried = scene.bench.begin_carrying({frame}, {frame});
  scene.bench.wait(std::max(requested, carried) - scene.bench.now());
  scene.expect_on_both_channels(request, "not_on_both");
  scene.expect_indicated(frame, "indicated_wrong");
}

ManagerStep nothing_after(std::string stimulus, std::function<void(ManagerScene&)> run) {
  return {std::move(stimulus), "nothing is requested, indicated or reported from then on",
          [run = std::move(run)](ManagerScene& scene) {
            run(scene);
            scene.expect_on_both_channels("", "sent_without_supply");
            scene.expect_indicated("", "sent_without_supply");
            scene.expect_events({}, "sent_without_supply");
          }};
}

// What is on its way out when the supply fails is on the line already: pieces are at most a delay long.
void fail_within(ManagerScene& scene) {
  const std::string frame = scene.frame(scene.bench.configuration().rules.slot_time_octets);
  scene.bench.settle();
  scene.bench.begin_request(frame_text(scene.bench.random_octets(60)));
  scene.bench.begin_carrying({}, {frame});
  scene.bench.wait(scene.bench.symbols(kManagerHead + 30 + scene.bench.random_octet() % 32));
  scene.bench.set_power(false);
  scene.bench.clear();
}

void give_without_supply(ManagerScene& scene) {
  scene.bench.clear();
  scene.bench.begin_request(frame_text(scene.bench.random_octets(9)));
  scene.bench.carry({scene.frame()}, {});
}

// Off and on in less than a slot time.
void fail_shortly(ManagerScene& scene) {
  scene.bench.set_power(false);
  scene.bench.wait(scene.bench.symbols(2));
  scene.bench.set_power(true);
  scene.bench.clear();
}

void forget_what_was_due(ManagerScene& scene) {
  scene.power_anew();
  scene.bench.carry({}, {scene.frame()});
  fail_shortly(scene);
  scene.expect_events({}, "reported_without_fault");
  scene.bench.carry({}, {scene.frame()});
  fail_shortly(scene);
  const std::string frame = scene.frame();
  scene.bench.carry({frame}, {});
  scene.expect_indicated(frame, "wrong_channel");
  scene.expect_events({"B: no start delimiter"}, "report_wrong");
}

void forget_what_was_counted(ManagerScene& scene) {
  for (unsigned n = 0; n < 2; ++n) {
    scene.carry_from(scene.here(), {scene.with_wrong_check()}, {scene.frame()});
    scene.expect_events({}, "reported_without_fault");
    scene.power_anew();
  }
  for (unsigned n = 0; n < 2; ++n) {
    make_fault(scene, scene.here(), kFaults[0], true);
    carry_clean(scene, scene.here(), "");
    scene.power_anew();
  }
}

std::vector<ManagerCase> supply_and_request_cases() {
  return {
      on_chart(
          manager_must("series/requests_meanwhile", "",
                       "What is requested and what is indicated do not touch each other.",
                       "a redundant medium carries everything twice",
                       {{"sends_on_a_alone", "not_on_both"}, {"deaf_while_it_sends", "indicated_wrong"}}),
          {{2, 20},
           {{"a frame is requested while both channels carry another one",
             "both channels are requested the one, and the other one is indicated", request_meanwhile}}}),
      on_chart(
          manager_must("series/nothing_without_supply", "",
                       "Off, nothing is received or sent, and what was known is gone.",
                       "what is known is lost with the supply",
                       {{"remembers_over_power_failure", "implementation_asks_the_impossible"}}),
          {{4, 20},
           {powered_anew(),
            nothing_after("a frame is requested, B carries another one, and the supply fails within both",
                          fail_within),
            nothing_after("a frame is requested, and A carries one, without supply", give_without_supply),
            powered_anew(),
            {"B carries a frame; the supply fails for two symbols; the same, and A carries one",
             "A has no fault; its frame is indicated", forget_what_was_due},
            powered_anew(),
            {"half of an error, or of a clean channel, in front of a failure of the supply and after it",
             "they do not become a whole", forget_what_was_counted}}},
          in_series<2, 2, 400>()),
  };
}

}  // namespace

std::vector<ManagerCase> manager_series_cases() {
  std::vector<ManagerCase> all;
  for (auto* const chapter : {kinds_cases, many_cases, supply_and_request_cases})
    for (ManagerCase& one : chapter()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
