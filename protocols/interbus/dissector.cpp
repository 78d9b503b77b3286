#include "protocols/interbus/dissector.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string_view>

#include "harness/line/telegram_receiver.hpp"

namespace fieldproof::interbus {
namespace {

std::string_view phase_name(const line::Telegram& telegram) {
  constexpr std::array<std::string_view, 4> kNames = {"data", "id", "check", "id check"};
  return telegram.is_data() ? kNames.at(telegram.header & 3U) : "status";
}

// Collects telegrams of one phase until another begins.
class Writer {
 public:
  void add(const line::Telegram& telegram) {
    const std::string_view phase = phase_name(telegram);
    if (phase != phase_) end_phase();
    phase_ = phase;
    if (telegram.is_data()) {
      if (count_ % 2 == 0) octets_ += ' ';
      fmt::format_to(std::back_inserter(octets_), "{:02X}", telegram.data);
    }
    if (telegram.is_stop_missing()) octets_ += '!';
    ++count_;
  }

  std::string finish() {
    end_phase();
    return std::move(text_);
  }

 private:
  void end_phase() {
    if (count_ == 0) return;
    if (!text_.empty()) text_ += " | ";
    if (phase_ == "status") {
      fmt::format_to(std::back_inserter(text_), "{} status{}", count_, octets_);
    } else {
      fmt::format_to(std::back_inserter(text_), "{}{}", phase_, octets_);
    }
    octets_.clear();
    count_ = 0;
  }

  std::string text_;
  std::string_view phase_;
  std::string octets_;
  std::size_t count_ = 0;
};

}  // namespace

std::string describe(const line::Waveform& wave, const Rules& rules) {
  line::TelegramReceiver receiver(line::shared_telegram_code(rules.telegram), rules.bit_rate);
  Writer writer;
  receiver.receive(wave,
                   [&](const line::Waveform&, const line::Telegram& telegram) { writer.add(telegram); });
  std::string text = writer.finish();
  if (receiver.pending_until() == kernel::kNever) return text.empty() ? "idle" : text;
  constexpr std::size_t kMostLevels = 80;
  const std::size_t size = wave.levels.size();
  const std::size_t shown = size < kMostLevels ? size : kMostLevels;
  if (!text.empty()) text += " | ";
  return text + "cut, last levels " + wave.levels.slice(size - shown, shown).text();
}

}  // namespace fieldproof::interbus
