// What the build's sanitizers do not bear.
#pragma once

namespace diatom {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kAddressSanitizer = true;
#else
inline constexpr bool kAddressSanitizer = false;
#endif
#else
inline constexpr bool kAddressSanitizer = false;
#endif

#if defined(__SANITIZE_THREAD__)
inline constexpr bool kThreadSanitizer = true;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif
#else
inline constexpr bool kThreadSanitizer = false;
#endif

/// Its runtime does not follow children of processes with threads.
inline constexpr bool kMayFork = !kThreadSanitizer;
/// Their shadows take more address space than any limit.
inline constexpr bool kMayLimitMemory = !kAddressSanitizer && !kThreadSanitizer;
/// What a time that something may take is multiplied by.
inline constexpr int kSlowdown = kAddressSanitizer || kThreadSanitizer ? 10 : 1;

} // namespace diatom
