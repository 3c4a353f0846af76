/* The generic intrinsics, spu_*, for C: macros that choose a function by the type of their operands.  [LEXT, generic intrinsics]
 * documented
 */
#ifndef SOFTCELL_C_GENERIC_H
#define SOFTCELL_C_GENERIC_H

#include "../shared/softcell_channels.h"
#include "../shared/softcell_generic_names.h"
#include "../shared/softcell_special_values.h"
#include "softcell_c_environment.h"

#define SC_C_NAME(name, V) softcell_c_##name##_##V
#define SC_C_V_V(name, V, S, U, I) V SC_C_NAME(name, V)(V);
#define SC_C_U_V(name, V, S, U, I) U SC_C_NAME(name, V)(V);
#define SC_C_B_V(name, V, S, U, I) vec_uint4 SC_C_NAME(name, V)(V);
#define SC_C_V_VV(name, V, S, U, I) V SC_C_NAME(name, V)(V, V);
#define SC_C_U_VV(name, V, S, U, I) U SC_C_NAME(name, V)(V, V);
#define SC_C_V_VVV(name, V, S, U, I) V SC_C_NAME(name, V)(V, V, V);
#define SC_C_V_VVU(name, V, S, U, I) V SC_C_NAME(name, V)(V, V, U);
#define SC_C_V_VVP(name, V, S, U, I) V SC_C_NAME(name, V)(V, V, vec_uchar16);
#define SC_C_V_VU(name, V, S, U, I) V SC_C_NAME(name, V)(V, U);
#define SC_C_V_VI(name, V, S, U, I) V SC_C_NAME(name, V)(V, I);
#define SC_C_V_VN(name, V, S, U, I) V SC_C_NAME(name, V)(V, int);
#define SC_C_1(R, name, A) R SC_C_NAME(name, A)(A);
#define SC_C_2(R, name, A, B) R SC_C_NAME(name, A)(A, B);
#define SC_C_3(R, name, A, B, C) R SC_C_NAME(name, A)(A, B, C);
#define SC_C_Q1(name) qword softcell_c_si_##name(qword);
#define SC_C_Q2(name) qword softcell_c_si_##name(qword, qword);
#define SC_C_Q3(name) qword softcell_c_si_##name(qword, qword, qword);
#include "softcell_c_rows.h"

/* What the compiler's vectors do by themselves needs no function. Integer sums wrap: they are made of unsigned lanes. */
#define SC_C_INTEGER(name, V, S, U, I)                                        \
  SC_C_INLINE V softcell_c_add_##V(V a_, V b_) { return (V)((U)a_ + (U)b_); } \
  SC_C_INLINE V softcell_c_sub_##V(V a_, V b_) { return (V)((U)a_ - (U)b_); }
SC_C_16_32(SC_C_INTEGER, )
/* Single precision is one instruction of the host each, as in softcell_single.h: an exact zero of a product is +0. */
SC_C_INLINE vec_float4 softcell_c_add_vec_float4(vec_float4 a_, vec_float4 b_) { return a_ + b_; }
SC_C_INLINE vec_float4 softcell_c_sub_vec_float4(vec_float4 a_, vec_float4 b_) { return a_ - b_; }
SC_C_INLINE vec_float4 softcell_c_madd_vec_float4(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return __builtin_ia32_vfmaddps(a_, b_, c_);
}
SC_C_INLINE vec_float4 softcell_c_mul_vec_float4(vec_float4 a_, vec_float4 b_) {
  return softcell_c_madd_vec_float4(a_, b_, (vec_float4)(vec_uint4){0});
}
SC_C_INLINE vec_float4 softcell_c_msub_vec_float4(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return softcell_c_madd_vec_float4(a_, b_, -c_);
}
SC_C_INLINE vec_float4 softcell_c_nmsub_vec_float4(vec_float4 a_, vec_float4 b_, vec_float4 c_) {
  return softcell_c_madd_vec_float4(-a_, b_, c_);
}
#define SC_C_COMPARED(name, V, S, U, I)                                    \
  SC_C_INLINE U softcell_c_cmpeq_##V(V a_, V b_) { return (U)(a_ == b_); } \
  SC_C_INLINE U softcell_c_cmpgt_##V(V a_, V b_) { return (U)(a_ > b_); }
SC_C_8_16_32(SC_C_COMPARED, )
#undef SC_C_COMPARED
#define SC_C_ANY(name, V, S, U, I)                                               \
  SC_C_INLINE V softcell_c_splats_##V(S s_) {                                    \
    S lanes[16 / sizeof(S)];                                                     \
    V v_;                                                                        \
    unsigned int i_;                                                             \
    for (i_ = 0; i_ < 16 / sizeof(S); ++i_) lanes[i_] = s_;                      \
    __builtin_memcpy(&v_, lanes, 16);                                            \
    return v_;                                                                   \
  }                                                                              \
  SC_C_INLINE V softcell_c_insert_##V(S s_, V a_, int element) {                 \
    a_[(unsigned int)element & (16 / sizeof(S) - 1)] = s_;                       \
    return a_;                                                                   \
  }                                                                              \
  SC_C_INLINE S softcell_c_extract_##V(V a_, int element) {                      \
    return a_[(unsigned int)element & (16 / sizeof(S) - 1)];                     \
  }                                                                              \
  SC_C_INLINE V softcell_c_and_##V(V a_, V b_) { return (V)((U)a_ & (U)b_); }    \
  SC_C_INLINE V softcell_c_or_##V(V a_, V b_) { return (V)((U)a_ | (U)b_); }     \
  SC_C_INLINE V softcell_c_xor_##V(V a_, V b_) { return (V)((U)a_ ^ (U)b_); }    \
  SC_C_INLINE V softcell_c_andc_##V(V a_, V b_) { return (V)((U)a_ & ~(U)b_); }  \
  SC_C_INLINE V softcell_c_orc_##V(V a_, V b_) { return (V)((U)a_ | ~(U)b_); }   \
  SC_C_INLINE V softcell_c_nand_##V(V a_, V b_) { return (V) ~((U)a_ & (U)b_); } \
  SC_C_INLINE V softcell_c_nor_##V(V a_, V b_) { return (V) ~((U)a_ | (U)b_); }  \
  SC_C_INLINE V softcell_c_eqv_##V(V a_, V b_) { return (V) ~((U)a_ ^ (U)b_); }  \
  SC_C_INLINE V softcell_c_sel_##V(V a_, V b_, U c_) { return (V)(((U)a_ & ~c_) | ((U)b_ & c_)); }
SC_C_ALL(SC_C_ANY, )
#undef SC_C_INTEGER
#undef SC_C_ANY

/* Lists of a function's types. */
#define SC_C_CASES_8(f) \
  vec_uchar16:          \
  SC_C_NAME(f, vec_uchar16), vec_char16 : SC_C_NAME(f, vec_char16)
#define SC_C_CASES_16(f) \
  vec_ushort8:           \
  SC_C_NAME(f, vec_ushort8), vec_short8 : SC_C_NAME(f, vec_short8)
#define SC_C_CASES_32(f) \
  vec_uint4:             \
  SC_C_NAME(f, vec_uint4), vec_int4 : SC_C_NAME(f, vec_int4) SC_C_CASES_COMPARISON(f)
#ifdef __clang__
/* What Clang makes of a comparison of words. */
typedef long softcell_comparison __attribute__((vector_size(16)));
#define SC_C_CASES_COMPARISON(f) , softcell_comparison : SC_C_NAME(f, vec_int4)
#else
#define SC_C_CASES_COMPARISON(f)
#endif
#define SC_C_CASES_64(f) \
  vec_ullong2:           \
  SC_C_NAME(f, vec_ullong2), vec_llong2 : SC_C_NAME(f, vec_llong2)
#define SC_C_CASES_REAL(f) \
  vec_float4:              \
  SC_C_NAME(f, vec_float4), vec_double2 : SC_C_NAME(f, vec_double2)
#define SC_C_CASES_16_32(f) SC_C_CASES_16(f), SC_C_CASES_32(f)
#define SC_C_CASES_8_16_32(f) SC_C_CASES_8(f), SC_C_CASES_16_32(f)
#define SC_C_CASES_ALL(f) SC_C_CASES_8_16_32(f), SC_C_CASES_64(f), SC_C_CASES_REAL(f)
#define SC_C_PICK(list, f, a) _Generic(a, list(f), default : softcell_c_nothing)
int softcell_c_nothing();

/* Operands of types that an intrinsic has no form for are told from others before the call, so that the compiler says one sentence. What
 * stands for them is of types that fit. */
#define SC_C_NO_FORM(name) SOFTCELL_HAS_NO_FORM(name) void no_form_of_spu_##name(void);
SOFTCELL_GENERIC_NAMES(SC_C_NO_FORM)
SC_C_NO_FORM(convtf)
#undef SC_C_NO_FORM
#define SC_C_KNOWN(name, V, S, U, I) softcell_c_known_##V = 1,
enum { SC_C_ALL(SC_C_KNOWN, ) softcell_c_known_softcell_comparison = 1 };
#undef SC_C_KNOWN
#define SC_C_IN(list, a) _Generic((a), list(known), default : 0)
#ifdef __clang__ /* whose vectors change their types by themselves */
#define SC_C_SAME(a, b) 1
#else
#define SC_C_SAME(a, b) __builtin_types_compatible_p(__typeof__(a), __typeof__(b))
#endif
#define SC_C_DEMAND(f, condition) \
  if (!(condition)) no_form_of_spu_##f()
#define SC_C_IF(condition, a, otherwise) __builtin_choose_expr(condition, a, otherwise)

/* A scalar operand becomes a vector of the other's type. */
#define SC_C_SPLAT(V, S)                                                              \
  SC_C_INLINE V softcell_c_like_scalar_##V(S s_) { return SC_C_NAME(splats, V)(s_); } \
  SC_C_INLINE V softcell_c_like_vector_##V(V v_) { return v_; }
SC_C_SPLAT(vec_uchar16, unsigned char)
SC_C_SPLAT(vec_char16, signed char)
SC_C_SPLAT(vec_ushort8, unsigned short)
SC_C_SPLAT(vec_short8, short)
SC_C_SPLAT(vec_uint4, unsigned int)
SC_C_SPLAT(vec_int4, int)
SC_C_SPLAT(vec_ullong2, unsigned long long)
SC_C_SPLAT(vec_llong2, long long)
SC_C_SPLAT(vec_float4, float)
SC_C_SPLAT(vec_double2, double)
#undef SC_C_SPLAT
#define SC_C_LIKE(b, V) _Generic((b), V : SC_C_NAME(like_vector, V), default : SC_C_NAME(like_scalar, V))
#define SC_C_AS(a, b)                               \
  (_Generic((a), vec_uchar16                        \
            : SC_C_LIKE(b, vec_uchar16), vec_char16 \
            : SC_C_LIKE(b, vec_char16), vec_ushort8 \
            : SC_C_LIKE(b, vec_ushort8), vec_short8 \
            : SC_C_LIKE(b, vec_short8), vec_uint4   \
            : SC_C_LIKE(b, vec_uint4), vec_int4     \
            : SC_C_LIKE(b, vec_int4), vec_ullong2   \
            : SC_C_LIKE(b, vec_ullong2), vec_llong2 \
            : SC_C_LIKE(b, vec_llong2), vec_float4  \
            : SC_C_LIKE(b, vec_float4), vec_double2 \
            : SC_C_LIKE(b, vec_double2), default    \
            : softcell_c_nothing)(b))

/* Each operand is evaluated, and written out, once: macros in macros would grow without bound. It comes in parentheses, as an SPU's
 * compiler has functions here: what a program's macro expands to, such as (vec_uchar16){0, 1, ...}, has commas that separate no arguments.
 */
#define SC_C_CALL1(list, f, a)                                          \
  __extension__({                                                       \
    __auto_type sc_1 = (a);                                             \
    SC_C_DEMAND(f, SC_C_IN(list, sc_1));                                \
    SC_C_IF(SC_C_IN(list, sc_1), SC_C_PICK(list, f, sc_1)(sc_1), sc_1); \
  })
/* The second operand an int. */
#define SC_C_CALL2_INT(list, f, a, n)                                         \
  __extension__({                                                             \
    __auto_type sc_1 = (a);                                                   \
    __auto_type sc_2 = (n);                                                   \
    SC_C_DEMAND(f, SC_C_IN(list, sc_1));                                      \
    SC_C_IF(SC_C_IN(list, sc_1), SC_C_PICK(list, f, sc_1)(sc_1, sc_2), sc_1); \
  })
/* Both of one type. */
#define SC_C_CALL2(list, f, a, b)                                                                            \
  __extension__({                                                                                            \
    __auto_type sc_1 = (a);                                                                                  \
    __auto_type sc_2 = (b);                                                                                  \
    SC_C_DEMAND(f, SC_C_IN(list, sc_1) && SC_C_SAME(sc_1, sc_2));                                            \
    SC_C_IF(SC_C_IN(list, sc_1), SC_C_PICK(list, f, sc_1)(sc_1, SC_C_IF(SC_C_SAME(sc_1, sc_2), sc_2, sc_1)), \
            sc_1);                                                                                           \
  })
/* The first two of one type, the third of that of `third`. */
#define SC_C_CALL3_AND(list, f, a, b, c, third)                                                   \
  __extension__({                                                                                 \
    __auto_type sc_1 = (a);                                                                       \
    __auto_type sc_2 = (b);                                                                       \
    __auto_type sc_3 = (c);                                                                       \
    SC_C_DEMAND(f, SC_C_IN(list, sc_1) && SC_C_SAME(sc_1, sc_2) && SC_C_SAME(third(sc_1), sc_3)); \
    SC_C_IF(SC_C_IN(list, sc_1),                                                                  \
            SC_C_PICK(list, f, sc_1)(sc_1, SC_C_IF(SC_C_SAME(sc_1, sc_2), sc_2, sc_1),            \
                                     SC_C_IF(SC_C_SAME(third(sc_1), sc_3), sc_3, third(sc_1))),   \
            sc_1);                                                                                \
  })
#define SC_C_CALL3(list, f, a, b, c) SC_C_CALL3_AND(list, f, a, b, c, SC_C_THE_SAME)
#define SC_C_THE_SAME(a) (a)
#define SC_C_ZERO(V) ((V){0})
#define SC_C_SUM_OF_HALVES(a) \
  _Generic((a), vec_short8 : SC_C_ZERO(vec_int4), vec_ushort8 : SC_C_ZERO(vec_uint4), default : (a))
#define SC_C_PATTERN(a) SC_C_ZERO(vec_uchar16)
#define SC_C_MASK(a)                             \
  _Generic((a), vec_uchar16                      \
           : SC_C_ZERO(vec_uchar16), vec_char16  \
           : SC_C_ZERO(vec_uchar16), vec_ushort8 \
           : SC_C_ZERO(vec_ushort8), vec_short8  \
           : SC_C_ZERO(vec_ushort8), vec_ullong2 \
           : SC_C_ZERO(vec_ullong2), vec_llong2  \
           : SC_C_ZERO(vec_ullong2), vec_double2 \
           : SC_C_ZERO(vec_ullong2), default     \
           : SC_C_ZERO(vec_uint4))
/* The second operand a vector like the first, or a scalar. */
#define SC_C_FITS(a, b) (SC_C_SAME(a, b) || !SC_C_IN(SC_C_CASES_ALL, b))
#define SC_C_CALL2_LIKE(list, f, a, b)                                                                 \
  __extension__({                                                                                      \
    __auto_type sc_1 = (a);                                                                            \
    __auto_type sc_2 = (b);                                                                            \
    SC_C_DEMAND(f, SC_C_IN(list, sc_1) && SC_C_FITS(sc_1, sc_2));                                      \
    SC_C_IF(SC_C_IN(list, sc_1),                                                                       \
            SC_C_PICK(list, f, sc_1)(sc_1, SC_C_AS(sc_1, SC_C_IF(SC_C_FITS(sc_1, sc_2), sc_2, sc_1))), \
            sc_1);                                                                                     \
  })

/* Constants, one lane. */
#define SC_C_SCALARS(f)                                                                                      \
  unsigned char : SC_C_NAME(f, vec_uchar16),                                                                 \
                  signed char : SC_C_NAME(f, vec_char16),                                                    \
                                char : SC_C_NAME(f, vec_uchar16),                                            \
                                       unsigned short : SC_C_NAME(f, vec_ushort8),                           \
                                                        short : SC_C_NAME(f, vec_short8),                    \
                                                                unsigned int : SC_C_NAME(f, vec_uint4),      \
                                                                               int : SC_C_NAME(f, vec_int4), \
                                                                                     unsigned long long      \
      : SC_C_NAME(f, vec_ullong2),                                                                           \
        long long : SC_C_NAME(f, vec_llong2),                                                                \
                    float : SC_C_NAME(f, vec_float4),                                                        \
                            double : SC_C_NAME(f, vec_double2)
#define spu_splats(s)                            \
  __extension__({                                \
    __auto_type sc_1 = (s);                      \
    SC_C_PICK(SC_C_SCALARS, splats, sc_1)(sc_1); \
  })
#define spu_promote(s, element) (((void)(element), spu_splats((s))))
#define spu_insert(s, a, element)                                   \
  __extension__({                                                   \
    __auto_type sc_1 = (s);                                         \
    __auto_type sc_2 = (a);                                         \
    SC_C_PICK(SC_C_CASES_ALL, insert, sc_2)(sc_1, sc_2, (element)); \
  })
#define spu_extract(a, element) SC_C_CALL2_INT(SC_C_CASES_ALL, extract, (a), (element))

/* Conversions; the scale is an immediate. */
#define spu_convtf(a, scale) SC_C_CALL2_INT(SC_C_CASES_32, convtf, (a), SC_C_CONSTANT(scale, 0, 127))
#define spu_convts(a, scale) (softcell_c_convts_vec_float4((a), SC_C_CONSTANT(scale, 0, 127)))
#define spu_convtu(a, scale) (softcell_c_convtu_vec_float4((a), SC_C_CONSTANT(scale, 0, 127)))
#define SC_C_CASES_EXTENDED(f)                                              \
  vec_char16:                                                               \
  SC_C_NAME(f, vec_char16), vec_short8 : SC_C_NAME(f, vec_short8),          \
                                         vec_int4 : SC_C_NAME(f, vec_int4), \
                                                    vec_float4 : SC_C_NAME(f, vec_float4)
#define spu_extend(a) SC_C_CALL1(SC_C_CASES_EXTENDED, extend, (a))
#define spu_roundtf(a) (softcell_c_roundtf_vec_double2(a))

/* Arithmetic. */
#define SC_C_CASES_SUMS(f) SC_C_CASES_16_32(f), SC_C_CASES_REAL(f)
#define SC_C_CASES_FUSED(f) SC_C_CASES_REAL(f), vec_short8 : SC_C_NAME(f, vec_short8)
#define spu_add(a, b) SC_C_CALL2_LIKE(SC_C_CASES_SUMS, add, (a), (b))
#define spu_sub(a, b)                                                                                        \
  __extension__({                                                                                            \
    __auto_type sc_1 = (a);                                                                                  \
    __auto_type sc_2 = (b);                                                                                  \
    SC_C_DEMAND(sub, SC_C_IN(SC_C_CASES_SUMS, sc_2) && SC_C_FITS(sc_2, sc_1));                               \
    SC_C_IF(SC_C_IN(SC_C_CASES_SUMS, sc_2),                                                                  \
            SC_C_PICK(SC_C_CASES_SUMS, sub, sc_2)(SC_C_AS(sc_2, SC_C_IF(SC_C_FITS(sc_2, sc_1), sc_1, sc_2)), \
                                                  sc_2),                                                     \
            sc_2);                                                                                           \
  })
#define spu_addx(a, b, c) SC_C_CALL3(SC_C_CASES_32, addx, (a), (b), (c))
#define spu_subx(a, b, c) SC_C_CALL3(SC_C_CASES_32, subx, (a), (b), (c))
#define spu_gencx(a, b, c) SC_C_CALL3(SC_C_CASES_32, gencx, (a), (b), (c))
#define spu_genbx(a, b, c) SC_C_CALL3(SC_C_CASES_32, genbx, (a), (b), (c))
#define spu_genc(a, b) SC_C_CALL2(SC_C_CASES_32, genc, (a), (b))
#define spu_genb(a, b) SC_C_CALL2(SC_C_CASES_32, genb, (a), (b))
#define spu_mul(a, b) SC_C_CALL2(SC_C_CASES_REAL, mul, (a), (b))
#define spu_madd(a, b, c) SC_C_CALL3_AND(SC_C_CASES_FUSED, madd, (a), (b), (c), SC_C_SUM_OF_HALVES)
#define spu_msub(a, b, c) SC_C_CALL3(SC_C_CASES_REAL, msub, (a), (b), (c))
#define spu_nmsub(a, b, c) SC_C_CALL3(SC_C_CASES_REAL, nmsub, (a), (b), (c))
#define spu_nmadd(a, b, c) (softcell_c_nmadd_vec_double2((a), (b), (c)))
#define spu_mule(a, b) SC_C_CALL2(SC_C_CASES_16, mule, (a), (b))
#define spu_mulo(a, b) SC_C_CALL2_LIKE(SC_C_CASES_16, mulo, (a), (b))
#define spu_mulh(a, b) (softcell_c_mulh_vec_short8((a), (b)))
#define spu_mulsr(a, b) (softcell_c_mulsr_vec_short8((a), (b)))
#define spu_mhhadd(a, b, c) SC_C_CALL3_AND(SC_C_CASES_16, mhhadd, (a), (b), (c), SC_C_SUM_OF_HALVES)
#define spu_re(a) (softcell_c_re_vec_float4(a))
#define spu_rsqrte(a) (softcell_c_rsqrte_vec_float4(a))

/* Bytes. */
#define spu_absd(a, b) (softcell_c_absd_vec_uchar16((a), (b)))
#define spu_avg(a, b) (softcell_c_avg_vec_uchar16((a), (b)))
#define spu_sumb(a, b) (softcell_c_sumb_vec_uchar16((a), (b)))

/* Comparisons; halts. */
#define SC_C_CASES_COMPARED(f) SC_C_CASES_8_16_32(f), SC_C_CASES_REAL(f)
#define spu_cmpeq(a, b) SC_C_CALL2_LIKE(SC_C_CASES_COMPARED, cmpeq, (a), (b))
#define spu_cmpgt(a, b) SC_C_CALL2_LIKE(SC_C_CASES_COMPARED, cmpgt, (a), (b))
#define spu_testsv(a, kinds) (softcell_c_testsv_vec_double2((a), SC_C_CONSTANT(kinds, 0, 0x7F)))
#define spu_cmpabseq(a, b) SC_C_CALL2(SC_C_CASES_REAL, cmpabseq, (a), (b))
#define spu_cmpabsgt(a, b) SC_C_CALL2(SC_C_CASES_REAL, cmpabsgt, (a), (b))
SC_C_INLINE void softcell_halt_if(int condition) {
  if (condition) softcell_call_gate(softcell_halt, 0, 0);
}
#define spu_hcmpeq(a, b) (softcell_halt_if((a) == (b)))
#define spu_hcmpgt(a, b) (softcell_halt_if((a) > (b)))

/* Bits and masks. */
#define SC_C_CASES_COUNTED(f) SC_C_CASES_32(f), vec_float4 : SC_C_NAME(f, vec_float4)
#define SC_C_CASES_GATHERED(f) SC_C_CASES_8_16_32(f), vec_float4 : SC_C_NAME(f, vec_float4)
#define spu_cntb(a) SC_C_CALL1(SC_C_CASES_8, cntb, (a))
#define spu_cntlz(a) SC_C_CALL1(SC_C_CASES_COUNTED, cntlz, (a))
#define spu_gather(a) SC_C_CALL1(SC_C_CASES_GATHERED, gather, (a))
#define spu_maskb(a) (softcell_c_maskb_int(a))
#define spu_maskh(a) (softcell_c_maskh_int(a))
#define spu_maskw(a) (softcell_c_maskw_int(a))
#define spu_orx(a) SC_C_CALL1(SC_C_CASES_32, orx, (a))
#define spu_sel(a, b, c) SC_C_CALL3_AND(SC_C_CASES_ALL, sel, (a), (b), (c), SC_C_MASK)
#define spu_shuffle(a, b, c) SC_C_CALL3_AND(SC_C_CASES_ALL, shuffle, (a), (b), (c), SC_C_PATTERN)

/* Logic. */
#define spu_and(a, b) SC_C_CALL2_LIKE(SC_C_CASES_ALL, and, (a), (b))
#define spu_or(a, b) SC_C_CALL2_LIKE(SC_C_CASES_ALL, or, (a), (b))
#define spu_xor(a, b) SC_C_CALL2_LIKE(SC_C_CASES_ALL, xor, (a), (b))
#define spu_andc(a, b) SC_C_CALL2(SC_C_CASES_ALL, andc, (a), (b))
#define spu_orc(a, b) SC_C_CALL2(SC_C_CASES_ALL, orc, (a), (b))
#define spu_nand(a, b) SC_C_CALL2(SC_C_CASES_ALL, nand, (a), (b))
#define spu_nor(a, b) SC_C_CALL2(SC_C_CASES_ALL, nor, (a), (b))
#define spu_eqv(a, b) SC_C_CALL2(SC_C_CASES_ALL, eqv, (a), (b))

/* Shifts and rotations of lanes, by a vector of counts or by one scalar. */
#define SC_C_SHIFT(f, a, b)                                           \
  __extension__({                                                     \
    __auto_type sc_1 = (a);                                           \
    __auto_type sc_2 = (b);                                           \
    _Generic(sc_2, vec_ushort8                                        \
             : SC_C_PICK(SC_C_CASES_16_32, f, sc_1), vec_short8       \
             : SC_C_PICK(SC_C_CASES_16_32, f, sc_1), vec_uint4        \
             : SC_C_PICK(SC_C_CASES_16_32, f, sc_1), vec_int4         \
             : SC_C_PICK(SC_C_CASES_16_32, f, sc_1), default          \
             : SC_C_PICK(SC_C_CASES_16_32, f##_n, sc_1))(sc_1, sc_2); \
  })
#define spu_sl(a, b) SC_C_SHIFT(sl, (a), (b))
#define spu_sr(a, b) SC_C_SHIFT(sr, (a), (b))
#define spu_sra(a, b) SC_C_SHIFT(sra, (a), (b))
#define spu_rl(a, b) SC_C_SHIFT(rl, (a), (b))
#define spu_rlmask(a, b) SC_C_SHIFT(rlmask, (a), (b))
#define spu_rlmaska(a, b) SC_C_SHIFT(rlmaska, (a), (b))

/* Shifts and rotations of the quadword. */
#define SC_C_QUADWORD(f, a, n) SC_C_CALL2_INT(SC_C_CASES_ALL, f, a, (int)(n))
#define spu_slqw(a, n) SC_C_QUADWORD(slqw, (a), (n))
#define spu_slqwbyte(a, n) SC_C_QUADWORD(slqwbyte, (a), (n))
#define spu_slqwbytebc(a, n) SC_C_QUADWORD(slqwbytebc, (a), (n))
#define spu_srqw(a, n) SC_C_QUADWORD(srqw, (a), (n))
#define spu_srqwbyte(a, n) SC_C_QUADWORD(srqwbyte, (a), (n))
#define spu_srqwbytebc(a, n) SC_C_QUADWORD(srqwbytebc, (a), (n))
#define spu_rlqw(a, n) SC_C_QUADWORD(rlqw, (a), (n))
#define spu_rlqwbyte(a, n) SC_C_QUADWORD(rlqwbyte, (a), (n))
#define spu_rlqwbytebc(a, n) SC_C_QUADWORD(rlqwbytebc, (a), (n))
#define spu_rlmaskqw(a, n) SC_C_QUADWORD(rlmaskqw, (a), (n))
#define spu_rlmaskqwbyte(a, n) SC_C_QUADWORD(rlmaskqwbyte, (a), (n))
#define spu_rlmaskqwbytebc(a, n) SC_C_QUADWORD(rlmaskqwbytebc, (a), (n))

/* Control and channels. */
#define spu_readch(channel) (softcell_call_gate(softcell_read, SC_C_CONSTANT(channel, 0, 127), 0))
#define spu_readchqw(channel) ((vec_uint4){spu_readch(channel)})
#define spu_readchcnt(channel) (softcell_call_gate(softcell_count, SC_C_CONSTANT(channel, 0, 127), 0))
#define spu_writech(channel, value) \
  (softcell_write_channel(SC_C_CONSTANT(channel, 0, 127), (uint32_t)(value)))
/* The first word of a vector with lanes of so many bytes. It is read from memory, as no cast means the same with every compiler here: GCC
 * marks the words of a system header's macro, and what is marked is not rewritten; Clang does not mark them. */
SC_C_INLINE uint32_t softcell_first_word(const void* vector_, unsigned int lane_bytes_) {
  uint32_t word_ = 0;
  unsigned int i_;
  if (lane_bytes_ >= 4) {
    __builtin_memcpy(&word_, (const unsigned char*)vector_ + (lane_bytes_ - 4), 4);
  } else if (lane_bytes_ == 2) {
    for (i_ = 0; i_ < 2; ++i_) word_ = word_ << 16 | ((const vec_ushort8*)vector_)[0][i_];
  } else {
    for (i_ = 0; i_ < 4; ++i_) word_ = word_ << 8 | ((const unsigned char*)vector_)[i_];
  }
  return word_;
}
#define spu_writechqw(channel, value)                                                       \
  __extension__({                                                                           \
    __typeof__(value) softcell_value_ = (value);                                            \
    spu_writech(channel, softcell_first_word(&softcell_value_, sizeof softcell_value_[0])); \
  })
#define spu_stop(code) ((void)softcell_call_gate(softcell_stop, 0, SC_C_CONSTANT(code, 0, 0x3FFF)))
#define spu_sync() ((void)softcell_call_gate(softcell_sync, 0, 0))
#define spu_sync_c() spu_sync()
#define spu_dsync() __asm__ volatile("" ::: "memory")
#define spu_idisable() __asm__ volatile("" ::: "memory")
#define __align_hint(pointer, base, offset) ((void)(pointer))

/* What compiles on an SPU and has no meaning here is refused where it is used, with the reason. */
__attribute__((error(
    "FPSCR is not modelled on the host: spu_* of doubles round to nearest, and there are no sticky flags")))
vec_uint4
softcell_no_fpscr(void);
__attribute__((error("special purpose registers are not modelled on the host"))) unsigned int
softcell_no_special_register(void);
__attribute__((error("interrupts are not modelled on the host: wait on SPU_RdEventStat instead"))) void
softcell_no_interrupts(void);
#define spu_ienable() softcell_no_interrupts()
#define spu_mffpscr() softcell_no_fpscr()
#define spu_mtfpscr(value) ((void)(value), (void)softcell_no_fpscr())
#define spu_mfspr(number) softcell_no_special_register()
#define spu_mtspr(number, value) ((void)(value), (void)softcell_no_special_register())

#endif
