/* The vector types of C kernels: the compiler's own, with all that it does with vectors. Lane 0 is first in memory, each lane in the
 * host's byte order.
 *
 * In C a cast between vectors cannot be redefined. softcell_vector_casts, which reads each C source before the compiler does, makes
 * those between lane widths calls of softcell_regroup(), so that they mean what they mean on an SPU.
 */
#ifndef SOFTCELL_C_TYPES_H
#define SOFTCELL_C_TYPES_H

#include <stdint.h>

#define SC_C_INLINE static __inline__ __attribute__((always_inline, unused))

typedef unsigned char vec_uchar16 __attribute__((vector_size(16), may_alias));
typedef signed char vec_char16 __attribute__((vector_size(16), may_alias));
typedef unsigned short vec_ushort8 __attribute__((vector_size(16), may_alias));
typedef signed short vec_short8 __attribute__((vector_size(16), may_alias));
typedef unsigned int vec_uint4 __attribute__((vector_size(16), may_alias));
typedef signed int vec_int4 __attribute__((vector_size(16), may_alias));
typedef unsigned long long vec_ullong2 __attribute__((vector_size(16), may_alias));
typedef signed long long vec_llong2 __attribute__((vector_size(16), may_alias));
typedef float vec_float4 __attribute__((vector_size(16), may_alias));
typedef double vec_double2 __attribute__((vector_size(16), may_alias));
/* A register without a type: lanes of four bytes. */
typedef vec_uint4 qword;

/* As the SPU's compilers spell vectors; `vector` before a type's name is made that attribute by softcell_vector_casts. */
#define __vector __attribute__((vector_size(16)))

/* Byte j of the result is byte j ^ flip: from one lane width to another. `flip` is a constant. */
SC_C_INLINE vec_uchar16 softcell_regroup(vec_uchar16 a_, unsigned int flip) {
#define SC_C_FLIP(f)                                                                                      \
  case f:                                                                                                 \
    return __builtin_shufflevector(a_, a_, 0 ^ f, 1 ^ f, 2 ^ f, 3 ^ f, 4 ^ f, 5 ^ f, 6 ^ f, 7 ^ f, 8 ^ f, \
                                   9 ^ f, 10 ^ f, 11 ^ f, 12 ^ f, 13 ^ f, 14 ^ f, 15 ^ f);
  switch (flip) {
    SC_C_FLIP(1)
    SC_C_FLIP(2)
    SC_C_FLIP(3)
    SC_C_FLIP(4)
    SC_C_FLIP(6)
    SC_C_FLIP(7)
    default:
      return a_;
  }
#undef SC_C_FLIP
}

#endif
