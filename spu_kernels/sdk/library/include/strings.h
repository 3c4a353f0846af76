#pragma once
// What old C has besides. The names are often those of variables, so that <string.h> leaves them out.

#include <string.h>

__BEGIN_DECLS
char* index(const char* s_, int c_) __asm__("strchr");
char* rindex(const char* s_, int c_) __asm__("strrchr");
int bcmp(const void* a_, const void* b_, size_t bytes) __asm__("memcmp");
__END_DECLS
