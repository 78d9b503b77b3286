#include "conformance/token_bus/translator_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "harness/kernel/check.hpp"

namespace fieldproof::conformance {
namespace {

constexpr std::size_t kUnit = 4;  // levels

struct Code {
  char letter;
  std::string_view circuits;  // SM*, symbol 2, symbol 1, symbol 0
};

// The last circuit of some codes is anything.
constexpr std::array<Code, 8> kRequests{{{'S', "1111"},
                                         {'s', "1110"},
                                         {'P', "1010"},
                                         {'p', "1011"},
                                         {'0', "1000"},
                                         {'1', "1001"},
                                         {'N', "1100"},
                                         {'n', "1101"}}};
constexpr std::array<Code, 12> kIndications{{{'0', "1000"},
                                             {'1', "1001"},
                                             {'B', "1010"},
                                             {'B', "1011"},
                                             {'N', "1100"},
                                             {'N', "1101"},
                                             {'S', "1110"},
                                             {'S', "1111"},
                                             {'i', "0001"},
                                             {'a', "0011"},
                                             {'n', "0101"},
                                             {'e', "0111"}}};

// The same symbols as a tester may drive them, the circuit that is anything the other way round.
constexpr std::array<Code, 3> kOtherIndications{{{'b', "1011"}, {'m', "1101"}, {'s', "1110"}}};

struct CommandCode {
  std::string_view text;
  char letter;
  std::string_view circuits;
};
constexpr std::array<CommandCode, 5> kCommands{{{"RESET", 'r', "0111"},
                                                {"DISABLE LOOPBACK", 'l', "0101"},
                                                {"ENABLE TRANSMITTER", 't', "0011"},
                                                {"SM idle", 'i', "0001"},
                                                {"serial SM data", 'd', "0000"}}};

char indication_of(std::string_view circuits) {
  const auto* const code = std::ranges::find(kIndications, circuits, &Code::circuits);
  return code == kIndications.end() ? '?' : code->letter;
}

char request_of(std::string_view circuits) {
  for (const CommandCode& one : kCommands)
    if (one.circuits == circuits) return one.letter;
  if (circuits.front() == '0') return '?';
  const char letter = indication_of(circuits);
  return letter == 'B' ? 'P' : letter;
}

// Transmitter off, no error, and the halves of a Manchester bit; what is no bit is shown as such.
char phy_letter_of(std::string_view levels) {
  if (levels == "1111") return 'I';
  if (levels == "0101") return '1';
  return levels == "0110" ? '0' : '?';
}

}  // namespace

// ---- what testers drive ----

SideBits side_bits_of(std::string_view text) {
  SideBits bits;
  for (const char letter : text) bits.push_back({letter, true, false});
  return bits;
}

line::Levels phy_levels_of(const SideBits& bits) {
  std::string text;
  for (const SideBit& bit : bits) {
    text += bit.has_carrier ? '0' : '1';
    text += bit.has_error ? '0' : '1';
    text += bit.symbol == 'I' ? "11" : bit.symbol == '1' ? "01" : "10";
  }
  return line::Levels::of_text(text);
}

std::string_view text_of(SideCommand command) {
  return kCommands.at(static_cast<std::size_t>(command)).text;
}

line::Levels request_levels_of(std::string_view symbols) {
  std::string text;
  for (const char letter : symbols) {
    const auto* const command = std::ranges::find(kCommands, letter, &CommandCode::letter);
    const auto* const code = std::ranges::find(kRequests, letter, &Code::letter);
    FIELDPROOF_CHECK(command != kCommands.end() || code != kRequests.end(), "each letter can be requested");
    text += command != kCommands.end() ? command->circuits : code->circuits;
  }
  return line::Levels::of_text(text);
}

line::Levels request_levels_of(SideCommand command, std::size_t symbols) {
  std::string text;
  for (std::size_t n = 0; n < symbols; ++n) text += kCommands.at(static_cast<std::size_t>(command)).circuits;
  return line::Levels::of_text(text);
}

char letter_of(SideCommand command) {
  return kCommands.at(static_cast<std::size_t>(command)).letter;
}

line::Levels indication_levels_of(std::string_view symbols) {
  std::string text;
  for (const char letter : symbols) {
    const auto* const code = std::ranges::find(kIndications, letter, &Code::letter);
    const auto* const other = std::ranges::find(kOtherIndications, letter, &Code::letter);
    FIELDPROOF_CHECK(code != kIndications.end() || other != kOtherIndications.end(),
                     "each letter can be indicated");
    text += code != kIndications.end() ? code->circuits : other->circuits;
  }
  return line::Levels::of_text(text);
}

// ---- what follows from the tables of the paper ----

std::string encoded(std::string_view symbols) {
  std::string bits;
  bool is_second = false;
  for (const char letter : symbols) {
    if (letter == 'N' || letter == 'n') {
      bits += is_second ? "00" : "11";
      is_second = !is_second;
      continue;
    }
    is_second = false;
    const bool is_one = letter == '1' || letter == 'P' || letter == 'p';
    bits += letter == 'B' ? "00" : letter == '0' ? "01" : is_one ? "10" : "II";
  }
  return bits;
}

std::string start_delimiter_text() {
  return "NN0NN000";
}
std::string end_delimiter_text(bool more_follows) {
  return more_follows ? "NN1NN110" : "NN1NN100";
}

std::string data_text(const std::vector<std::uint8_t>& octets) {
  std::string text;
  for (const std::uint8_t octet : octets)
    for (unsigned bit = 0; bit < 8; ++bit) text += (octet >> bit & 1) != 0 ? '1' : '0';
  return text;
}

std::string frame_text(const std::vector<std::uint8_t>& octets, bool more_follows, unsigned preamble_octets) {
  return std::string(std::size_t{8} * preamble_octets, 'P') + start_delimiter_text() + data_text(octets) +
         end_delimiter_text(more_follows);
}

std::string indicated_as(std::string requested) {
  std::ranges::replace(requested, 'P', '1');
  return requested;
}

// ---- what the translator drives ----

void SideLog::on_wave(const line::Waveform& wave) {
  const std::string levels = wave.levels.text();
  const kernel::Duration unit = kernel::levels_duration(1, unit_rate_);
  constexpr std::int64_t kPartsOfTolerance = 1'000;
  const std::int64_t right_rate = static_cast<std::int64_t>(kUnit) * unit_rate_;
  const bool is_clocked = std::abs(wave.rate - right_rate) <= right_rate / kPartsOfTolerance;
  if (text_.empty()) begin_ = end_ = wave.start;
  for (; end_ + unit * 3 / 4 < wave.start; end_ += unit) {
    text_ += idle();
    times_.push_back(end_);
  }
  for (std::size_t n = 0; n < levels.size(); n += kUnit) {
    std::string circuits = levels.substr(n, kUnit);
    circuits.resize(kUnit, '1');
    text_ += !is_clocked          ? '?'
             : side_ == Side::phy ? phy_letter_of(circuits)
             : side_ == Side::mac ? indication_of(circuits)
                                  : request_of(circuits);
    times_.push_back(wave.time_of(n));
  }
  end_ = wave.end();
}

void SideLog::clear() {
  if (!text_.empty()) cleared_ = std::exchange(text_, {});
  times_.clear();
  begin_ = end_ = kernel::kNever;
}

bool SideLog::was_driven(kernel::Time from, kernel::Time until) const {
  const auto first = std::ranges::lower_bound(times_, from - kernel::kNanosecond);
  for (auto at = first; at != times_.end() && *at < until - kernel::kNanosecond; ++at)
    if (text_.at(static_cast<std::size_t>(at - times_.begin())) != idle()) return true;
  return false;
}

// ---- two texts ----

std::string flipped_at(std::string text, std::size_t at) {
  text.at(at) = text.at(at) == '0' ? '1' : '0';
  return text;
}

std::string without_end(std::string text, char idle) {
  while (text.ends_with(idle)) text.pop_back();
  return text;
}

std::string without_ends(std::string text, char idle) {
  text = without_end(std::move(text), idle);
  return text.substr(std::min(text.find_first_not_of(idle), text.size()));
}

Mismatch difference(const std::string& right, const std::string& seen) {
  const auto [at_right, at_seen] = std::ranges::mismatch(right, seen);
  const auto at = static_cast<std::size_t>(at_right - right.begin());
  constexpr std::size_t kMostUnits = 60;
  const std::size_t first = at - std::min<std::size_t>(at, 8);
  const auto part = [&](const std::string& text) {
    return fmt::format("from {} on: {}", first,
                       first < text.size() ? text.substr(first, kMostUnits) : "nothing");
  };
  Mismatch made{{part(right)}, part(seen)};
  made.first_difference = fmt::format("unit {}", at);
  return made;
}

}  // namespace fieldproof::conformance
