#include "conformance/token_bus/dual_channel_words.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/dual_channel_scene.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "protocols/token_bus/dual_channel_settings.hpp"

namespace fieldproof::conformance {
namespace {

// Away from the limits of the skew and of a slot time, where one symbol decides.
constexpr std::array<std::int64_t, 4> kLates{0, 3, 40, 160};
constexpr unsigned kShortFrameSymbols = 120;
constexpr std::size_t kFrameEnd = 8;
constexpr std::int64_t kLastTrain = static_cast<std::int64_t>(TrainKind::too_long);
constexpr std::int64_t kLastLimit = static_cast<std::int64_t>(ManagerLimit::bad_signal);

// ---- the vocabulary ----

const SequenceNumber kOnChannel{"channel", 0, 1, 0};
const SequenceNumber kOfContent{"content", 0, 255, 0x42};

std::vector<SequenceWord> first_words_of_a_manager() {
  const SequenceNumber late{"late", 0, 160, 0, kLates, true};
  return {{.word = "both",
           .meaning = "both channels carry a frame, the named one so many symbols later",
           .numbers = {kOnChannel, late, kOfContent},
           .units = kShortFrameSymbols,
           .weight = 8},
          {.word = "alone",
           .meaning = "one channel carries a frame",
           .numbers = {kOnChannel, kOfContent},
           .units = kShortFrameSymbols,
           .weight = 4},
          {.word = "differ",
           .meaning = "the channels carry different frames, the named one so many symbols later",
           .numbers = {kOnChannel, late, kOfContent},
           .units = kShortFrameSymbols,
           .weight = 6},
          {.word = "wrong",
           .meaning = "both channels carry a frame, the named one with a wrong check",
           .numbers = {kOnChannel, kOfContent},
           .weight = 8},
          {.word = "collide",
           .meaning = "both channels carry a frame, with bad_signal in the same place",
           .numbers = {{"symbol", 44, 100, 60}, kOfContent},
           .weight = 4},
          {.word = "train",
           .meaning = "both channels carry two frames, the first with I = 1",
           .numbers = {kOnChannel, kOfContent},
           .units = 2 * kShortFrameSymbols,
           .weight = 3},
          {.word = "noise",
           .meaning = "a channel carries so many symbols without a start delimiter",
           .numbers = {kOnChannel, {"symbols", 1, 200, 20}},
           .units = 20,
           .weight = 2},
          {.word = "request", .meaning = "the MAC requests a frame", .numbers = {kOfContent}, .weight = 3},
          {.word = "command",
           .meaning = "the MAC gives a command: RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER, none, data",
           .numbers = {{"which", 0, 4, 0}},
           .weight = 1},
          {.word = "answer",
           .meaning = "A answers, or B, or both and B the next one: IDLE, ACK, NACK, physical error",
           .numbers = {{"who", 0, 2, 2}, {"which", 0, 3, 1}},
           .weight = 1},
          {.word = "wait", .meaning = "silence of so many slot times", .numbers = {{"slots", 1, 9, 1}}},
          {.word = "power", .meaning = "the supply is switched off and on", .is_loss = true}};
}

std::vector<SequenceWord> later_words_of_a_manager() {
  const SequenceNumber here{"here", 0, kLastTrain, 0};
  const SequenceNumber there{"there", 0, kLastTrain, 0};
  return {
      {.word = "limit",
       .meaning = "a limit is met to the symbol, or missed by one: of the skew, of a copy, of a collision, "
                  "of bad_signal",
       .numbers = {kOnChannel, {"which", 0, kLastLimit, 0}, {"place", -1, 1, 0}},
       .weight = 3},
      {.word = "kinds",
       .meaning = "each channel carries a kind of two frames",
       .numbers = {kOnChannel, here, there},
       .weight = 3},
      {.word = "other_codes",
       .meaning = "both channels carry a frame, in which a circuit that is anything is the other one",
       .numbers = {kOnChannel, kOfContent},
       .weight = 1},
      {.word = "longest_request", .meaning = "the MAC requests the longest frame", .weight = 0},
      {.word = "seconds",
       .meaning = "silence of so many seconds",
       .numbers = {{"seconds", 1, 5, 5}},
       .weight = 0},
      {.word = "meanwhile",
       .meaning = "the MAC requests a frame while both channels carry another one",
       .numbers = {kOfContent},
       .weight = 2},
      {.word = "two_within",
       .meaning = "a channel carries two frames within a long one of the other, which is spoiled or not",
       .numbers = {kOnChannel, {"spoiled", 0, 1, 0}},
       .weight = 1},
      {.word = "stuck",
       .meaning = "a channel carries bad_signal for ever, or ones, the other one two frames; off and on",
       .numbers = {kOnChannel, {"ones", 0, 1, 0}},
       .weight = 0},
      {.word = "clock",
       .meaning = "a channel alone carries a frame of 1000 octets, its clock so many times 100 ppm away",
       .numbers = {kOnChannel, {"away", -1, 1, 1}},
       .weight = 0}};
}

std::vector<std::vector<NamedCommand>> states_of_a_manager() {
  return {
      {{"alone", {{"channel", 1}}}}, {{"wrong"}}, {{"noise"}}, {{"command"}}, {{"answer", {{"which", 2}}}},
      {{"differ"}, {"power"}}};
}

// ---- situations ----

NamedCommand kinds(std::int64_t channel, TrainKind here, TrainKind there) {
  return {"kinds",
          {{"channel", channel},
           {"here", static_cast<std::int64_t>(here)},
           {"there", static_cast<std::int64_t>(there)}}};
}

// Long enough for what is late, and short enough for many.
const field::Settings kShortFrames{{"slot_time_octets", 12}, {"most_octets", 64}};

field::Settings counting(std::int64_t errors, std::int64_t clean) {
  field::Settings settings = kShortFrames;
  settings.emplace_back("errors_in_a_row", errors);
  settings.emplace_back("clean_in_a_row", clean);
  return settings;
}

// An error, a pair of kinds, and an error again; and the same of clean ones after a fault.
void add_counts(std::vector<NamedSituation>& all) {
  constexpr std::array kKinds{TrainKind::right, TrainKind::check_wrong, TrainKind::e_bit,
                              TrainKind::too_long};
  const NamedCommand right = kinds(0, TrainKind::right, TrainKind::right);
  for (const TrainKind here : kKinds) {
    for (const TrainKind there : kKinds) {
      const std::int64_t channel = (static_cast<std::int64_t>(here) + static_cast<std::int64_t>(there)) % 2;
      const NamedCommand error = kinds(channel, TrainKind::check_wrong, TrainKind::right);
      const NamedCommand pair = kinds(channel, here, there);
      all.push_back({{error, pair, error}, {{"preamble_octets", counting(2, 16)}}});
      all.push_back({{right, {"alone", {{"channel", 1 - channel}}}, right, pair, right, right},
                     {{"preamble_octets", counting(16, 2)}}});
    }
  }
}

// One channel alone, then the other one, so often that each has had many faults.
std::vector<NamedCommand> in_turn(std::int64_t first) {
  constexpr std::int64_t kTimes = 19;
  std::vector<NamedCommand> commands;
  for (std::int64_t n = 0; n < kTimes; ++n) commands.push_back({"alone", {{"channel", (first + n) % 2}}});
  return commands;
}

std::vector<NamedSituation> situations_of_a_manager() {
  std::vector<NamedSituation> all;
  add_counts(all);
  const std::vector<ShownSetting> times{
      {"skew_symbols"}, {"slot_time_octets"}, {"delay_symbols"}, {"errors_in_a_row"}};
  for (const std::int64_t channel : {0, 1}) {
    for (std::int64_t which = 0; which <= kLastLimit; ++which) {
      std::vector<NamedCommand> commands{{"power"}};
      for (const std::int64_t place : {-1, 0, 1}) {
        commands.push_back({"limit", {{"channel", channel}, {"which", which}, {"place", place}}});
        commands.push_back({"power"});
      }
      all.push_back({commands, {{"slot_time_octets"}, {"skew_symbols"}}});
      all.push_back({commands});
    }
    all.push_back(
        {in_turn(channel), {{"preamble_octets", {{"errors_in_a_row", 16}, {"clean_in_a_row", 1}}}}});
    all.push_back({{{"two_within", {{"channel", channel}, {"spoiled", 1}}},
                    {"power"},
                    {"two_within", {{"channel", channel}}}},
                   {{"preamble_octets", {{"slot_time_octets", 12}}}}});
    for (const std::int64_t ones : {0, 1})
      all.push_back(
          {{{"stuck", {{"channel", channel}, {"ones", ones}}}}, {{"preamble_octets", kShortFrames}}});
    all.push_back({{{"seconds"}, {"alone", {{"channel", channel}}}}, times});
    all.push_back({{{"clock", {{"channel", channel}, {"away", 2 * channel - 1}}}}});
    all.push_back({{{"other_codes", {{"channel", channel}}}, {"meanwhile"}}, times});
  }
  all.push_back({{{"longest_request"}}});
  return all;
}

}  // namespace

SequenceVocabulary channel_manager_vocabulary() {
  const token_bus::ChannelManagerConfiguration as_made;
  // In the order of ManagerWord. Faults are of the channel that is named.
  SequenceVocabulary vocabulary{
      .words = first_words_of_a_manager(),
      .unit = "symbol",
      .levels_per_unit = 2,
      .settings = sequence_settings(token_bus::kChannelManagerTable, &as_made),
      .objection = objection_of(
          token_bus::kChannelManagerTable, as_made,
          +[](const token_bus::ChannelManagerConfiguration& one) { expect_whole_half_bits(one.rules); })};
  for (SequenceWord& word : later_words_of_a_manager()) vocabulary.words.push_back(std::move(word));
  return with_situations(with_beginnings(std::move(vocabulary), states_of_a_manager()),
                         situations_of_a_manager());
}

// ---- what is carried ----

std::string framed(std::int64_t content, bool more_follows, std::size_t octets) {
  constexpr std::size_t kData = 5;
  constexpr std::size_t kCheck = 4;
  const std::size_t count = std::max(octets, kData + kCheck) - kCheck;
  const std::vector<std::uint8_t> data(count, static_cast<std::uint8_t>(content));
  return frame_text(with_crc_32(data), more_follows);
}
std::string received_frame(std::int64_t content, bool more_follows, std::size_t octets) {
  return indicated_as(framed(content, more_follows, octets));
}

namespace {

std::string spoiled_at(std::string text, std::size_t at) {
  if (at < text.size()) text[at] = 'B';
  return text;
}
// A limit can be met exactly where a symbol lasts a whole number of nanoseconds.
std::int64_t exact_place(std::int64_t place, const token_bus::Rules& rules) {
  constexpr std::int64_t kTwoSeconds = 2'000'000'000;  // ns
  constexpr std::int64_t kAway = 2;
  if (kTwoSeconds % rules.phy_bit_rate == 0) return place;
  return place > 0 ? kAway : -kAway;
}

}  // namespace

BothChannels at_limit(ManagerLimit limit, std::int64_t place,
                      const token_bus::ChannelManagerConfiguration& configuration) {
  constexpr std::size_t kInOctets = kManagerHead + 10;
  constexpr std::size_t kOctetsAfterASlot = 8;
  const std::int64_t slot = 8 * std::int64_t{configuration.rules.slot_time_octets};
  const std::int64_t skew = configuration.channels.skew_symbols;
  place = exact_place(place, configuration.rules);
  const std::string frame = received_frame(0x42, false, token_bus::frame_octets(configuration.rules, 4));
  switch (limit) {
    case ManagerLimit::skew:
      return {{received_frame(0x24), std::max<std::int64_t>(skew + place, 0)}, {received_frame(0x42)}};
    case ManagerLimit::copy:
      return {{frame, slot + place}, {frame}};
    case ManagerLimit::collision:
      return {
          {spoiled_at(frame, kInOctets)},
          {spoiled_at(frame, kInOctets + static_cast<std::size_t>(std::max<std::int64_t>(skew + place, 0)))}};
    case ManagerLimit::bad_signal: {
      const std::string long_one =
          received_frame(0x42, false, configuration.rules.slot_time_octets + 2 * kOctetsAfterASlot);
      // It counts when it is complete.
      return {{spoiled_at(long_one, kManagerHead + static_cast<std::size_t>(slot + place) - 1)}, {long_one}};
    }
  }
  return {};
}

std::string train_of(TrainKind kind, const token_bus::ChannelManagerConfiguration& configuration) {
  constexpr std::size_t kLongest = 300;  // longer ones last too long
  const std::string first = received_frame(0x42, true);
  const std::string last = received_frame(0x24);
  const std::size_t most = configuration.rules.most_octets;
  switch (kind) {
    case TrainKind::longest:
      return first + received_frame(0x24, false, std::min(most, kLongest));
    case TrainKind::first_octet_wrong:
      return first + flipped_at(last, kManagerHead);
    case TrainKind::check_wrong:
      return first + flipped_at(last, last.size() - kFrameEnd - 1);
    case TrainKind::first_check_wrong:
      return flipped_at(first, first.size() - kFrameEnd - 1) + last;
    case TrainKind::first_endless:
      return first.substr(0, first.size() - kFrameEnd) + std::string(kFrameEnd, '0') + last;
    case TrainKind::cut:
      return first + last.substr(0, last.size() - kFrameEnd);
    case TrainKind::e_bit:
      return flipped_at(first + last, first.size() + last.size() - 1);
    case TrainKind::too_long:
      return first + (most < kLongest ? received_frame(0x24, false, most + 1) : last);
    default:
      return first + last;
  }
}

// Silence has its usual code: whether another one is driven on is the manager's choice.
std::string with_other_codes(std::string text) {
  constexpr std::array<std::pair<char, char>, 2> kOther{{{'N', 'm'}, {'B', 'b'}}};
  for (const auto& [usual, other] : kOther) std::ranges::replace(text, usual, other);
  return text;
}

// It is spoiled later than a slot time, or has bad_signal in its preamble.
BothChannels two_within_one(bool is_spoiled, const token_bus::ChannelManagerConfiguration& configuration) {
  const std::string two = received_frame(0x42) + std::string(20, 'S') + received_frame(0x24);
  const std::string long_one = received_frame(0x18, false, two.size() / 8 + kFrameEnd);
  const std::size_t later = kManagerHead + 8 * std::size_t{configuration.rules.slot_time_octets} + 20;
  return {{two}, {spoiled_at(long_one, is_spoiled ? later : 4)}};
}

// Twenty symbols after the first transmission, or later than the longest frame, the other one carries a
// second one.
BothChannels beside_what_is_stuck(bool is_for_long,
                                  const token_bus::ChannelManagerConfiguration& configuration) {
  constexpr std::size_t kMost = 300;
  const std::string first = received_frame(0x42);
  const std::size_t longest = 8 * (std::min<std::size_t>(configuration.rules.most_octets, kMost) + 20);
  const std::size_t silence = is_for_long ? longest - first.size() : 20;
  std::string stuck = first.substr(0, 60);
  stuck.resize(first.size() + silence + 200, is_for_long ? '1' : 'B');
  return {{stuck}, {first + std::string(silence, 'S') + received_frame(0x24)}};
}

}  // namespace fieldproof::conformance
