#pragma once
// How files are opened, by calls of the PPU side. [POSIX]

#include <sys/cdefs.h>
#include <sys/types.h>

#define O_RDONLY 0
#define O_WRONLY 1
#define O_RDWR 2
#define O_CREAT 0100
#define O_EXCL 0200
#define O_TRUNC 01000
#define O_APPEND 02000

__BEGIN_DECLS
/// @param flags  those above; with O_CREAT an argument more says what may be done with the file
/// @return       a number; -1 is an error, and errno says which
int open(const char* path, int flags, ...);
int creat(const char* path, mode_t mode);
__END_DECLS
