#pragma once
// <immintrin.h> for programs that have macros of one letter: the compilers' headers have such names, a, b, f, i, u and v those of
// GCC 12, k, m, n and t those of Clang 14.

#pragma push_macro("a")
#undef a
#pragma push_macro("b")
#undef b
#pragma push_macro("f")
#undef f
#pragma push_macro("i")
#undef i
#pragma push_macro("k")
#undef k
#pragma push_macro("m")
#undef m
#pragma push_macro("n")
#undef n
#pragma push_macro("t")
#undef t
#pragma push_macro("u")
#undef u
#pragma push_macro("v")
#undef v

#include <immintrin.h>

#pragma pop_macro("a")
#pragma pop_macro("b")
#pragma pop_macro("f")
#pragma pop_macro("i")
#pragma pop_macro("k")
#pragma pop_macro("m")
#pragma pop_macro("n")
#pragma pop_macro("t")
#pragma pop_macro("u")
#pragma pop_macro("v")
