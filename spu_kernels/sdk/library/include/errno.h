#pragma once
// The numbers of errors that programs compare with; no function of this library sets errno.

#define EPERM 1
#define ENOENT 2
#define EINTR 4
#define EIO 5
#define EAGAIN 11
#define ENOMEM 12
#define EINVAL 22
#define EDOM 33
#define ERANGE 34

static int errno __attribute__((unused));
