#pragma once
// Names of numbers that POSIX headers share.

#include <stddef.h>
#include <stdint.h>

typedef int ssize_t;
typedef long off_t;
typedef unsigned int mode_t;
typedef unsigned int uint;
typedef unsigned short ushort;
typedef unsigned char u_char;
typedef unsigned short u_short;
typedef unsigned int u_int;
typedef unsigned long u_long;
