#pragma once
// Calls that the PPU side serves: the SPE stands still until it has an answer. [newlib, jsre.h; libspe2, C99 and POSIX handlers] documented

#include <errno.h>
#include <softcell_environment.h>
#include <stdarg.h>
#include <stdint.h>

/// The body of a function with `...` behind its parameter `last`: the value of an expression in which `list` is its va_list.
#define SC_VARIADIC(last, expression) \
  va_list list;                       \
  va_start(list, last);               \
  const int result = expression;      \
  va_end(list);                       \
  return result

namespace softcell_library {

/// One argument: its value in word 0 of a quadword. The first one's quadword holds errno in word 3 after the call.
struct alignas(16) Argument {
  uint32_t value;
  uint32_t unused[2];
  int error;
};
template <class T>
Argument argument(T value) {
  return {static_cast<uint32_t>(value), {}, 0};
}
template <class T>
Argument argument(T* pointer) {
  return {static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer)), {}, 0};
}

enum Library : uint32_t { kC99 = 0, kPosix = 1 };  // stop codes less 0x2100

/// The numbers of its functions.
enum C99Call : uint32_t {
  kClearerr = 1,
  kFclose = 2,
  kFeof = 3,
  kFerror = 4,
  kFflush = 5,
  kFgetc = 6,
  kFgets = 8,
  kFileno = 9,
  kFopen = 10,
  kFputc = 11,
  kFputs = 12,
  kFread = 13,
  kFreopen = 14,
  kFseek = 15,
  kFtell = 17,
  kFwrite = 18,
  kGetchar = 20,
  kPutchar = 24,
  kPuts = 25,
  kRemove = 26,
  kRename = 27,
  kRewind = 28,
  kTmpfile = 32,
  kUngetc = 34,
  kVfprintf = 35,
  kVfscanf = 36,
  kVprintf = 37,
  kVscanf = 38,
  kVsnprintf = 39,
  kVsscanf = 41
};
enum PosixCall : uint32_t {
  kClose = 2,
  kFstat = 4,
  kGettimeofday = 7,
  kLseek = 9,
  kLstat = 10,
  kOpen = 15,
  kRead = 16,
  kStat = 23,
  kUnlink = 24,
  kWrite = 27,
  kFtruncate = 28,
  kAccess = 29,
  kNanosleep = 32
};

template <class... Values>
uint32_t assist(Library library, uint32_t function, Values... values) {
  Argument arguments[] = {argument(values)..., argument(0)};
  const uint32_t request = function << 24 | softcell_sdk::local_store_address(arguments);
  const uint32_t result = softcell_sdk::call_gate(softcell_sdk::kAssist, library, request);
  if (arguments[0].error != 0) errno = arguments[0].error;
  return result;
}
template <class... Values>
int call(C99Call function, Values... values) {
  return static_cast<int>(assist(kC99, function, values...));
}
template <class... Values>
int call(PosixCall function, Values... values) {
  return static_cast<int>(assist(kPosix, function, values...));
}

}  // namespace softcell_library
