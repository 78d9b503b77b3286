#include <fmt/format.h>

#include <array>

#include "conformance/token_bus/translator_scene.hpp"

// Commands of every length and in every order, directly after each other and in the middle of what is
// received.
namespace fieldproof::conformance {
namespace {

using namespace translator_chart;
using token_sources::memory;
using token_sources::own;
using token_sources::paper;

constexpr std::string_view kCommandLetters = "rltid";

// The table of answers, without a jabber.
std::string answers_of(const std::string& script) {
  std::string answers;
  for (const char one : script) answers += one == 'i' ? 'i' : one == 'd' ? 'n' : one == 'S' ? 'S' : 'a';
  return answers;
}

// Idle in front of the first answer says that it is still to come.
void expect_answers(TranslatorScene& scene, std::string_view reason) {
  const std::string right = without_end(answers_of(scene.requested), 'S');
  std::string seen = scene.indicated();
  const std::size_t early = seen.find_first_not_of('i');
  if (right.front() != 'i' && early != std::string::npos) seen.erase(0, early);
  scene.judge.expect(seen == right, reason, [&] { return difference(right, seen); });
  const std::string& text = scene.bench.indicated().text();
  const kernel::Duration took = scene.bench.indicated().time_of(text.find(right.front())) - scene.begin;
  const kernel::Duration most = scene.bench.symbols(scene.bench.configuration().answer_symbols);
  scene.judge.expect(took <= most + kernel::kNanosecond, "answers_too_late", [&] {
    return Mismatch{{fmt::format("the answer at most {} after its command", kernel::describe(most))},
                    kernel::describe(took)};
  });
}

TranslatorStep is_answered(std::string stimulus, std::function<std::string(TranslatorScene&)> script) {
  return {std::move(stimulus), "the right answer to each, as long as it stands, and in time",
          [script = std::move(script)](TranslatorScene& scene) {
            scene.exchange(script(scene) + "SSSS");
            scene.bench.wait(scene.bench.symbols(scene.bench.configuration().answer_symbols));
            expect_answers(scene, "answer_wrong");
          }};
}

std::string command_of_length(TranslatorScene& scene) {
  constexpr std::array<std::size_t, 10> kLengths{1, 2, 3, 4, 5, 16, 28, 33, 64, 300};
  return std::string(kLengths.at(scene.round / kCommandLetters.size() % kLengths.size()),
                     kCommandLetters[scene.round % kCommandLetters.size()]);
}
constexpr unsigned kLengthRounds = 50;

// Without END PHYSICAL between them, each of one to four symbols.
std::string commands_in_a_row(TranslatorScene& scene) {
  std::string script;
  for (unsigned n = 0; n < 20; ++n)
    script +=
        std::string(1 + scene.bench.random_octet() % 4, kCommandLetters[scene.bench.random_octet() % 5]);
  return script;
}

// ---- what each does, in any order ----

struct Switches {
  bool is_looped_back = true;
  bool is_transmitter_on = false;
};
// The table of commands.
Switches after(const std::string& script) {
  Switches state;
  for (const char one : script) {
    if (one == 'r') state = {};
    if (one == 'l') state.is_looped_back = false;
    if (one == 't') state.is_transmitter_on = true;
  }
  return state;
}

// Each three commands, by the round, of one symbol each.
std::string three_commands(unsigned round) {
  std::string script;
  for (unsigned n = 0; n < 3; ++n, round /= 5) script += kCommandLetters[round % 5];
  return script;
}
constexpr unsigned kThreeCommands = 125;

const std::string& asked() {
  static const std::string text = "PPPPPPPPPPPPPPPP" + start_delimiter_text() + "0110";
  return text;
}
const std::string& carried() {
  static const std::string text = "PPPPPPPPPPPPPPPP" + start_delimiter_text() + "1001";
  return text;
}

// Something is requested directly after them, and something else comes from the line.
void expect_switches(TranslatorScene& scene, const std::string& script) {
  const Switches right = after(script);
  // Answers are over when it comes from the line.
  const std::string silence(scene.bench.configuration().answer_symbols, 'S');
  scene.exchange(script + asked() + silence + asked(),
                 side_bits_of(std::string(2 * (script.size() + asked().size() + silence.size()), 'I') +
                              encoded(carried())));
  const std::string said = fmt::format("the commands {} after power-up", script);
  const std::string source = right.is_looped_back ? asked() : carried();
  const std::string symbols = indicated_as(source).substr(source.find('N'));
  const std::string seen = scene.indicated();
  scene.judge.expect(seen.ends_with(symbols), "switched_wrong", [&] {
    return Mismatch{{fmt::format("{}: {}", said, symbols)},
                    seen.substr(seen.size() - std::min<std::size_t>(seen.size(), 60))};
  });
  // Whether loopback also sends is left open.
  if (right.is_looped_back && right.is_transmitter_on) return;
  const std::string bits = right.is_transmitter_on ? encoded(asked() + silence + asked()) : std::string();
  const std::string sent = scene.sent();
  scene.judge.expect(sent == bits, "switched_wrong", [&] {
    Mismatch made = difference(bits, sent);
    made.expected.front() = said + ": " + made.expected.front();
    return made;
  });
}

void switch_after_power_up(TranslatorScene& scene) {
  scene.bench.set_power(false);
  scene.bench.wait(scene.bench.symbols(20));
  scene.bench.set_power(true);
  scene.bench.wait(scene.bench.symbols(20));
  expect_switches(scene, three_commands(scene.round));
}

// From on line, RESET of one to four symbols: whatever was requested or received before it.
void reset_shortly(TranslatorScene& scene) {
  scene.exchange("rrrrllllttttSSSS");
  scene.rest();
  const std::string reset(1 + scene.round % 4, 'r');
  const std::string before = scene.round % 2 == 0 ? "PPPPN" : "SSSSS";
  const std::string script = std::string(20, 'S') + before + reset + "SS" + asked();
  const SideBits bits =
      side_bits_of(std::string(scene.round / 4 % 2, 'I') + encoded(carried() + std::string(64, '0')));
  scene.exchange(script, bits);
  // What is still to go out by then may be cut off.
  const std::string sent = scene.sent();
  scene.judge.expect(encoded(without_ends(before, 'S')).starts_with(sent), "sends_after_reset",
                     "nothing from RESET on", sent);
  const std::string right = indicated_as(asked()).substr(asked().find('N'));
  const std::string seen = scene.indicated();
  scene.judge.expect(seen.ends_with("1111" + right), "switched_wrong", right, seen);
}

// ---- a command while something is received ----

void receive_around_command(TranslatorScene& scene) {
  constexpr std::size_t kBefore = 24;
  const std::size_t length = 1 + scene.round / 4 % 3;
  const std::string tail =
      scene.round % 2 == 0 ? std::string(300, '0') : carried().substr(16) + std::string(300, '1');
  const std::string text = carried() + "01" + std::string(16, '0') + tail;
  scene.exchange(
      std::string(carried().size() + kBefore - 8, 'S') + std::string(length, "idtl"[scene.round % 4]),
      side_bits_of(std::string(scene.round / 12 % 2, 'I') + encoded(text)));
  const std::string seen = scene.content();
  const std::string right = text.substr(text.find('N'));
  const auto untouched = static_cast<std::size_t>(scene.bench.configuration().answer_symbols) + 40;
  if (untouched + 16 > right.size()) return;
  scene.judge.expect(seen.starts_with(right.substr(0, 12)) && seen.ends_with(right.substr(untouched)),
                     "line_lost", [&] { return difference(right, seen); });
}

// What decides lies within a command: the start delimiter that locks the phase, the last end delimiter, and
// the silence in front of a frame in the other phase.
// An answer may come late, and hides what it stands for: what must be indicated comes after that.
void lock_within_command(TranslatorScene& scene) {
  const std::string after = std::string(scene.bench.configuration().answer_symbols + std::size_t{90}, '0') +
                            "01101001" + std::string(40, '1');
  scene.exchange(std::string(24, 'i'), side_bits_of(encoded("PPPPPPPP" + start_delimiter_text() + after)));
  const std::string right = after.substr(scene.bench.configuration().answer_symbols + std::size_t{24});
  const std::string seen = scene.indicated();
  scene.judge.expect(seen.ends_with(right), "lock_lost", [&] { return difference(right, seen); });
}
void end_within_command(TranslatorScene& scene) {
  constexpr std::size_t kSure = 40;
  const std::size_t ones = scene.bench.configuration().answer_symbols + std::size_t{90};
  const std::string frame = frame_text(scene.octets);
  scene.exchange(std::string(frame.size() - 4, 'S') + "iiii",
                 side_bits_of(encoded(frame + std::string(ones, '1'))));
  const std::string seen = scene.indicated();
  const std::size_t shown = seen.size() - 1 - std::min(seen.find_last_not_of('1'), seen.size() - 1);
  const std::size_t right = ones - scene.bench.configuration().rules.blanking_symbols;
  scene.judge.expect(shown >= kSure && shown <= right + 2, "end_missed",
                     fmt::format("{} to {} ones after the blanking", kSure, right), fmt::format("{}", shown));
}
void fall_silent_within_command(TranslatorScene& scene) {
  constexpr std::size_t kSilence = 8;
  const std::string fragment = "PPPPPPPP" + start_delimiter_text() + "0101";
  const std::string frame = frame_text(scene.octets);
  SideBits bits = side_bits_of(encoded(fragment));
  bits.insert(bits.end(), 2 * kSilence + 1, SideBit{'I', false, false});
  const SideBits later =
      side_bits_of(encoded(std::string(scene.bench.configuration().answer_symbols, 'P') + frame));
  bits.insert(bits.end(), later.begin(), later.end());
  scene.exchange(std::string(fragment.size() - 2, 'S') + std::string(kSilence + 4, 'i'), bits);
  const std::string right = frame.substr(frame.find('N'));
  const std::string seen = scene.indicated();
  scene.judge.expect(seen.ends_with(right), "frame_not_found", [&] { return difference(right, seen); });
}
void receive_through_command(TranslatorScene& scene) {
  scene.rest();
  lock_within_command(scene);
  scene.rest();
  end_within_command(scene);
  scene.rest();
  fall_silent_within_command(scene);
}

}  // namespace

std::vector<TranslatorCase> translator_command_cases() {
  return {
      on_chart(
          translator_must("management/an_answer_is_as_long_as_its_command", "PST-13",
                          "A command of one symbol is one. Its answer stands as long as the command, within "
                          "answer_symbols of its begin; so do those of commands directly after each other.",
                          memory("answers of the management mode"),
                          {{"answer_of_one_symbol", "answer_wrong"},
                           {"answer_of_28_symbols_at_most", "answer_wrong"},
                           {"command_of_two_symbols_at_least", "answer_wrong"},
                           {"first_command_stands", "answer_wrong"},
                           {"answer_with_symbol_0_off", "answer_wrong"},
                           {"answers_too_late", "answers_too_late"}},
                          {{own("how long an answer stands"), {"answer_wrong", "answers_too_late"}}}),
          {{kLengthRounds, kLengthRounds},
           {is_answered("a command of 1 to 300 symbols", command_of_length),
            is_answered("20 commands of one to four symbols", commands_in_a_row)}}),
      on_chart(translator_must(
                   "management/each_order_of_commands", "PST-13",
                   "After power-up, without RESET, and after each three commands of one symbol, loopback "
                   "and transmitter are as the table of the commands says; so they are for what is "
                   "requested directly after them.",
                   own("what the commands do"),
                   {{"serial_data_resets", "switched_wrong"},
                    {"enable_toggles", "switched_wrong"},
                    {"disable_toggles", "switched_wrong"},
                    {"enable_disables_loopback", "switched_wrong"},
                    {"on_the_line_at_power_up", "switched_wrong"},
                    {"first_symbol_after_a_command_lost", "switched_wrong"},
                    {"commands_are_sent", "switched_wrong"},
                    {"remembers_over_power_failure", "switched_wrong"}}),
               {{kThreeCommands, kThreeCommands},
                {{"power-up, and each three commands; the same is requested directly after them, and when "
                  "something else comes from the line",
                  "what is indicated and sent as the table says", switch_after_power_up}}}),
      on_chart(
          translator_must(
              "management/a_short_reset_is_one", "PST-13",
              "RESET of one symbol ends what goes out and what is received: from it on nothing goes out, and "
              "what is requested is indicated, symbol by symbol.",
              own("what the commands do"), {{"reset_after_eight_symbols", "sends_after_reset"}}),
          {{8, 40},
           {{"RESET of one to four symbols while something is requested or received, and another request",
             "it is indicated, and nothing is sent", reset_shortly},
            pause()},
           {on_line()}}),
      on_chart(
          translator_must(
              "management/the_line_is_followed_meanwhile", "PST-14",
              "A command other than RESET costs what is received no more than the symbols in whose place its "
              "answer stands: phase and lock are kept.",
              paper("INMUX: indications of the mode"), {{"command_loses_the_phase", "line_lost"}}),
          {{24, 48},
           {{"a frame, in which a command of one to three symbols is given", "its begin and its rest",
             receive_around_command},
            pause()},
           {on_line()}}),
      on_chart(
          translator_must("management/what_decides_lies_within_a_command", "PST-14",
                          "In management mode no symbol is indicated, and the receiver works on: a start "
                          "delimiter holds the phase, a last end delimiter begins the blanking, and a "
                          "silence ends what was before.",
                          own("what is received is followed all the same"),
                          {{"deaf_in_management_mode", "lock_lost"}}),
          {{2, 20},
           {{"a command over a start delimiter, over an end delimiter, and over a silence",
             "the right symbols after it", receive_through_command},
            pause()},
           {on_line()}}),
  };
}

}  // namespace fieldproof::conformance
