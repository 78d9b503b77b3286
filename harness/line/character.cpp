#include "harness/line/character.hpp"

#include <algorithm>
#include <bit>

#include "harness/kernel/check.hpp"

namespace fieldproof::line {
namespace {

bool parity_of(Parity parity, unsigned data) {
  switch (parity) {
    case Parity::none:
    case Parity::space:
      return false;
    case Parity::mark:
      return true;
    case Parity::even:
      return std::popcount(data) % 2 != 0;
    case Parity::odd:
      return std::popcount(data) % 2 == 0;
  }
  return false;
}

// Each bit twice.
std::uint64_t doubled(std::uint64_t bits) {
  std::uint64_t result = 0;
  for (unsigned n = 0; n < 32; ++n) result |= ((bits >> n) & 1) * (std::uint64_t{3} << (2 * n));
  return result;
}

}  // namespace

std::string CharacterFormat::text() const {
  constexpr std::array<char, 5> kParities{'n', 'e', 'o', 'm', 's'};
  constexpr std::array<const char*, 3> kStops{"1", "1.5", "2"};
  return std::to_string(data_bits) + kParities.at(static_cast<std::size_t>(parity)) +
         kStops.at(static_cast<std::size_t>(stop_bits));
}

CharacterCode::CharacterCode(const CharacterFormat& format)
    : format_(format),
      front_(format.bits_before_stop()),
      data_mask_((1U << format.data_bits) - 1),
      parity_mask_(format.parity == Parity::none ? 0 : 1) {
  FIELDPROOF_CHECK(format.data_bits >= 5 && format.data_bits <= 9, "a character has 5 to 9 data bits");
  for (unsigned data = 0; data <= data_mask_; ++data) parity_bits_.at(data) = parity_of(format.parity, data);
}

void CharacterCode::append(Levels& levels, unsigned data) const {
  std::uint64_t bits = std::uint64_t{data & data_mask_} << 1;
  if (format_.parity != Parity::none) bits |= std::uint64_t{parity_bit(data)} << (front_ - 1);
  bits |= ~std::uint64_t{0} << front_;
  levels.append(levels_per_bit() == 2 ? doubled(bits) : bits, levels_per_character());
}

// A start bit, nine data bits, parity and stop.
static_assert(12 <= Sampler::kMostBits);

kernel::Time CharacterReceiver::busy_until(const Waveform& wave, const Received& received) const {
  if (!received.character.is_stop_missing) {
    return kernel::level_time(received.start, code_.format().half_bits(), 2 * bit_rate_);
  }
  std::size_t level = sampler_.behind(code_.format().bits_before_stop());
  while (level < wave.levels.size() && !wave.levels[level]) ++level;
  return std::max(received.end, wave.time_of(level));
}

void CharacterReceiver::receive(const Waveform& wave, std::vector<Received>& received) {
  const unsigned length = code_.format().bits_before_stop() + 1;
  sampler_.look_at(wave);
  std::size_t edge = 0;
  while ((edge = falling_edge(wave.levels, edge)) < wave.levels.size()) {
    sampler_.start(edge);
    std::uint32_t bits = 0;
    for (unsigned bit = 0; bit < length; ++bit) bits |= std::uint32_t{sampler_.sample(bit)} << bit;
    if ((bits & 1) != 0) {
      edge = sampler_.idle_seen();
      continue;
    }
    const kernel::Time start = wave.time_of(edge);
    Received& last = received.emplace_back(
        Received{code_.from_bits(bits), start, sampling_.decided_at(start, length - 1, bit_rate_), {}});
    last.character.level = static_cast<std::uint32_t>(edge);
    last.busy_until = busy_until(wave, last);
    // With the stop bit missing the line is low: the next falling edge lies after an idle level anyhow.
    edge = sampler_.behind(length - 1);
  }
}

}  // namespace fieldproof::line
