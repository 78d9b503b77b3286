// What the language knows of members and does not say: how a member is called, and how many an aggregate has.
#pragma once

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

namespace fieldproof::field {

// "bit_rate" of &Rules::bit_rate.
template <auto Member>
consteval std::string_view name_of() {
#if defined(__GNUC__)
  std::string_view text = __PRETTY_FUNCTION__;
#else
#error "the name of a member is read off __PRETTY_FUNCTION__, which this compiler does not have"
#endif
  // "... [with auto Member = &fieldproof::x::Rules::bit_rate; ...]", "... [Member = &Rules::bit_rate]"
  text.remove_prefix(text.find("Member = ") + 9);
  text = text.substr(0, text.find_first_of(";]) "));
  return text.substr(text.rfind(':') + 1);
}

namespace detail {

// Becomes whatever a member is initialised with.
struct Anything {
  std::size_t unused;
  template <typename T>
  constexpr operator T&() const& noexcept;
  template <typename T>
  constexpr operator T&&() const&& noexcept;
};

template <typename T, std::size_t... N>
consteval bool takes(std::index_sequence<N...>) {
  return requires { T{Anything{N}...}; };
}

template <typename T, std::size_t N = 0>
consteval std::size_t members() {
  if constexpr (takes<T>(std::make_index_sequence<N + 1>{})) {
    return members<T, N + 1>();
  } else {
    return N;
  }
}

}  // namespace detail

// How many members an aggregate has: as many initialisers as it takes.
template <typename T>
  requires std::is_aggregate_v<T>
inline constexpr std::size_t kMembers = detail::members<T>();

}  // namespace fieldproof::field
