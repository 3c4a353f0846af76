#pragma once
// Output on the PPU side: each call stops the SPE until the PPU side has served it. There are no files and no input. [C17, 7.21]

#include <stdarg.h>
#include <stddef.h>
#include <sys/cdefs.h>

typedef struct softcell_file FILE;
#define stdout ((FILE*)2)
#define stderr ((FILE*)3)
#define EOF (-1)

__BEGIN_DECLS
int printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
int fprintf(FILE* file, const char* format, ...) __attribute__((format(printf, 2, 3)));
int sprintf(char* to, const char* format, ...) __attribute__((format(printf, 2, 3)));
int snprintf(char* to, size_t bytes, const char* format, ...) __attribute__((format(printf, 3, 4)));
int vprintf(const char* format, va_list arguments);
int vfprintf(FILE* file, const char* format, va_list arguments);
int vsprintf(char* to, const char* format, va_list arguments);
int vsnprintf(char* to, size_t bytes, const char* format, va_list arguments);
int puts(const char* text);
int putchar(int c);
int fputs(const char* text, FILE* file);
int fputc(int c, FILE* file);
int putc(int c, FILE* file);
size_t fwrite(const void* from, size_t bytes, size_t count, FILE* file);
int fflush(FILE* file);
__END_DECLS
