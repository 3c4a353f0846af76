#pragma once
// What old C has besides. The names are often those of variables, so that <string.h> leaves them out.

#include <string.h>

__BEGIN_DECLS
char* index(const char* s_, int c_) __asm__("strchr");
char* rindex(const char* s_, int c_) __asm__("strrchr");
/// The lowest bit that is set, from 1; 0: none.
static __inline__ __attribute__((unused)) int ffs(int bits) { return __builtin_ffs(bits); }
int bcmp(const void* a_, const void* b_, size_t bytes) __asm__("memcmp");
__END_DECLS
