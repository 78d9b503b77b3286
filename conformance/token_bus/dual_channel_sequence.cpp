#include "conformance/token_bus/dual_channel_sequence.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "conformance/sequence_settings.hpp"
#include "conformance/token_bus/driven_frames.hpp"
#include "conformance/token_bus/dual_channel_cases.hpp"
#include "conformance/token_bus/judgeable_rules.hpp"
#include "conformance/token_bus/sides_sequence.hpp"
#include "protocols/token_bus/dual_channel.hpp"
#include "protocols/token_bus/dual_channel_settings.hpp"

namespace fieldproof::conformance {
namespace {

// Away from the limits of the skew and of a slot time, where one symbol decides.
constexpr std::array<std::int64_t, 4> kLates{0, 3, 40, 160};
constexpr unsigned kShortFrameSymbols = 120;

enum class ManagerWord : std::uint8_t {
  both,
  alone,
  differ,
  wrong,
  collide,
  train,
  noise,
  request,
  command,
  answer,
  wait,
  power
};

std::vector<std::vector<NamedCommand>> states_of_a_manager() {
  return {
      {{"alone", {{"channel", 1}}}}, {{"wrong"}}, {{"noise"}}, {{"command"}}, {{"answer", {{"which", 2}}}},
      {{"differ"}, {"power"}}};
}

SequenceVocabulary channel_manager_vocabulary() {
  const token_bus::ChannelManagerConfiguration as_made;
  const SequenceNumber on{"channel", 0, 1, 0};
  const SequenceNumber late{"late", 0, 160, 0, kLates, true};
  const SequenceNumber content{"content", 0, 255, 0x42};
  // In the order of ManagerWord. Faults are of the channel that is named.
  return {
      .words = {{.word = "both",
                 .meaning = "both channels carry a frame, the named one so many symbols later",
                 .numbers = {on, late, content},
                 .units = kShortFrameSymbols,
                 .weight = 8},
                {.word = "alone",
                 .meaning = "one channel carries a frame",
                 .numbers = {on, content},
                 .units = kShortFrameSymbols,
                 .weight = 4},
                {.word = "differ",
                 .meaning = "the channels carry different frames, the named one so many symbols later",
                 .numbers = {on, late, content},
                 .units = kShortFrameSymbols,
                 .weight = 6},
                {.word = "wrong",
                 .meaning = "both channels carry a frame, the named one with a wrong check",
                 .numbers = {on, content},
                 .weight = 8},
                {.word = "collide",
                 .meaning = "both channels carry a frame, with bad_signal in the same place",
                 .numbers = {{"symbol", 44, 100, 60}, content},
                 .weight = 4},
                {.word = "train",
                 .meaning = "both channels carry two frames, the first with I = 1",
                 .numbers = {on, content},
                 .units = 2 * kShortFrameSymbols,
                 .weight = 3},
                {.word = "noise",
                 .meaning = "a channel carries so many symbols without a start delimiter",
                 .numbers = {on, {"symbols", 1, 200, 20}},
                 .units = 20,
                 .weight = 2},
                {.word = "request", .meaning = "the MAC requests a frame", .numbers = {content}, .weight = 3},
                {.word = "command",
                 .meaning =
                     "the MAC gives a command: RESET, DISABLE LOOPBACK, ENABLE TRANSMITTER, none, data",
                 .numbers = {{"which", 0, 4, 0}},
                 .weight = 1},
                {.word = "answer",
                 .meaning = "A answers, or B, or both and B the next one: IDLE, ACK, NACK, physical error",
                 .numbers = {{"who", 0, 2, 2}, {"which", 0, 3, 1}},
                 .weight = 1},
                {.word = "wait", .meaning = "silence of so many slot times", .numbers = {{"slots", 1, 9, 1}}},
                {.word = "power", .meaning = "the supply is switched off and on", .is_loss = true}},
      .unit = "symbol",
      .levels_per_unit = 2,
      .settings = sequence_settings(token_bus::kChannelManagerTable, &as_made),
      .objection = objection_of(
          token_bus::kChannelManagerTable, as_made,
          +[](const token_bus::ChannelManagerConfiguration& one) { expect_whole_half_bits(one.rules); })};
}

std::string framed(std::int64_t content, bool more_follows = false) {
  constexpr std::size_t kData = 5;
  const std::vector<std::uint8_t> octets(kData, static_cast<std::uint8_t>(content));
  return frame_text(with_crc_32(octets), more_follows);
}
std::string received_frame(std::int64_t content, bool more_follows = false) {
  return indicated_as(framed(content, more_follows));
}

class ManagerSequenceRun {
 public:
  ManagerSequenceRun(ManagerBench& bench, CaseJudge& judge)
      : bench_(bench),
        judge_(judge),
        twin_(reference_bench<ManagerBench, ManagerNeeds, ManagerSetting, token_bus::ChannelManager>(
            bench.configuration(), token_bus::kChannelManagerTable)) {}

  void run(const Sequence& sequence) {
    for (const SequenceCommand& command : sequence.commands) {
      for (ManagerBench* one : {&bench_, &twin_}) {
        one->clear();
        execute(command, *one);
        one->settle();
      }
      compare();
    }
  }

 private:
  static void carry(ManagerBench& bench, std::int64_t channel, const ChannelText& named,
                    const ChannelText& other) {
    channel == 0 ? bench.carry(named, other) : bench.carry(other, named);
  }

  static void execute(const SequenceCommand& command, ManagerBench& bench) {
    const auto& numbers = command.numbers;
    const auto faulty = [&](const std::string& text) { return with_faults(text, command.faults, 'B', 'S'); };
    switch (static_cast<ManagerWord>(command.word)) {
      case ManagerWord::both:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[2])), numbers[1]},
                     {received_frame(numbers[2])});
      case ManagerWord::alone:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[1]))}, {});
      case ManagerWord::differ:
        return carry(bench, numbers[0], {faulty(received_frame(numbers[2])), numbers[1]},
                     {received_frame(numbers[2] ^ 0xFF)});
      case ManagerWord::wrong: {
        std::string wrong = received_frame(numbers[1]);
        char& one = wrong.at(wrong.size() - end_delimiter_text().size() - 1);
        one = one == '1' ? '0' : '1';
        return carry(bench, numbers[0], {wrong}, {received_frame(numbers[1])});
      }
      case ManagerWord::collide: {
        std::string collided = received_frame(numbers[1]);
        collided.replace(static_cast<std::size_t>(numbers[0]), 8, 8, 'B');
        return bench.carry({collided}, {collided});
      }
      case ManagerWord::train: {
        const std::string two = received_frame(numbers[1], true) + received_frame(numbers[1]);
        return carry(bench, numbers[0], {faulty(two)}, {two});
      }
      case ManagerWord::noise:
        return carry(bench, numbers[0], {faulty(std::string(static_cast<std::size_t>(numbers[1]), '1'))}, {});
      case ManagerWord::request:
        return bench.request(framed(numbers[0]));
      case ManagerWord::command:
        return bench.command(static_cast<SideCommand>(numbers[0]), 16);
      case ManagerWord::answer: {
        const auto answers = [](std::int64_t which) { return std::string(16, "iane"[which % 4]); };
        return bench.carry({numbers[0] == 1 ? "" : answers(numbers[1])},
                           {numbers[0] == 0 ? "" : answers(numbers[1] + (numbers[0] == 2 ? 1 : 0))});
      }
      case ManagerWord::wait:
        return bench.wait(numbers[0] * bench.slot());
      case ManagerWord::power:
        bench.set_power(false);
        bench.wait(bench.slot());
        bench.set_power(true);
    }
  }

  void compare() {
    for (const Channel channel : token_bus::kChannels) {
      compare_sides(fmt::format("requested of {}", text_of(channel)), bench_.requested(channel),
                    twin_.requested(channel), "request_other", judge_);
    }
    compare_sides("indicated", bench_.indicated(), twin_.indicated(), "indication_other", judge_);
    judge_.expect(bench_.events() == twin_.events(), "report_other",
                  fmt::format("reported: {}", fmt::join(twin_.events(), ", ")),
                  fmt::format("reported: {}", fmt::join(bench_.events(), ", ")));
  }

  ManagerBench& bench_;
  CaseJudge& judge_;
  ManagerBench twin_;
};

}  // namespace

const SequenceRole& channel_manager_sequence_role() {
  static const SequenceRole role{
      {.id = "token_bus/channel_manager/check/follows_the_reference",
       .purpose = "check",
       .requirement = "Whatever two channels carry in whatever order, the MAC is given, the channels are "
                      "requested and faults are reported as the rules of the manager say.",
       .reference = token_sources::own("choice between two channels"),
       .details = {},
       .stimulus = "Commands at random, with symbols that are spoiled or missing.",
       .expected = "What a reference does on a bench of its own.",
       .tags = {},
       .catches = {}},
      with_beginnings(channel_manager_vocabulary(), states_of_a_manager()),
      // Of spoilt symbols the page leaves open what is right: for `check` only.
      {{DerivedKind::values, {"watches_the_preferred_alone", "report_other"}},
       {DerivedKind::words, {"sends_on_a_alone", "request_other"}},
       {DerivedKind::states, {"takes_the_first", "indication_other"}},
       {DerivedKind::repetitions, {"zero_and_one_exchanged_on_b", "request_other"}},
       {DerivedKind::settings, {"sends_on_the_preferred_alone", "request_other"}},
       {DerivedKind::drawn, {"sends_on_a_alone", "request_other"}}}};
  return role;
}

void run_channel_manager_sequence(const Sequence& sequence, ManagerBench& bench, CaseJudge& judge) {
  ManagerSequenceRun(bench, judge).run(sequence);
}

}  // namespace fieldproof::conformance
