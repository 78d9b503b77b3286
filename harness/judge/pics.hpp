#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/kernel/time.hpp"

// Protocol implementation conformance statement: what an implementation declares about itself. Applicability
// of a case and declared options (which safe state, which reactions) are decided from it, never guessed.
namespace fieldproof::judge {

class Pics {
 public:
  using Answer = std::variant<bool, std::int64_t, std::string, kernel::Duration>;

  void declare(std::string item, Answer answer) {
    items_.insert_or_assign(std::move(item), std::move(answer));
  }

  // False, or `absent`, for an item that is not declared. A duration is supported when it is not zero.
  bool supports(std::string_view item) const;
  kernel::Duration duration(std::string_view item, kernel::Duration absent) const;
  std::int64_t number(std::string_view item, std::int64_t absent) const;
  std::string text(std::string_view item, std::string_view absent) const;

  const std::map<std::string, Answer, std::less<>>& items() const { return items_; }

  // These answers, and those of `defaults` to what is not answered here.
  Pics completed_by(Pics defaults) const;

 private:
  std::map<std::string, Answer, std::less<>> items_;
};

// What an item may be answered with.
enum class PicsKind : std::uint8_t { truth, number, text, duration };

PicsKind kind_of(const Pics::Answer& answer);

// "true", "64", "\"held\"", "1.000 ms".
std::string answer_text(const Pics::Answer& answer);

// One row of the list of items that a suite knows. An item that no row names is a misspelling: nobody would
// ask for it, and what it was meant to switch on would silently not apply.
struct PicsItem {
  std::string name;
  PicsKind kind = PicsKind::truth;
  std::string meaning;
  std::int64_t most = 0;             // of a number; of a duration in picoseconds
  std::vector<std::string> words{};  // that a text may be
  std::int64_t least = 0;            // the same
};

// "true or false", "a whole number from 0 to 64", "\"held\" or \"cleared\"", "a time from 0 ps to 1 s".
std::string answers_text(const PicsItem& item);

}  // namespace fieldproof::judge
