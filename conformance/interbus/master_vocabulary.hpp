#pragma once

#include "conformance/interbus/master_side.hpp"
#include "conformance/sequence.hpp"

// The words of sequences for an INTERBUS master, and what their numbers mean.
namespace fieldproof::conformance {

// In the order of the vocabulary.
enum class MasterWord : std::uint8_t {
  cycles,
  changed,
  forged,
  extra,
  marked,
  shifted,
  lost,
  bad,
  inputs,
  outputs,
  output,
  identify,
  messages,
  cut,
  ring,
  stop,
  start,
  power,
  wait,
  early_order
};

SequenceVocabulary master_vocabulary();
// What a master of a sequence is given.
interbus::MasterConfiguration configuration_of_sequence(const field::Settings& settings);

// Numbers of a "power" command that are never drawn: rings of twelve stations, of 320 words, and with
// branches of branches; and from where on the configuration expects another station, the first one, the next
// ...
inline constexpr std::int64_t kLongRing = 20;
inline constexpr std::int64_t kWideRing = 21;
inline constexpr std::int64_t kDeepRing = 22;
inline constexpr std::int64_t kAnotherExpected = 20;

// The rings that masters find, by number.
std::vector<interbus::VirtualStation> ring_of(std::int64_t number);
// The ring with another station of the same length, with one more at its end, or with one less.
std::vector<interbus::VirtualStation> changed_ring(std::vector<interbus::VirtualStation> ring,
                                                   std::int64_t change, std::int64_t station);
// Of a "power" command.
MasterScene scene_of(const SequenceCommand& command);
// What the cycle of any other command suffers.
interbus::CycleFaults faults_of(const SequenceCommand& command, std::size_t stations);

}  // namespace fieldproof::conformance
