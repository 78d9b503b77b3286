#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/segment/segment.hpp"
#include "protocols/token_bus/frame.hpp"
#include "protocols/token_bus/translator.hpp"

namespace fieldproof::token_bus {

// Keeps what is driven.
class KeptWaves final : public segment::Port {
 public:
  explicit KeptWaves(segment::Segment& segment) : segment_(segment) {}
  void drive(line::Waveform& wave) override {
    is_in_order &= wave.start >= segment_.now() && wave.start >= until_;
    until_ = wave.end();
    waves.push_back(std::move(wave));
  }

  std::vector<line::Waveform> waves{};
  bool is_in_order = true;

 private:
  segment::Segment& segment_;
  kernel::Time until_ = kernel::kStart;
};

inline char letter_of(ManagementAnswer answer) {
  return "iane"[static_cast<std::size_t>(answer)];
}
// Of a side that carries MAC symbols.
inline std::string symbols_in(const std::vector<line::Waveform>& waves) {
  std::string text;
  for (const line::Waveform& wave : waves) {
    for (std::size_t n = 0; n < units_in(wave.levels); ++n) {
      const MacIndication one = mac_indication_at(wave.levels, n);
      text += one.answer ? std::string(1, letter_of(*one.answer)) : written(MacSymbols{one.symbol});
    }
  }
  return text;
}

// For tests: a translator with somebody on both sides, who gives it symbols and keeps what it drives. An
// answer is a small letter: i of IDLE, a, n, e of a physical error.
class TestTranslator : private segment::Station {
 public:
  explicit TestTranslator(const TranslatorConfiguration& configuration = {})
      : TestTranslator(std::make_unique<Translator>(configuration)) {}
  explicit TestTranslator(std::unique_ptr<TranslatorDevice> translator)
      : translator_(std::move(translator)), seat_(segment_.attach(*translator_, "translator")) {
    translator_->wire(phy_out_, mac_out_);
    set_power(true);
  }

  void set_power(bool is_on) {
    translator_->set_power(is_on, now());
    segment_.refresh(seat_);
  }
  void set_clock(std::int64_t parts_per_million) { parts_per_million_ = parts_per_million; }
  kernel::Time now() const { return segment_.now(); }
  void wait(std::int64_t symbols) { segment_.run_for(mac_symbols(Rules{}, symbols)); }

  // ---- what comes in; all but receive_bits leaves time where it was ----
  void request(const MacSymbols& symbols) {
    line::Levels levels;
    for (const MacSymbol symbol : symbols) append(levels, MacRequest{symbol, {}});
    drive(kMacSide, levels);
    wait(static_cast<std::int64_t>(symbols.size()));
  }
  void manage(ManagementCommand command, std::size_t symbols) {
    line::Levels levels;
    for (std::size_t n = 0; n < symbols; ++n) append(levels, MacRequest{.command = command});
    drive(kMacSide, levels);
  }
  void receive_cells(const std::vector<PhyCell>& cells) {
    line::Levels levels;
    for (const PhyCell& cell : cells) append(levels, cell);
    drive(kPhySide, levels);
    wait(static_cast<std::int64_t>(cells.size() + 1) / 2);
  }
  // "10I"; the carrier is on from the first bit that is not idle.
  void receive_bits(std::string_view text) {
    std::vector<PhyCell> cells;
    bool has_begun = false;
    for (const char letter : text) {
      has_begun |= letter != 'I';
      cells.push_back({letter == 'I'   ? PhySymbol::idl
                       : letter == '1' ? PhySymbol::cd1
                                       : PhySymbol::cd0,
                       {.has_carrier = has_begun}});
    }
    receive_cells(cells);
  }
  void drive(segment::PortIndex port, const line::Levels& levels, std::int64_t times = 1) {
    const std::int64_t rate =
        port == kPhySide ? phy_side_rate(Rules{}.phy_bit_rate) : mac_side_rate(Rules{}.phy_bit_rate);
    segment::Link& link = port == kPhySide ? phy_in_ : mac_in_;
    line::Waveform wave{std::max(now(), link.driven_until()),
                        times * (rate + rate / 1'000'000 * parts_per_million_), levels};
    link.drive(wave);
  }
  void bring_up() {
    answers_to({ManagementCommand::reset, ManagementCommand::disable_loopback,
                ManagementCommand::enable_transmitter});
    wait(20);
    take_phy();
    take_indications();
  }
  std::string answers_to(std::initializer_list<ManagementCommand> commands) {
    std::string texts;
    for (const ManagementCommand command : commands) {
      manage(command, 16);
      wait(16 + 8);
      const std::string answers = take_indications();
      for (const ManagementAnswer answer : {ManagementAnswer::idle, ManagementAnswer::ack,
                                            ManagementAnswer::nack, ManagementAnswer::physical_error}) {
        if (answers == std::string(16, letter_of(answer)))
          texts += (texts.empty() ? "" : " ") + std::string(text_of(answer));
      }
    }
    return texts;
  }

  // ---- what went out since the last call ----
  // "10I", each gap within it in idle bits.
  std::string take_phy() {
    std::string text;
    kernel::Time end = kernel::kNever;
    for (const line::Waveform& wave : std::exchange(phy_out_.waves, {})) {
      for (; end < wave.start; end += mac_symbols(Rules{}, 1) / 2) text += 'I';
      for (std::size_t n = 0; n < units_in(wave.levels); ++n)
        text += written(PhySymbols{phy_cell_at(wave.levels, n).symbol});
      end = wave.end();
    }
    return text;
  }
  std::string take_indications() { return symbols_in(std::exchange(mac_out_.waves, {})); }
  kernel::Time first_phy() const { return phy_out_.waves.front().start; }
  // Nothing was driven in the past, and nothing twice at a time.
  bool is_in_order() const { return phy_out_.is_in_order && mac_out_.is_in_order; }

 private:
  void receive(segment::PortIndex, const line::Waveform&) override {}
  void on_time(kernel::Time) override {}
  kernel::Time next_time() const override { return kernel::kNever; }

  segment::Segment segment_;
  std::unique_ptr<TranslatorDevice> translator_;
  std::size_t seat_;
  segment::Link& phy_in_{segment_.connect("phy", seat_, kPhySide, {})};
  segment::Link& mac_in_{segment_.connect("mac", seat_, kMacSide, {})};
  KeptWaves phy_out_{segment_};
  KeptWaves mac_out_{segment_};
  std::int64_t parts_per_million_ = 0;
};

}  // namespace fieldproof::token_bus
