// What the thread sanitizer's build of a program calls for __sync_*, __atomic_* and _Atomic. One thread runs in a local store, so each
// is a load, a store or both, which are reported as others are.

#include "report.h"

#define SC_LOAD(at) SC_REPORT(at, sizeof *(at), kLoad)
#define SC_LOAD_AND_STORE(at) \
  SC_LOAD(at);                \
  SC_REPORT(at, sizeof *(at), kStore)

/// Gives `value_after`, in which `before` is the old value, to the variable.
#define SC_CHANGE(bits, name, value_after)                                                                  \
  extern "C" uint##bits##_t __tsan_atomic##bits##_##name(volatile uint##bits##_t* at, uint##bits##_t value, \
                                                         int) {                                             \
    SC_LOAD_AND_STORE(at);                                                                                  \
    const uint##bits##_t before = *at;                                                                      \
    *at = static_cast<uint##bits##_t>(value_after);                                                         \
    return before;                                                                                          \
  }

#define SC_COMPARE_EXCHANGE(bits, name)                                                        \
  extern "C" int __tsan_atomic##bits##_compare_exchange_##name(                                \
      volatile uint##bits##_t* at, uint##bits##_t* expected, uint##bits##_t value, int, int) { \
    SC_LOAD_AND_STORE(at);                                                                     \
    const uint##bits##_t before = *at;                                                         \
    if (before == *expected) {                                                                 \
      *at = value;                                                                             \
      return 1;                                                                                \
    }                                                                                          \
    *expected = before;                                                                        \
    return 0;                                                                                  \
  }

#define SC_EACH(bits)                                                                                   \
  extern "C" uint##bits##_t __tsan_atomic##bits##_load(const volatile uint##bits##_t* at, int) {        \
    SC_LOAD(at);                                                                                        \
    return *at;                                                                                         \
  }                                                                                                     \
  extern "C" void __tsan_atomic##bits##_store(volatile uint##bits##_t* at, uint##bits##_t value, int) { \
    SC_REPORT(at, sizeof *at, kStore);                                                                  \
    *at = value;                                                                                        \
  }                                                                                                     \
  SC_CHANGE(bits, exchange, value)                                                                      \
  SC_CHANGE(bits, fetch_add, before + value)                                                            \
  SC_CHANGE(bits, fetch_sub, before - value)                                                            \
  SC_CHANGE(bits, fetch_and, before& value)                                                             \
  SC_CHANGE(bits, fetch_or, before | value)                                                             \
  SC_CHANGE(bits, fetch_xor, before ^ value)                                                            \
  SC_CHANGE(bits, fetch_nand, ~(before & value))                                                        \
  SC_COMPARE_EXCHANGE(bits, strong)                                                                     \
  SC_COMPARE_EXCHANGE(bits, weak)                                                                       \
  extern "C" uint##bits##_t __tsan_atomic##bits##_compare_exchange_val(                                 \
      volatile uint##bits##_t* at, uint##bits##_t expected, uint##bits##_t value, int, int) {           \
    SC_LOAD_AND_STORE(at);                                                                              \
    const uint##bits##_t before = *at;                                                                  \
    if (before == expected) *at = value;                                                                \
    return before;                                                                                      \
  }
SC_EACH(8)
SC_EACH(16)
SC_EACH(32)
SC_EACH(64)

extern "C" void __tsan_atomic_thread_fence(int) {}
extern "C" void __tsan_atomic_signal_fence(int) {}
