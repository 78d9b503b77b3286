#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "harness/line/waveform.hpp"
#include "harness/trace/recording.hpp"

// How a protocol tells what was on its lines. A recording knows only levels; the protocol that was run gives
// its dissector along, so that whoever writes the recording down needs to know no protocol.
namespace fieldproof::trace {

// A transmission in words, for a reader who does not decode levels.
struct Decoded {
  std::string text;
  bool is_check_wrong = false;  // a frame check that ended in it does not fit what it covers
};

// Tells the transmissions of one line, in order: what it says of one may rest on those before it.
class Teller {
 public:
  Teller() = default;
  Teller(const Teller&) = delete;
  Teller& operator=(const Teller&) = delete;
  virtual ~Teller() = default;
  virtual Decoded tell(const line::Waveform& wave) = 0;
};

class Dissector {
 public:
  Dissector() = default;
  Dissector(const Dissector&) = delete;
  Dissector& operator=(const Dissector&) = delete;
  virtual ~Dissector() = default;

  // The rate of the bits on the line, in bit/s; 0 when it is not known.
  virtual std::int64_t bit_rate() const = 0;
  // Which protocol a capture says that it holds; 0: none that a dissector would know.
  virtual std::uint8_t capture_number() const = 0;
  // Which of the forms of that protocol, where it has several that levels alone do not tell apart.
  virtual std::uint8_t capture_variant() const { return 0; }
  // As short as it can be: what stands in a line of trace.txt.
  virtual std::string brief(const line::Waveform& wave) const = 0;
  virtual std::unique_ptr<Teller> teller() const = 0;
};

// Of lines whose protocol is not known: levels.
class PlainDissector final : public Dissector {
 public:
  std::int64_t bit_rate() const override { return 0; }
  std::uint8_t capture_number() const override { return 0; }
  std::string brief(const line::Waveform& wave) const override;
  std::unique_ptr<Teller> teller() const override;
};

// One record a line, for people:
//
//   20.130000 ms  slave@1/in  id A55A 0003 | id check 1D0F 0000  [0100…]
//   20.130000 ms  slave@1/in  fault: flip of level 17
//
// and before them the steps that the case has begun by then: "20.000000 ms  step 2 of 5: an ID cycle".
// Levels are shown for transmissions of at most 400 levels, the rate where it is not that of the bits.
std::vector<std::string> text_lines(const Recording& recording, const Dissector& dissector);

}  // namespace fieldproof::trace
