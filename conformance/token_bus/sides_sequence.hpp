#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "conformance/sequence.hpp"
#include "conformance/token_bus/translator_sides.hpp"
#include "harness/field/pics.hpp"

// Random commands to an implementation whose ports are circuits between two chips: each is done on its bench,
// and on a second bench with the reference; what came out of both is compared side by side.
namespace fieldproof::conformance {

template <typename Bench, typename Needs, typename Setting, typename Reference, typename Configuration>
Bench reference_bench(const Configuration& configuration, const field::Table<Configuration>& table) {
  Setting setting;
  setting.make_device = [](const Configuration& of) { return std::make_unique<Reference>(of); };
  setting.pics = field::declared_by(table, configuration);
  return Bench(Needs{}, setting);
}

// When and in how many pieces is the implementation's choice.
inline void compare_sides(std::string_view side, const SideLog& seen, const SideLog& right,
                          std::string_view reason, CaseJudge& judge) {
  const auto text = [](const SideLog& log) { return without_end(without_end(log.text(), 'S'), 'I'); };
  judge.expect(text(seen) == text(right), reason, [&] {
    Mismatch made = difference(text(right), text(seen));
    made.actual = std::string(side) + ", " + made.actual;
    return made;
  });
}

// A unit of the vocabulary is a letter. Flipped at its first level, it is what the second argument says; at
// another it is the other one of two letters. One that is dropped is the last argument.
inline std::string with_faults(std::string letters, const std::vector<SequenceFault>& faults, char flipped,
                               char dropped) {
  for (const SequenceFault& fault : faults) {
    if (fault.unit >= letters.size()) continue;
    char& letter = letters[fault.unit];
    if (fault.kind == SequenceFaultKind::drop) letter = dropped;
    if (fault.kind != SequenceFaultKind::flip) continue;
    letter = fault.value == 0 ? flipped : letter == '1' ? '0' : '1';
  }
  return letters;
}

}  // namespace fieldproof::conformance
