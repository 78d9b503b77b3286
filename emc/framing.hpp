#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "harness/line/character.hpp"
#include "harness/line/telegram.hpp"
#include "harness/line/waveform.hpp"

// What a declared receiver makes of the bits of a transmission: which of them it takes for start and stop,
// which decide about the framing, and which it only samples. With it a burst channel knows which wrong times
// no receiver of this kind can see, and need not be shown to it.
namespace fieldproof::emc {

enum class BitRole : std::uint8_t {
  sampled,  // a wrong sample changes a value and nothing else
  framing,  // a wrong sample changes what the bits behind it are
  start,
  stop,
};

// A character, telegram or frame: bits that are sampled on one grid.
struct FramedUnit {
  std::size_t first = 0;
  std::size_t count = 0;
  bool has_start_and_stop = true;
  std::uint32_t framing_bits = 0;  // bit n: the n-th bit of the unit decides about the framing

  std::size_t end() const { return first + count; }
  BitRole role_of(std::size_t bit) const {
    const std::size_t offset = bit - first;
    if (has_start_and_stop && offset == 0) return BitRole::start;
    if (has_start_and_stop && offset + 1 == count) return BitRole::stop;
    return offset < 32 && (framing_bits >> offset & 1) != 0 ? BitRole::framing : BitRole::sampled;
  }
};

class Framing {
 public:
  Framing() = default;
  Framing(const Framing&) = delete;
  Framing& operator=(const Framing&) = delete;
  virtual ~Framing() = default;

  // Appends the units of levels that are one bit each, in order, at least those that end after level `from`
  // and begin up to level `until`. False when one up to there is cut or broken: then nothing can be said
  // without the receiver.
  virtual bool find(const line::Levels& levels, std::size_t from, std::size_t until,
                    std::vector<FramedUnit>& units) const = 0;
  // The bits that the longest unit has.
  virtual std::size_t longest_unit() const = 0;
};

class TelegramFraming final : public Framing {
 public:
  explicit TelegramFraming(const line::TelegramLayout& layout);
  bool find(const line::Levels& levels, std::size_t from, std::size_t until,
            std::vector<FramedUnit>& units) const override;
  std::size_t longest_unit() const override { return line::kDataTelegramLevels; }

 private:
  const line::TelegramCode& code_;
  std::uint32_t flag_bit_;
};

// Not for one and a half stop bits, which are no whole bits: a broken invariant.
class CharacterFraming final : public Framing {
 public:
  explicit CharacterFraming(const line::CharacterFormat& format);
  bool find(const line::Levels& levels, std::size_t from, std::size_t until,
            std::vector<FramedUnit>& units) const override;
  std::size_t longest_unit() const override { return code_.format().bits_before_stop() + 1; }

 private:
  line::CharacterCode code_;
};

// A receiver whose bit clock stands for the whole transmission, however it came by it.
class SynchronousFraming final : public Framing {
 public:
  bool find(const line::Levels& levels, std::size_t from, std::size_t until,
            std::vector<FramedUnit>& units) const override;
  std::size_t longest_unit() const override { return 0; }
};

}  // namespace fieldproof::emc
