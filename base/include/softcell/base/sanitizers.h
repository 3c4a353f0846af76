#pragma once
// Tells which sanitizer the code is compiled with, for code that has to differ then: SC_ADDRESS_SANITIZER and SC_THREAD_SANITIZER are 0 or
// 1. GCC defines macros, Clang has features.

#if defined(__has_feature)
#define SC_HAS_FEATURE(feature) __has_feature(feature)
#else
#define SC_HAS_FEATURE(feature) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || SC_HAS_FEATURE(address_sanitizer)
#define SC_ADDRESS_SANITIZER 1
#else
#define SC_ADDRESS_SANITIZER 0
#endif

#if defined(__SANITIZE_THREAD__) || SC_HAS_FEATURE(thread_sanitizer)
#define SC_THREAD_SANITIZER 1
#else
#define SC_THREAD_SANITIZER 0
#endif
