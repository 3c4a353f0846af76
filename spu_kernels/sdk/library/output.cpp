// stdio.h: each function is a call of the PPU side. [newlib, jsre.h] documented

#include <softcell_environment.h>
#include <stdio.h>

namespace {

/// The value of one argument, in word 0 of a quadword.
struct alignas(16) Argument {
  uint32_t value;
};
template <class T>
Argument argument(T value) {
  return {static_cast<uint32_t>(value)};
}
template <class T>
Argument argument(T* pointer) {
  return {static_cast<uint32_t>(reinterpret_cast<uintptr_t>(pointer))};
}

enum Call : uint32_t {
  kFflush = 5,
  kFputc = 11,
  kFputs = 12,
  kFwrite = 18,
  kPutchar = 24,
  kPuts = 25,
  kVfprintf = 35,
  kVprintf = 37,
  kVsnprintf = 39
};

template <class... Values>
int call(Call function, Values... values) {
  Argument arguments[] = {argument(values)...};
  const uint32_t request =
      static_cast<uint32_t>(function) << 24 | softcell_sdk::local_store_address(arguments);
  return static_cast<int>(softcell_sdk::call_gate(softcell_sdk::kAssist, 0, request));
}

}  // namespace

extern "C" {

int vprintf(const char* format, va_list list) { return call(kVprintf, format, list); }
int vfprintf(FILE* file, const char* format, va_list list) { return call(kVfprintf, file, format, list); }
int vsnprintf(char* to, size_t bytes, const char* format, va_list list) {
  return call(kVsnprintf, to, bytes, format, list);
}
int vsprintf(char* to, const char* format, va_list list) { return vsnprintf(to, 0x40000, format, list); }

#define SC_VARIADIC(last, expression) \
  va_list list;                       \
  va_start(list, last);               \
  const int result = expression;      \
  va_end(list);                       \
  return result
int printf(const char* format, ...) { SC_VARIADIC(format, vprintf(format, list)); }
int fprintf(FILE* file, const char* format, ...) { SC_VARIADIC(format, vfprintf(file, format, list)); }
int snprintf(char* to, size_t bytes, const char* format, ...) {
  SC_VARIADIC(format, vsnprintf(to, bytes, format, list));
}
int sprintf(char* to, const char* format, ...) { SC_VARIADIC(format, vsprintf(to, format, list)); }

int puts(const char* text) { return call(kPuts, text); }
int putchar(int c) { return call(kPutchar, c); }
int fputs(const char* text, FILE* file) { return call(kFputs, text, file); }
int fputc(int c, FILE* file) { return call(kFputc, c, file); }
int putc(int c, FILE* file) { return fputc(c, file); }
size_t fwrite(const void* from, size_t bytes, size_t count, FILE* file) {
  return static_cast<size_t>(call(kFwrite, from, bytes, count, file));
}
int fflush(FILE* file) { return call(kFflush, file); }

}  // extern "C"
