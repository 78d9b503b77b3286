#pragma once

#include <cstdint>
#include <deque>

#include "protocols/token_bus/service_units.hpp"
#include "protocols/token_bus/translator_blocks.hpp"

// The physical layer service translator (PST) of Lee, Moon, Moon, Kwon, Lee and Park: between the MAC of IEEE
// 802.4 at 5 Mbit/s and the physical layer of IEEE 802.3 at 10 Mbit/s. What is requested on the MAC side is
// encoded for the physical side, and what is received there is decoded and indicated.
//
// It works through both sides in pieces of a few symbols: what it drives is `delay_symbols` later than what
// it follows from, and depends on nothing later than that. A symbol that is indicated lasts as long as the
// two bits of the line that it was decoded from: the clock of the indications is that of the line. Silence is
// driven by driving nothing.
namespace fieldproof::token_bus {

class Translator : public TranslatorDevice {
 public:
  explicit Translator(const TranslatorConfiguration& configuration, TranslatorBlocks blocks = {})
      : configuration_(configuration), blocks_(std::move(blocks)) {}

  void wire(segment::Port& phy, segment::Port& mac) override;
  void set_power(bool is_on, kernel::Time now) override;

  void receive(segment::PortIndex port, const line::Waveform& reception) override;
  void on_time(kernel::Time now) override;
  kernel::Time next_time() const override;

 protected:
  const TranslatorConfiguration& configuration() const { return configuration_; }

  // ---- decisions ----
  // A signal error so long after the end of an own transmission is the SQE test of the transceiver; within
  // one, where the time is negative, it is a collision.
  virtual bool is_error_masked(kernel::Duration after_own_transmission) const;
  virtual bool works_in_management_mode() const { return true; }
  virtual bool takes_line(bool is_looped_back, bool /*is_sending*/) const { return !is_looped_back; }

 private:
  // One bit at the decoder; `rate` is that of four levels for each symbol.
  struct Bit {
    kernel::Time begin;
    kernel::Time end;
    std::int64_t rate;
  };

  struct Transmission {
    kernel::Time begin;
    kernel::Time end;
  };

  // The same for all that comes out: an answer overtakes no symbol.
  unsigned delay_symbols() const;
  kernel::Duration delay() const { return mac_symbols(configuration_.rules, delay_symbols()); }
  kernel::Time half_pair_until() const;
  void note_transmission(kernel::Time begin, kernel::Time end);
  kernel::Duration after_own_transmission(kernel::Time at);
  bool is_management_within(kernel::Time begin, kernel::Time end) const;
  void follow_request();
  void follow_phy();
  void complete_pair();
  void manage(const ServiceUnit& unit, ManagementCommand command);
  void request(const ServiceUnit& unit, MacSymbol symbol);
  void decode(const Bit& bit, PhySymbol symbol, LineStatus status);
  void indicate(const Bit& pair, MacSymbol symbol);

  TranslatorConfiguration configuration_;
  TranslatorBlocks blocks_;
  bool is_powered_ = false;
  ServiceInput requests_;
  ServiceInput bits_;
  ServiceOutput indications_;
  ServiceOutput signals_;
  kernel::Time requested_until_ = kernel::kStart;
  std::deque<Transmission> transmissions_;  // own ones: the last that has begun, and what is to go out
  Bit last_bit_{};                          // at the decoder
  kernel::Time pair_begin_ = kernel::kStart;
};

}  // namespace fieldproof::token_bus
