#pragma once

#include <memory>

#include "protocols/token_bus/service_signals.hpp"
#include "protocols/token_bus/translator_device.hpp"

// The blocks of the paper's translator. MACTX is MacEncoder, MACRX is MacDecoder with CLKCTRL's ClockControl
// (line_code.hpp); the others are here. Their decisions are virtual: a wrong translator is one with a wrong
// block.
namespace fieldproof::token_bus {

// SMANAGER: which mode, and what the station management of the MAC has switched. The paper says that there
// are two modes; commands and answers are from memory, what they do is this project's choice.
class StationManager {
 public:
  StationManager() = default;
  StationManager(const StationManager&) = delete;
  StationManager& operator=(const StationManager&) = delete;
  virtual ~StationManager() = default;

  // As RESET leaves it, in MAC mode.
  void power_on();
  // A command that stands until then. Without a next one that is END PHYSICAL.
  ManagementAnswer take(ManagementCommand command, kernel::Time until);
  // The transmitter has been on for too long.
  void on_jabber() { has_jabbered_ = true; }

  bool is_management(kernel::Time at) const { return at < managed_until_; }
  virtual bool is_looped_back() const { return is_looped_back_; }
  virtual bool may_transmit() const { return is_transmitter_enabled_ && !has_jabbered_; }

 protected:
  bool has_jabbered() const { return has_jabbered_; }

  // ---- decisions ----
  virtual bool enables_transmitter_at_reset() const { return false; }
  virtual bool loops_back_at_reset() const { return true; }
  virtual bool disables_loopback() const { return true; }
  virtual bool ends_jabber_at_reset() const { return true; }
  virtual ManagementAnswer answer_to(ManagementCommand command) const;

 private:
  void reset();

  kernel::Time managed_until_ = kernel::kStart;
  bool is_looped_back_ = true;
  bool is_transmitter_enabled_ = false;
  bool has_jabbered_ = false;
};

// INMUX: in management mode the MAC is indicated answers, and no symbols.
class IndicationMultiplexer {
 public:
  IndicationMultiplexer() = default;
  IndicationMultiplexer(const IndicationMultiplexer&) = delete;
  IndicationMultiplexer& operator=(const IndicationMultiplexer&) = delete;
  virtual ~IndicationMultiplexer() = default;

  // ---- decisions ----
  virtual bool passes_symbols(bool is_management) const { return !is_management; }
};

// RBLK: silence is indicated for a time after a transmission has ended by its own word.
class ReceiverBlanking {
 public:
  ReceiverBlanking() = default;
  ReceiverBlanking(const ReceiverBlanking&) = delete;
  ReceiverBlanking& operator=(const ReceiverBlanking&) = delete;
  virtual ~ReceiverBlanking() = default;

  virtual void reset();
  // What is indicated of a symbol.
  virtual MacSymbol pass(MacSymbol symbol, kernel::Time begin, kernel::Time end, const Rules& rules);

 protected:
  // ---- decisions ----
  // With `symbol` the transmission has ended.
  virtual bool begins_with(MacSymbol symbol);
  virtual unsigned symbols(const Rules& rules) const { return rules.blanking_symbols; }

 private:
  LastFrameEnd end_{};
  kernel::Time blanked_until_ = kernel::kStart;
};

// Part of MACTX: nobody may be on for ever.
class Jabber {
 public:
  Jabber() = default;
  Jabber(const Jabber&) = delete;
  Jabber& operator=(const Jabber&) = delete;
  virtual ~Jabber() = default;

  virtual void reset() { symbols_ = 0; }
  // True from the symbol on that is too much.
  bool is_too_long(MacSymbol symbol, bool is_transmitter_on, const TranslatorConfiguration& configuration);

 protected:
  // ---- decisions ----
  // As one more symbol of a transmission; else there is none.
  virtual bool counts(MacSymbol symbol, bool is_transmitter_on) {
    return symbol != MacSymbol::silence && is_transmitter_on;
  }
  virtual unsigned most_symbols(const TranslatorConfiguration& configuration) const {
    return configuration.jabber_symbols;
  }

 private:
  unsigned symbols_ = 0;  // of the transmission
};

struct TranslatorBlocks {
  std::unique_ptr<StationManager> manager = std::make_unique<StationManager>();
  std::unique_ptr<MacEncoder> transmitter = std::make_unique<MacEncoder>();
  std::unique_ptr<MacDecoder> receiver = std::make_unique<MacDecoder>();
  std::unique_ptr<IndicationMultiplexer> multiplexer = std::make_unique<IndicationMultiplexer>();
  std::unique_ptr<ReceiverBlanking> blanking = std::make_unique<ReceiverBlanking>();
  std::unique_ptr<Jabber> jabber = std::make_unique<Jabber>();
};

}  // namespace fieldproof::token_bus
