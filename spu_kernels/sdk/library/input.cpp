// stdio.h: what reads.

#include <stdio.h>

#include "assist.h"

using namespace softcell_library;

extern "C" {

int vscanf(const char* format, va_list list) { return call(kVscanf, format, list); }
int vfscanf(FILE* file, const char* format, va_list list) { return call(kVfscanf, file, format, list); }
int vsscanf(const char* text, const char* format, va_list list) { return call(kVsscanf, text, format, list); }

int scanf(const char* format, ...) { SC_VARIADIC(format, vscanf(format, list)); }
int fscanf(FILE* file, const char* format, ...) { SC_VARIADIC(format, vfscanf(file, format, list)); }
int sscanf(const char* text, const char* format, ...) { SC_VARIADIC(format, vsscanf(text, format, list)); }

int getchar() { return call(kGetchar); }
int fgetc(FILE* file) { return call(kFgetc, file); }
int getc(FILE* file) { return fgetc(file); }
int ungetc(int c, FILE* file) { return call(kUngetc, c, file); }
char* fgets(char* to, int bytes, FILE* file) { return call(kFgets, to, bytes, file) == 0 ? nullptr : to; }
size_t fread(void* to, size_t bytes, size_t count, FILE* file) {
  return static_cast<size_t>(call(kFread, to, bytes, count, file));
}

}  // extern "C"
