// stdio.h: what prints.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assist.h"

using namespace softcell_library;

extern "C" {

int vprintf(const char* format, va_list list) { return call(kVprintf, format, list); }
int vfprintf(FILE* file, const char* format, va_list list) { return call(kVfprintf, file, format, list); }
int vsnprintf(char* to, size_t bytes, const char* format, va_list list) {
  return call(kVsnprintf, to, bytes, format, list);
}
int vsprintf(char* to, const char* format, va_list list) { return vsnprintf(to, 0x40000, format, list); }

int vasprintf(char** to, const char* format, va_list list) {
  va_list again;
  va_copy(again, list);
  const int length = vsnprintf(nullptr, 0, format, again);
  va_end(again);
  *to = length < 0 ? nullptr : static_cast<char*>(malloc(static_cast<size_t>(length) + 1));
  return *to == nullptr ? -1 : vsnprintf(*to, static_cast<size_t>(length) + 1, format, list);
}
int asprintf(char** to, const char* format, ...) { SC_VARIADIC(format, vasprintf(to, format, list)); }

int printf(const char* format, ...) { SC_VARIADIC(format, vprintf(format, list)); }
int fprintf(FILE* file, const char* format, ...) { SC_VARIADIC(format, vfprintf(file, format, list)); }
int snprintf(char* to, size_t bytes, const char* format, ...) {
  SC_VARIADIC(format, vsnprintf(to, bytes, format, list));
}
int sprintf(char* to, const char* format, ...) { SC_VARIADIC(format, vsprintf(to, format, list)); }

void setbuf(FILE*, char*) {}
int setvbuf(FILE*, char*, int, size_t) { return 0; }

int puts(const char* text) { return call(kPuts, text); }
int putchar(int c) { return call(kPutchar, c); }
int fputs(const char* text, FILE* file) { return call(kFputs, text, file); }
int fputc(int c, FILE* file) { return call(kFputc, c, file); }
int putc(int c, FILE* file) { return fputc(c, file); }
size_t fwrite(const void* from, size_t bytes, size_t count, FILE* file) {
  return static_cast<size_t>(call(kFwrite, from, bytes, count, file));
}
int fflush(FILE* file) { return call(kFflush, file); }

void perror(const char* text) {
  const char* const said = strerror(errno);
  if (text != nullptr && *text != '\0')
    fprintf(stderr, "%s: %s\n", text, said);
  else
    fprintf(stderr, "%s\n", said);
}

}  // extern "C"
