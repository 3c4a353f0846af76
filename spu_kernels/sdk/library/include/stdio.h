#pragma once
// Streams on the PPU side: each call stops the SPE until the PPU side has served it. Files are those of the process that runs the PPU side.
// [C17, 7.21]

#include <stdarg.h>
#include <stddef.h>
#include <sys/cdefs.h>

typedef struct softcell_file FILE;
typedef long fpos_t;
#define stdin ((FILE*)1)
#define stdout ((FILE*)2)
#define stderr ((FILE*)3)
#define EOF (-1)
#define BUFSIZ 1024
#define FILENAME_MAX 4096
#define FOPEN_MAX 64
#define _IOFBF 0
#define _IOLBF 1
#define _IONBF 2
#define SEEK_SET 0
#define SEEK_CUR 1
#define SEEK_END 2

__BEGIN_DECLS
int printf(const char* format, ...) __attribute__((format(printf, 1, 2)));
int fprintf(FILE* file, const char* format, ...) __attribute__((format(printf, 2, 3)));
int sprintf(char* to, const char* format, ...) __attribute__((format(printf, 2, 3)));
int snprintf(char* to, size_t bytes, const char* format, ...) __attribute__((format(printf, 3, 4)));
int vprintf(const char* format, va_list arguments);
int vfprintf(FILE* file, const char* format, va_list arguments);
int vsprintf(char* to, const char* format, va_list arguments);
int vsnprintf(char* to, size_t bytes, const char* format, va_list arguments);
/// The text is memory of malloc(). @return  -1 when there is no room
int asprintf(char** to, const char* format, ...) __attribute__((format(printf, 2, 3)));
int vasprintf(char** to, const char* format, va_list arguments);
/// As newlib has them for programs that print no floats: here they are the same functions.
int iprintf(const char* format, ...) __asm__("printf") __attribute__((format(printf, 1, 2)));
int fiprintf(FILE* file, const char* format, ...) __asm__("fprintf") __attribute__((format(printf, 2, 3)));
int siprintf(char* to, const char* format, ...) __asm__("sprintf") __attribute__((format(printf, 2, 3)));
int sniprintf(char* to, size_t bytes, const char* format, ...) __asm__("snprintf")
    __attribute__((format(printf, 3, 4)));
int puts(const char* text);
int putchar(int c_);
int fputs(const char* text, FILE* file);
int fputc(int c_, FILE* file);
int putc(int c_, FILE* file);
size_t fwrite(const void* from, size_t bytes, size_t count, FILE* file);
int fflush(FILE* file);
/// The buffers are those of the PPU side, and stay as they are.
void setbuf(FILE* file, char* buffer);
int setvbuf(FILE* file, char* buffer, int mode, size_t bytes);
void perror(const char* text);

int scanf(const char* format, ...) __attribute__((format(scanf, 1, 2)));
int fscanf(FILE* file, const char* format, ...) __attribute__((format(scanf, 2, 3)));
int sscanf(const char* text, const char* format, ...) __attribute__((format(scanf, 2, 3)));
int vscanf(const char* format, va_list arguments);
int vfscanf(FILE* file, const char* format, va_list arguments);
int vsscanf(const char* text, const char* format, va_list arguments);
int getchar(void);
int fgetc(FILE* file);
int getc(FILE* file);
int ungetc(int c_, FILE* file);
char* fgets(char* to, int bytes, FILE* file);
size_t fread(void* to, size_t bytes, size_t count, FILE* file);

/// At most FOPEN_MAX streams of all SPEs together. @return  null is an error, and errno says which
FILE* fopen(const char* path, const char* mode);
/// The stream leads to another file; of stdin, stdout and stderr it is that of the process.
FILE* freopen(const char* path, const char* mode, FILE* file);
FILE* tmpfile(void);
__attribute__((error("fdopen() is no call of the PPU side: open the file with fopen()"))) FILE* fdopen(
    int file, const char* mode);
int fclose(FILE* file);
int fseek(FILE* file, long offset, int from);
long ftell(FILE* file);
void rewind(FILE* file);
int fgetpos(FILE* file, fpos_t* to);
int fsetpos(FILE* file, const fpos_t* from);
int feof(FILE* file);
int ferror(FILE* file);
void clearerr(FILE* file);
int fileno(FILE* file);
int remove(const char* path);
int rename(const char* from, const char* to);
__END_DECLS
