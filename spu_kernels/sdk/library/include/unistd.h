#pragma once
// Files by number, and waiting, by calls of the PPU side: each stops the SPE until it is served. The numbers are those of the process that
// runs the PPU side. [POSIX]

#include <stddef.h>
#include <sys/cdefs.h>
#include <sys/types.h>

#define STDIN_FILENO 0
#define STDOUT_FILENO 1
#define STDERR_FILENO 2
#define SEEK_SET 0
#define SEEK_CUR 1
#define SEEK_END 2
#define F_OK 0
#define X_OK 1
#define W_OK 2
#define R_OK 4

__BEGIN_DECLS
int close(int file);
/// At most 256 KB. @return  how many bytes there were
ssize_t read(int file, void* to, size_t bytes);
ssize_t write(int file, const void* from, size_t bytes);
off_t lseek(int file, off_t offset, int from);
int ftruncate(int file, off_t length);
/// Whether a file can be opened: X_OK is not looked at.
int access(const char* path, int mode);
int unlink(const char* path);
unsigned int sleep(unsigned int seconds);
int usleep(unsigned int microseconds);
void _exit(int status) __attribute__((noreturn));

#define SC_NOT_SERVED(name) \
  __attribute__((error(name "() is not served here: the PPU side may call it for its SPEs")))
SC_NOT_SERVED("chdir") int chdir(const char* path);
SC_NOT_SERVED("dup") int dup(int file);
SC_NOT_SERVED("dup2") int dup2(int file, int as);
SC_NOT_SERVED("fsync") int fsync(int file);
SC_NOT_SERVED("getcwd") char* getcwd(char* to, size_t bytes);
SC_NOT_SERVED("getpid") int getpid(void);
SC_NOT_SERVED("link") int link(const char* from, const char* to);
SC_NOT_SERVED("rmdir") int rmdir(const char* path);
SC_NOT_SERVED("symlink") int symlink(const char* from, const char* to);
SC_NOT_SERVED("truncate") int truncate(const char* path, off_t length);
#undef SC_NOT_SERVED
__END_DECLS
