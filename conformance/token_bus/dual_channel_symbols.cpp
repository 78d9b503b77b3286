#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/dual_channel_scene.hpp"
#include "conformance/token_bus/dual_channel_words.hpp"

// What is a delimiter, and what is not; what ends a transmission, and what only stands beside one.
namespace fieldproof::conformance {
namespace {

using namespace manager_chart;

// Errors and clean ones at once, so that each transmission tells.
ManagerNeeds told_at_once() {
  return {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
    one.channels.errors_in_a_row = 1;
    one.channels.clean_in_a_row = 16;
  }};
}

// ---- delimiters ----

// Place n of a text otherwise: each symbol that it is not.
struct Otherwise {
  std::size_t at;
  char symbol;
};
std::vector<Otherwise> all_otherwise(std::string_view delimiter, std::string_view symbols) {
  std::vector<Otherwise> all;
  for (std::size_t at = 0; at < delimiter.size(); ++at) {
    for (const char symbol : symbols)
      if (symbol != delimiter[at]) all.push_back({at, symbol});
  }
  return all;
}
const std::vector<Otherwise>& no_start_delimiters() {
  static const auto all = all_otherwise("NN0NN000", "01NB");
  return all;
}
// I and E are what they are.
const std::vector<Otherwise>& no_end_delimiters() {
  static const auto all = all_otherwise("NN1NN1", "01N");
  return all;
}

ManagerCase start_delimiter_case() {
  return on_chart(
      manager_must("symbols/what_is_no_start_delimiter", "",
                   "A start delimiter in which one symbol is another is none: nothing begins with it.",
                   "what comes in front of a start delimiter",
                   {{"start_delimiter_of_six", "reported_without_fault"}}),
      {{1, 2},
       {powered_anew(),
        {"B alone carries a frame whose start delimiter has another symbol",
         "silence, and nothing is reported",
         [](ManagerScene& scene) {
           const Otherwise& one = no_start_delimiters().at(scene.round % no_start_delimiters().size());
           std::string frame = scene.frame();
           frame.at(kManagerPreamble + one.at) = one.symbol;
           scene.carry({}, {frame});
           scene.expect_events({}, "reported_without_fault");
           scene.expect_indicated("", "indicated_wrong");
         }}},
       {},
       {"each symbol of a start delimiter as each other",
        [](ManagerScene&) { return no_start_delimiters().size(); }}});
}

ManagerCase end_delimiter_case() {
  return on_chart(
      manager_must("symbols/what_is_no_end_delimiter", "PST-17",
                   "A frame is spoiled when a symbol of its end delimiter is another.",
                   "spoiled transmissions in a row", {{"errors_are_no_fault", "report_wrong"}}),
      {{1, 2},
       {powered_anew(),
        {"both carry a frame; the end delimiter of A has another symbol", "frame errors are reported",
         [](ManagerScene& scene) {
           const Otherwise& one = no_end_delimiters().at(scene.round % no_end_delimiters().size());
           const std::string frame = scene.frame();
           std::string other = frame;
           other.at(frame.size() - 8 + one.at) = one.symbol;
           scene.carry({other}, {frame});
           scene.expect_event_of(Channel::a, "frame errors", "report_wrong");
         }}},
       {},
       {"each symbol of an end delimiter as each other",
        [](ManagerScene&) { return no_end_delimiters().size(); }}},
      told_at_once());
}

// ---- codes ----

ManagerCase codes_case() {
  return on_chart(
      manager_must("symbols/the_circuit_that_is_anything", "",
                   "non_data and bad_signal are the same symbols whatever symbol 0 is.",
                   "codes of MAC symbols", {{"circuit_that_is_anything_is_looked_at", "report_wrong"}}),
      {{2, 20},
       {powered_anew(),
        {"a channel alone carries a frame, symbol 0 of non_data is 1",
         "it is indicated; the other one has a fault",
         [](ManagerScene& scene) {
           const std::string frame = scene.frame();
           scene.carry_from(scene.here(), {with_other_codes(frame)}, {});
           scene.expect_event_of(other_than(scene.here()), "no start delimiter", "report_wrong");
           scene.expect_indicated(scene.here() == Channel::a ? frame : from_delimiter(frame),
                                  "indicated_wrong");
         }},
        powered_anew(),
        {"both carry a frame, one with a bad_signal in it, symbol 0 is 1", "bad signal is reported",
         [](ManagerScene& scene) {
           const std::string frame = scene.frame();
           std::string spoiled = frame;
           spoiled.at(kManagerHead + 20) = 'b';
           scene.carry_from(scene.here(), {spoiled}, {frame});
           scene.expect_event_of(scene.here(), "bad signal", "report_wrong");
         }}}});
}

// ---- what ends a transmission ----

// On A symbols go on after what ends a transmission; B carries the same, and another one meanwhile. It has
// its start delimiter while those of A are indicated.
void carry_on_after_the_end(ManagerScene& scene) {
  constexpr std::size_t kPause = 40;
  const bool ends_by_itself = scene.round % 3 == 0;
  const std::string first = scene.frame(0, !ends_by_itself);
  std::string on_a = first + (ends_by_itself ? "1111" : scene.round % 3 == 1 ? "SSSS" : "ssss");
  const std::string on_b = first + std::string(kPause, 'S') + scene.frame();
  const std::size_t second = first.size() + kPause + kManagerPreamble;
  on_a.resize(second + 8 + static_cast<std::size_t>(scene.skew()) + 20, '1');
  scene.carry({on_a}, {on_b});
  std::string right = on_a.substr(0, second) + on_b.substr(second);
  std::ranges::replace(right, 's', 'S');
  scene.expect_events({"A: no start delimiter"}, "report_wrong");
  scene.expect_indicated(right, "wrong_channel");
}

ManagerCase ends_case() {
  return on_chart(
      manager_must("symbols/what_ends_a_transmission", "",
                   "A transmission ends with an end delimiter whose I is 0, though symbols follow, and with "
                   "silence, whatever symbol 0 is: then another one is selected.",
                   "end of a transmission", {{"ends_with_silence_alone", "report_wrong"}}),
      {{3, 30},
       {powered_anew(),
        {"A carries a frame, of which I is 0, or silence follows, and then ones; B the same and another "
         "frame "
         "meanwhile",
         "the ones are indicated, then the frame of B from its start delimiter on; A has no start delimiter",
         carry_on_after_the_end}}});
}

// ---- beside a transmission ----

void carry_noise_on_a(ManagerScene& scene) {
  constexpr std::array<std::string_view, 4> kNoise{"1", "0", "N1", "0110N"};
  const std::string_view noise = kNoise.at(scene.round % kNoise.size());
  const std::string on_b = scene.frame();
  std::string on_a;
  while (on_a.size() < kManagerHead + static_cast<std::size_t>(scene.skew()) + 30) on_a += noise;
  on_a += "1";
  scene.carry({on_a}, {on_b});
  scene.expect_events({"A: no start delimiter"}, "report_wrong");
  scene.expect_indicated(on_a.substr(0, kManagerPreamble) + from_delimiter(on_b), "wrong_channel");
}

void carry_bad_signal_alone(ManagerScene& scene) {
  const std::string frame = scene.frame();
  scene.carry_from(scene.here(), {"B", static_cast<std::int64_t>(kManagerHead) + 10 + scene.borne(5)},
                   {frame});
  scene.expect_event_of(scene.here(), "bad signal", "report_wrong");
}

// In the preamble of the one: long before that of the other, and not since the start delimiter.
void carry_bad_signal_before(ManagerScene& scene) {
  std::string first = scene.frame();
  std::string second = first;
  first.at(4) = 'B';
  second.at(kManagerHead + 20) = 'B';
  scene.carry_from(scene.here(), {first}, {second});
  scene.expect_event_of(other_than(scene.here()), "bad signal", "report_wrong");
}

// A has one long frame, B two short ones meanwhile; nothing is due on A.
void carry_two_within_one(ManagerScene& scene) {
  const std::string first = scene.frame();
  const std::string on_b = first + std::string(20, 'S') + scene.frame();
  std::string on_a = scene.frame(on_b.size() / 8);
  on_a.at(4) = 'B';
  scene.carry({on_a}, {on_b});
  scene.expect_events({}, "reported_without_fault");
  scene.expect_indicated(on_a, "wrong_channel");
}

// The same, but that of A has bad_signal later than a slot time.
void carry_two_within_what_is_spoiled(ManagerScene& scene) {
  const std::string on_b = scene.frame() + std::string(20, 'S') + scene.frame();
  std::string on_a = scene.frame(on_b.size() / 8);
  on_a.at(kManagerHead + static_cast<std::size_t>(scene.slot_symbols()) + 20) = 'B';
  scene.carry({on_a}, {on_b});
  scene.expect_events({"A: no start delimiter"}, "report_wrong");
}

std::vector<ManagerCase> beside_cases() {
  return {
      on_chart(
          manager_must("symbols/noise_is_no_start_delimiter", "",
                       "A preferred channel that carries symbols and no start delimiter has a fault, and "
                       "is left for the other one.",
                       "no start delimiter for a slot time",
                       {{"leaves_a_one_later", "wrong_channel"}, {"reports_nothing", "report_wrong"}}),
          {{4, 40},
           {powered_anew(),
            {"A carries symbols without a start delimiter, B a frame",
             "the symbols are indicated, then the frame from its start delimiter on; A has no start "
             "delimiter",
             carry_noise_on_a}}}),
      on_chart(
          manager_must("symbols/one_bad_signal_is_enough", "",
                       "One bad_signal within a slot time is a fault, though the channel carries nothing "
                       "else, and though the other one had bad_signal before its start delimiter.",
                       "bad_signal for a slot time", {{"bad_signal_is_no_fault", "report_wrong"}}),
          {{4, 40},
           {powered_anew(),
            {"a channel carries a frame, the other one a bad_signal meanwhile", "bad signal is reported",
             carry_bad_signal_alone},
            powered_anew(),
            {"both carry a frame, one with bad_signal in its preamble, the other one in its octets",
             "bad signal of the other one is reported", carry_bad_signal_before}}}),
      on_chart(
          manager_must(
              "symbols/a_frame_under_way", "",
              "On a channel where a frame is under way that is not spoiled no start delimiter is due, "
              "and no other transmission is selected; bad_signal before its start delimiter says nothing.",
              "what cannot complete is no transmission",
              {{"misses_within_a_frame", "reported_without_fault"},
               {"selects_each_frame_anew", "wrong_channel"},
               {"misses_nothing_within_a_transmission", "report_wrong"}}),
          {{2, 20},
           {powered_anew(),
            {"A carries a long frame, with bad_signal in its preamble, B two short ones meanwhile",
             "that of A is indicated, and nothing is reported", carry_two_within_one},
            powered_anew(),
            {"the same, but that of A is spoiled later than a slot time after its start delimiter",
             "A has no start delimiter", carry_two_within_what_is_spoiled}}},
          {.adjust =
               [](token_bus::ChannelManagerConfiguration& one) {
                 one.rules.slot_time_octets = 12;
                 one.rules.most_octets = token_bus::Rules{}.most_octets;
               }}),
  };
}

// ---- the longest frame ----

// B's second start delimiter is complete so many octets after that of A.
ChannelText second_after(ManagerScene& scene, std::size_t octets) {
  const std::string first = scene.frame();
  const std::size_t begin = 8 * octets;
  return {first + std::string(begin - first.size(), 'S') + scene.frame()};
}

void carry_endless(ManagerScene& scene) {
  const std::size_t octets = scene.bench.configuration().rules.most_octets;
  const ChannelText on_b = second_after(scene, octets + 6);
  std::string on_a = on_b.symbols.substr(0, kManagerHead);
  on_a.resize(on_b.symbols.size() + 8 * (scene.bench.configuration().rules.slot_time_octets + 4U), '1');
  scene.carry({on_a}, on_b);
  scene.expect_events({"A: no start delimiter"}, "report_wrong");
  const std::size_t second = 8 * (octets + 6) + kManagerPreamble;
  scene.expect_indicated(on_a.substr(0, second) + on_b.symbols.substr(second), "wrong_channel");
}

void carry_longest(ManagerScene& scene) {
  const token_bus::Rules& rules = scene.bench.configuration().rules;
  const std::size_t more = rules.most_octets - token_bus::frame_octets(rules, 0);
  scene.carry({scene.frame(more)}, second_after(scene, rules.most_octets));
  scene.expect_events({}, "reported_without_fault");
  scene.expect_all_of(Channel::a, "wrong_channel");
}

template <std::size_t octets>
ManagerCase longest_case(std::vector<MustCatch> catches) {
  return on_chart(
      manager_must(
          fmt::format("symbols/longest_frame_of_{}_octets", octets), "",
          fmt::format("A frame is under way for as long as the longest one takes, here of {} octets; "
                      "after that a start delimiter is due.",
                      octets),
          "what cannot complete is no transmission", std::move(catches)),
      {{1, 5},
       {powered_anew(),
        {"A carries the longest frame, B a short one and another one in the last octets of that of A",
         "that of A is indicated, and nothing is reported", carry_longest},
        powered_anew(),
        {"A carries ones for ever after a start delimiter, B a short frame and another one later than the "
         "longest frame",
         "A has no start delimiter, and the second one of B is selected", carry_endless}}},
      {.adjust = [](token_bus::ChannelManagerConfiguration& one) {
        one.rules.slot_time_octets = 12;
        one.rules.most_octets = octets;
        one.channels.errors_in_a_row = 16;
      }});
}

}  // namespace

std::vector<ManagerCase> manager_symbol_cases() {
  std::vector<ManagerCase> all{start_delimiter_case(),
                               end_delimiter_case(),
                               codes_case(),
                               ends_case(),
                               longest_case<64>({{"knows_no_most_octets", "report_wrong"}}),
                               longest_case<2'000>({{"misses_within_a_frame", "reported_without_fault"}})};
  for (ManagerCase& one : beside_cases()) all.push_back(std::move(one));
  return all;
}

}  // namespace fieldproof::conformance
