#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

// Protocol implementation conformance statement: what an implementation declares about itself. Applicability
// of a case and declared options (which safe state, which reactions) are decided from it, never guessed.
namespace fieldproof::judge {

class Pics {
 public:
  using Answer = std::variant<bool, std::int64_t, std::string>;

  void declare(std::string item, Answer answer) {
    items_.insert_or_assign(std::move(item), std::move(answer));
  }

  // False, or `absent`, for an item that is not declared.
  bool supports(std::string_view item) const;
  std::int64_t number(std::string_view item, std::int64_t absent) const;
  std::string text(std::string_view item, std::string_view absent) const;

  const std::map<std::string, Answer, std::less<>>& items() const { return items_; }

 private:
  std::map<std::string, Answer, std::less<>> items_;
};

}  // namespace fieldproof::judge
