#pragma once
// Jumps out of nested calls. [C17, 7.13]

#include <sys/cdefs.h>

/// What a call keeps: rbx, rbp, r12 to r15, the stack pointer, where to go on.
typedef unsigned long long jmp_buf[8];

__BEGIN_DECLS
int setjmp(jmp_buf place) __attribute__((returns_twice));
void longjmp(jmp_buf place, int value) __attribute__((noreturn));
__END_DECLS
