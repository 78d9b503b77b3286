#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/kernel/time.hpp"
#include "harness/line/waveform.hpp"

// A declared fault: when it answers, on which part of a transmission, and what it does there. Everything here
// is plain data that can be compared, written and read; `InstalledPlan` (plan.hpp) gives it effect.
//
// Counting: what is the n-th (frames, observations) counts from 1, what is a place (units, levels) from 0.
//
// How the rules of a plan work together on one transmission to one receiver:
//  - Rules are asked in order of installation, about the transmission as it was sent; no rule sees what
//    another one has made of it.
//  - Flip and Force accumulate, level by level in order of installation: a force overrides the flips and
//    forces of rules before it, a flip after it inverts what was forced.
//  - Drop, Delay, Repeat and Insert claim the levels of their part. The first rule that claims a level wins;
//  a
//    later rule whose part touches a claimed level does not answer (no hit, no draw). Parts that do not touch
//    may have different effects.
//  - Mute accumulates: the receiver hears nothing while any mute lasts.
// A rule has hit when its effect was entered, and counts that over all receivers of the installed plan;
// after `times` hits it does not answer any more.
namespace fieldproof::fault {

// The longest duration of an effect: eleven days.
inline constexpr kernel::Duration kLongestDuration{1'000'000'000'000'000'000};

// Inverts levels, counted from the first level of the part; without a list all levels of the part. Positions
// after the end of the part but inside the transmission are legal; after the transmission they do nothing.
struct Flip {
  std::vector<std::uint32_t> levels{};
  friend bool operator==(const Flip&, const Flip&) = default;
};

// Sets levels from the first level of the part on: `count` of them, or those that begin within `duration` (it
// wins), or (both zero) all levels of the part. Ends with the transmission at the latest: the idle line
// between transmissions is not forced.
struct Force {
  bool level = false;
  std::uint32_t count = 0;
  kernel::Duration duration{};
  friend bool operator==(const Force&, const Force&) = default;
};

// The part arrives later; what is around it arrives in time. Where arrivals then overlap, the one that starts
// later wins from its start on: the rest of the earlier one is lost. An arrival that has begun is not taken
// back: of a later transmission only the levels from its end on arrive.
struct Delay {
  kernel::Duration duration{};
  friend bool operator==(const Delay&, const Delay&) = default;
};

// The part does not arrive; what is around it arrives in time.
struct Drop {
  friend bool operator==(const Drop&, const Drop&) = default;
};

// The part arrives `count` more times, each `gap` after the end of the one before; the rest of the
// transmission arrives after that.
struct Repeat {
  std::uint32_t count = 1;
  kernel::Duration gap{};
  friend bool operator==(const Repeat&, const Repeat&) = default;
};

// Levels at the rate of the transmission, in front of the part or after it; what follows them arrives later
// by their length.
struct Insert {
  line::Levels levels;
  bool is_behind = false;
  friend bool operator==(const Insert&, const Insert&) = default;
};

// From the start of the part on the receiver hears nothing for a while, also of later transmissions.
struct Mute {
  kernel::Duration duration{};
  friend bool operator==(const Mute&, const Mute&) = default;
};

using Effect = std::variant<Flip, Force, Delay, Drop, Repeat, Insert, Mute>;

// The numbers first, first + every, first + 2 * every ... up to last. `every` is at least 1.
struct Numbers {
  std::uint64_t first = 0;
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t every = 1;

  static constexpr Numbers only(std::uint64_t n) { return {n, n, 1}; }
  constexpr bool contains(std::uint64_t n) const {
    return n >= first && n <= last && (every == 1 || (n - first) % every == 0);
  }
  friend bool operator==(const Numbers&, const Numbers&) = default;
};

// Holds from the nth observation of that name on (at channels whose name fits), for `lasting`.
struct After {
  std::string observation;    // pattern
  std::string channel = "*";  // pattern
  std::uint64_t nth = 1;
  kernel::Duration lasting = kernel::Duration::max();
  friend bool operator==(const After&, const After&) = default;
};

// When a rule answers. Everything that is set must hold; a When of which nothing is set holds always.
// Patterns are names in which '*' stands for any characters and '?' for one.
//
// `from` and `to` are the window [from, to) in which the part begins; the outermost window of a rule that
// flips or forces narrows the part instead, to the levels that begin inside it. `chance` is drawn last, once
// for each part for which all else holds, from a random stream that belongs to this rule and this receiver.
struct When {
  std::string receiver = "*";
  std::string frame_kind = "*";
  std::string field = "*";
  Numbers frame{};  // its number among those of its kind on this receiver, from 1
  Numbers unit{};   // its place within the frame, from 0
  Numbers bit{};    // levels within the field, from 0: the part is from the first to the last of them
  kernel::Time from = kernel::Time{-kernel::Duration::max()};
  kernel::Time to = kernel::kNever;
  double chance = 1.0;
  std::optional<After> after{};

  std::vector<When> all_of{};
  std::vector<When> any_of{};  // when there are any, at least one holds
  std::vector<When> none_of{};

  friend bool operator==(const When&, const When&) = default;
};

// What the part is that an effect works on, around a field for which `when` holds.
enum class Scope : std::uint8_t {
  level,         // each level of the field (that is in `bit`) for itself
  field,         // the field, or its levels in `bit`
  unit,          // the whole unit of the field
  frame,         // what this transmission has of the frame
  transmission,  // all of it
};

struct Rule {
  std::string name;  // told in the trace; may be empty
  When when;
  Scope scope = Scope::field;
  Effect effect;
  std::uint64_t times = std::numeric_limits<std::uint64_t>::max();

  friend bool operator==(const Rule&, const Rule&) = default;
};

// Does a name fit a pattern ('*' any characters, '?' one)?
bool fits(std::string_view pattern, std::string_view name);

// The word of an effect in plans and traces: "flip", "force", "delay", "drop", "repeat", "insert", "mute".
std::string_view word_of(const Effect& effect);

// Rules as tests write them: `plan.add(flip_level("slave@2/in", "data", 3))`.
Rule flip_level(std::string receiver, std::string field, std::uint32_t level);
Rule drop_frame(std::string receiver, std::string frame_kind, std::uint64_t number);
Rule mute(std::string receiver, kernel::Time from, kernel::Duration duration);

}  // namespace fieldproof::fault
