#pragma once
// What is known of a file, by calls of the PPU side. [POSIX]

#include <sys/cdefs.h>
#include <sys/types.h>

#define S_IFMT 0170000
#define S_IFSOCK 0140000
#define S_IFLNK 0120000
#define S_IFREG 0100000
#define S_IFBLK 0060000
#define S_IFDIR 0040000
#define S_IFCHR 0020000
#define S_IFIFO 0010000
#define S_ISSOCK(mode) (((mode)&S_IFMT) == S_IFSOCK)
#define S_ISLNK(mode) (((mode)&S_IFMT) == S_IFLNK)
#define S_ISREG(mode) (((mode)&S_IFMT) == S_IFREG)
#define S_ISBLK(mode) (((mode)&S_IFMT) == S_IFBLK)
#define S_ISDIR(mode) (((mode)&S_IFMT) == S_IFDIR)
#define S_ISCHR(mode) (((mode)&S_IFMT) == S_IFCHR)
#define S_ISFIFO(mode) (((mode)&S_IFMT) == S_IFIFO)
#define S_ISUID 04000
#define S_ISGID 02000
#define S_ISVTX 01000
#define S_IRWXU 0700
#define S_IRUSR 0400
#define S_IWUSR 0200
#define S_IXUSR 0100
#define S_IRWXG 0070
#define S_IRGRP 0040
#define S_IWGRP 0020
#define S_IXGRP 0010
#define S_IRWXO 0007
#define S_IROTH 0004
#define S_IWOTH 0002
#define S_IXOTH 0001

/// In the order in which the PPU side writes it: a word each, the times in seconds since 1970.
struct stat {
  unsigned int st_dev, st_ino;
  mode_t st_mode;
  unsigned int st_nlink, st_uid, st_gid, st_rdev;
  off_t st_size;
  long st_blksize, st_blocks, st_atime, st_mtime, st_ctime;
};

__BEGIN_DECLS
/// A file of more than 2^31 - 1 bytes fails with EOVERFLOW.
int stat(const char* path, struct stat* to);
int lstat(const char* path, struct stat* to);
int fstat(int file, struct stat* to);

#define SC_NOT_SERVED(name) \
  __attribute__((error(name "() is not served here: the PPU side may call it for its SPEs")))
SC_NOT_SERVED("chmod") int chmod(const char* path, mode_t mode);
SC_NOT_SERVED("mkdir") int mkdir(const char* path, mode_t mode);
SC_NOT_SERVED("umask") mode_t umask(mode_t mask);
#undef SC_NOT_SERVED
__END_DECLS
