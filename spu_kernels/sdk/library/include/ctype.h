#pragma once
// Kinds of characters, in the locale "C". [C17, 7.4]

#include <sys/cdefs.h>

__BEGIN_DECLS
int isalnum(int c_);
int isalpha(int c_);
int isblank(int c_);
int iscntrl(int c_);
int isdigit(int c_);
int isgraph(int c_);
int islower(int c_);
int isprint(int c_);
int ispunct(int c_);
int isspace(int c_);
int isupper(int c_);
int isxdigit(int c_);
int tolower(int c_);
int toupper(int c_);
static __inline__ __attribute__((unused)) int isascii(int c_) { return (c_ & ~0x7F) == 0; }
static __inline__ __attribute__((unused)) int toascii(int c_) { return c_ & 0x7F; }
__END_DECLS
