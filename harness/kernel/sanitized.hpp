#pragma once

#include <vector>

// For tests whose length is a choice: sanitizers make a run some twenty times slower, and what they look for
// does not hide in the repetitions.
namespace fieldproof::kernel {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kIsSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kIsSanitized = false;
#endif

// Of many alike a sanitizer sees each `one_of`th, beginning with the first; without one all are seen:
//     for (FewerIfSanitized few(4); const Mutant& mutant : mutants) {
//       if (few.leaves_out()) continue;
class FewerIfSanitized {
 public:
  explicit constexpr FewerIfSanitized(unsigned one_of) : one_of_(one_of) {}
  constexpr bool leaves_out() { return kIsSanitized && next_++ % one_of_ != 0; }

 private:
  unsigned one_of_;
  unsigned next_ = 0;
};

// The same of a list, for tests with a parameter.
template <typename All>
All fewer_if_sanitized(unsigned one_of, All all) {
  FewerIfSanitized few(one_of);
  std::erase_if(all, [&](const auto&) { return few.leaves_out(); });
  return all;
}

}  // namespace fieldproof::kernel
