#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "harness/line/waveform.hpp"
#include "protocols/token_bus/clock_control.hpp"
#include "protocols/token_bus/mac_symbol.hpp"

// How MAC symbols become the signal of an IEEE 802.3 line and the other way round: two bits of the line for
// each symbol, and each bit Manchester coded, its second half as the bit is.
//
// The paper gives the table of encoding. It leaves out that of decoding, which follows from it but for ties;
// those are this project's choice. Of a pair of bits, by CARRIER_STATUS and SIGNAL_STATUS:
//
//               carrier off   carrier on                               carrier on, signal error
//   CD1,CD0     silence       one                                      bad_signal
//   CD0,CD1     silence       zero                                     bad_signal
//   CD1,CD1     silence       non_data, the first of two               bad_signal
//   CD0,CD0     silence       non_data, the second of two              bad_signal
//   CD1,IDL     silence       bad_signal; silence after a last frame   bad_signal
//   CD0,IDL     silence       bad_signal; silence after a last frame   bad_signal
//   IDL,CD1     silence       silence, and a transmission begins       bad_signal
//   IDL,CD0     silence       silence, and a transmission begins       bad_signal
//   IDL,IDL     silence       silence                                  bad_signal
//
// A non_data that is not the half of a pair that is due, and a data symbol where the second half is due, are
// bad_signal. After a last frame: its end delimiter says that nothing follows, and repeaters add bits to it.
namespace fieldproof::token_bus {

// Bits of the line: clocked data zero and one, and idle, which has no edge.
enum class PhySymbol : std::uint8_t { cd0, cd1, idl };
using PhySymbols = std::vector<PhySymbol>;

struct PhyPair {
  PhySymbol first;
  PhySymbol second;
  friend bool operator==(const PhyPair&, const PhyPair&) = default;
};

// "10I".
std::string written(std::span<const PhySymbol> symbols);

// ---- encoding ----

// MACTX of the paper.
class MacEncoder {
 public:
  MacEncoder() = default;
  MacEncoder(const MacEncoder&) = delete;
  MacEncoder& operator=(const MacEncoder&) = delete;
  virtual ~MacEncoder() = default;

  // non_data comes in pairs: which of the two this one is follows from those before. bad_signal is never
  // requested: a broken invariant.
  PhyPair encode(MacSymbol symbol);
  virtual void reset() { is_second_non_data_ = false; }

 protected:
  // ---- decisions ----
  virtual PhyPair encoded(MacSymbol symbol, bool is_second_non_data) const;

 private:
  bool is_second_non_data_ = false;
};

PhySymbols phy_symbols_of(std::span<const MacSymbol> symbols);
// Two half-bit levels for each bit, of which a line has 2 x its bit rate in a second.
void append(line::Levels& half_bits, std::span<const PhySymbol> symbols);
line::Levels half_bits_of(std::span<const MacSymbol> symbols);

// ---- decoding ----

struct LineStatus {
  bool has_carrier = true;        // CARRIER_STATUS
  bool has_signal_error = false;  // SIGNAL_STATUS
  friend bool operator==(const LineStatus&, const LineStatus&) = default;
};

// MACRX of the paper. Gives a MAC symbol for each two bits. The decisions that a wrong decoder takes
// otherwise are virtual.
class MacDecoder {
 public:
  MacDecoder() : MacDecoder(std::make_unique<ClockControl>()) {}
  explicit MacDecoder(std::unique_ptr<ClockControl> clock) : clock_(std::move(clock)) {}
  MacDecoder(const MacDecoder&) = delete;
  MacDecoder& operator=(const MacDecoder&) = delete;
  virtual ~MacDecoder() = default;

  // The next bit of the line; a symbol where it is the second one of a pair. A signal error in one of both is
  // one of the pair; whether there is a carrier, the second says.
  std::optional<MacSymbol> take(PhySymbol bit, LineStatus status = {});
  virtual void reset();

  bool is_within_pair() const { return first_.has_value(); }
  bool is_hunting() const { return clock_->is_hunting(); }
  bool expects_second_non_data() const { return expects_second_; }
  std::size_t slips() const { return clock_->slips(); }  // since the transmission began

 protected:
  // ---- decisions ----
  virtual MacSymbol indication(PhyPair pair, LineStatus status) const;
  // In the symbol after the first one, and in no other.
  virtual bool expects_second_after(MacSymbol symbol) const {
    return symbol == MacSymbol::non_data && !expects_second_;
  }

 private:
  struct First {
    PhySymbol symbol;
    bool has_signal_error;
  };

  MacSymbol indicate(PhyPair pair, LineStatus status);
  void lose_lock();

  std::unique_ptr<ClockControl> clock_;
  std::optional<First> first_{};
  bool expects_second_ = false;
  LastFrameEnd last_{};
};

// ---- a whole transmission ----

struct ReceivedBit {
  PhySymbol symbol;
  LineStatus status;
};
struct Indication {
  MacSymbol symbol;
  std::size_t half_bit;  // at which it begins, from the begin of the transmission
};

// The bits of a transmission, its clock recovered from its edges, and two of idle after it. Where its front
// is lost, the middle of a bit is found by the first two edges that are a bit apart: in this code both are
// such middles. Two halves of level 0 are no bit: a signal error.
std::vector<ReceivedBit> received_bits(const line::Waveform& wave, std::int64_t phy_bit_rate,
                                       std::size_t* first_half_bit = nullptr);
std::vector<Indication> indications_in(const line::Waveform& wave, std::int64_t phy_bit_rate);
// The same by a decoder that decides otherwise.
std::vector<Indication> indications_in(const line::Waveform& wave, std::int64_t phy_bit_rate,
                                       MacDecoder& decoder);

}  // namespace fieldproof::token_bus
