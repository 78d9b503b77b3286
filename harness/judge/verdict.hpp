#pragma once

#include <optional>
#include <string>
#include <string_view>

// Verdicts in the sense of ISO/IEC 9646, ordered by weight: when several findings belong to one case, the
// heaviest verdict is the verdict of the case. And the standing of a fact: only verified facts may gate a
// verdict; a requirement that rests on another standing is reported as unverified.
namespace fieldproof::judge {

enum class Verdict { none, not_applicable, pass, warn, inconclusive, fail, error };

// Where a fact comes from, the strongest first. Printed in lower case words; `memory` and `own` are
// unverified.
enum class Standing {
  seed,      // printed in one of the papers that the project reproduces
  sure,      // standard, sure
  searched,  // read in a copy of the named document
  calc,      // computed, the computation is in the tests
  derived,   // follows from facts of the standings above
  memory,    // standard or literature from memory, not verified
  own,       // this project's choice, no external authority
};

bool is_verified(Standing standing);

std::string_view name(Verdict verdict);
std::string_view name(Standing standing);
std::optional<Verdict> verdict_from(std::string_view name);
std::optional<Standing> standing_from(std::string_view name);

// Source and place of a requirement, in own words; a clause number appears only where it was read.
struct Reference {
  std::string source;  // "Park 2004, section 2.2"
  std::string clause;  // "frame information", may be empty
  Standing standing = Standing::own;
};

// The reference of what rests on both: the weaker standing decides, and `part` is named after `whole`.
Reference resting_on_both(Reference whole, const Reference& part);

}  // namespace fieldproof::judge
