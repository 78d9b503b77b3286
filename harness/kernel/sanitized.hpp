#pragma once

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

}  // namespace fieldproof::kernel
