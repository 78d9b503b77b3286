#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/line/waveform.hpp"
#include "protocols/token_bus/mac_symbol.hpp"

// How MAC symbols become the signal of an IEEE 802.3 line and the other way round: two bits of the line for
// each symbol, and each bit Manchester coded, its second half as the bit is.
//
// The paper gives the table of encoding. It leaves out that of decoding, which follows from it but for ties;
// those are this project's choice:
//
//   CD1,CD0 one          CD1,CD1 non_data, the first of two    IDL,IDL silence
//   CD0,CD1 zero         CD0,CD0 non_data, the second of two   CDx,IDL bad_signal; silence after the last
//   frame anything else, or with a signal error: bad_signal          IDL,CDx silence, and a transmission
//   begins
//
// Nothing on the line says which bit is the first of a pair. A preamble read one bit late is a row of zeros:
// the decoder slips by one bit until it reads ones, and never again after the first non_data of a
// transmission, because pairs across the border of two symbols look like non_data in any field of data.
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

class MacEncoder {
 public:
  // non_data comes in pairs: which of the two this one is follows from those before. bad_signal is never
  // requested: a broken invariant.
  PhyPair encode(MacSymbol symbol);
  void reset() { is_second_non_data_ = false; }

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

// Gives a MAC symbol for each two bits. The decisions that a wrong decoder takes otherwise are virtual.
class MacDecoder {
 public:
  MacDecoder() = default;
  MacDecoder(const MacDecoder&) = default;
  MacDecoder& operator=(const MacDecoder&) = default;
  virtual ~MacDecoder() = default;

  // The next bit of the line; a symbol where it is the second one of a pair.
  std::optional<MacSymbol> take(PhySymbol bit, LineStatus status = {});
  void reset();

  bool is_hunting() const { return phase_ == Phase::hunting; }
  bool expects_second_non_data() const { return expects_second_; }
  std::size_t slips() const { return slips_; }  // since the transmission began

 protected:
  // ---- decisions ----
  virtual MacSymbol indication(PhyPair pair, LineStatus status) const;
  virtual bool slips_after(unsigned zeros_in_a_row) const { return zeros_in_a_row >= 2; }
  virtual bool may_slip() const { return phase_ == Phase::hunting; }
  virtual unsigned slip_bits() const { return 1; }

 private:
  enum class Phase : std::uint8_t { silent, hunting, locked };

  MacSymbol indicate(PhyPair pair, LineStatus status);
  void follow(MacSymbol symbol);
  void lose_lock();

  Phase phase_ = Phase::silent;
  std::optional<PhySymbol> first_{};
  unsigned to_drop_ = 0;
  bool expects_second_ = false;
  unsigned zeros_ = 0;
  unsigned ones_ = 0;
  std::size_t slips_ = 0;
  std::uint64_t last_symbols_ = 0;  // eight octal digits, the last one lowest
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
