// Streams of stdio.h, and files of unistd.h and fcntl.h.

#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assist.h"

using namespace softcell_library;

static FILE* stream(int handle) { return reinterpret_cast<FILE*>(static_cast<uintptr_t>(handle)); }

extern "C" {

int errno;

FILE* fopen(const char* path, const char* mode) { return stream(call(kFopen, path, mode)); }
FILE* freopen(const char* path, const char* mode, FILE* file) {
  return stream(call(kFreopen, path, mode, file));
}
FILE* tmpfile() { return stream(call(kTmpfile)); }
int fclose(FILE* file) { return call(kFclose, file); }
int fseek(FILE* file, long offset, int from) { return call(kFseek, file, offset, from); }
long ftell(FILE* file) { return call(kFtell, file); }
int fgetpos(FILE* file, fpos_t* to) {
  *to = ftell(file);
  return *to < 0 ? -1 : 0;
}
int fsetpos(FILE* file, const fpos_t* from) { return fseek(file, *from, SEEK_SET); }
void rewind(FILE* file) { call(kRewind, file); }
int feof(FILE* file) { return call(kFeof, file); }
int ferror(FILE* file) { return call(kFerror, file); }
void clearerr(FILE* file) { call(kClearerr, file); }
int fileno(FILE* file) { return call(kFileno, file); }
int remove(const char* path) { return call(kRemove, path); }
int rename(const char* from, const char* to) { return call(kRename, from, to); }

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const int mode = (flags & O_CREAT) != 0 ? va_arg(list, int) : 0;
  va_end(list);
  return call(kOpen, path, flags, mode);
}
int creat(const char* path, mode_t mode) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
int close(int file) { return call(kClose, file); }
ssize_t read(int file, void* to, size_t bytes) { return call(kRead, file, to, bytes); }
ssize_t write(int file, const void* from, size_t bytes) { return call(kWrite, file, from, bytes); }
off_t lseek(int file, off_t offset, int from) { return call(kLseek, file, offset, from); }
int ftruncate(int file, off_t length) { return call(kFtruncate, file, length); }
int access(const char* path, int mode) { return call(kAccess, path, mode); }
int unlink(const char* path) { return call(kUnlink, path); }
int stat(const char* path, struct stat* to) { return call(kStat, path, to); }
int lstat(const char* path, struct stat* to) { return call(kLstat, path, to); }
int fstat(int file, struct stat* to) { return call(kFstat, file, to); }

}  // extern "C"
