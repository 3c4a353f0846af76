#pragma once
// The generic intrinsics: one row for each operation and group of vector types. [LEXT, generic intrinsics]
// documented
//
// As on a real SPU compiler a vector argument must have exactly the type of a row, and a scalar argument is
// converted; where an operation has scalar arguments only, the first of them must have exactly the type of a
// row.

#include "softcell_check_types.h"

// Types: ROW(name, vector, lane, unsigned vector of that width, signed vector of that width).
// clang-format off
#define SC_BYTES(ROW, name)   ROW(name, vec_uchar16, unsigned char,      vec_uchar16, vec_char16) \
                              ROW(name, vec_char16,  signed char,        vec_uchar16, vec_char16)
#define SC_HALVES(ROW, name)  ROW(name, vec_ushort8, unsigned short,     vec_ushort8, vec_short8) \
                              ROW(name, vec_short8,  short,              vec_ushort8, vec_short8)
#define SC_WORDS(ROW, name)   ROW(name, vec_uint4,   unsigned int,       vec_uint4,   vec_int4) \
                              ROW(name, vec_int4,    int,                vec_uint4,   vec_int4)
#define SC_LONGS(ROW, name)   ROW(name, vec_ullong2, unsigned long long, vec_ullong2, vec_llong2) \
                              ROW(name, vec_llong2,  long long,          vec_ullong2, vec_llong2)
#define SC_FLOATS(ROW, name)  ROW(name, vec_float4,  float,              vec_uint4,   vec_int4)
#define SC_DOUBLES(ROW, name) ROW(name, vec_double2, double,             vec_ullong2, vec_llong2)

#define SC_16_32(ROW, name)    SC_HALVES(ROW, name) SC_WORDS(ROW, name)
#define SC_8_16_32(ROW, name)  SC_BYTES(ROW, name) SC_16_32(ROW, name)
#define SC_REALS(ROW, name)    SC_FLOATS(ROW, name) SC_DOUBLES(ROW, name)
#define SC_ALL(ROW, name)      SC_8_16_32(ROW, name) SC_LONGS(ROW, name) SC_REALS(ROW, name)

// Shapes: V vector, S its lane, U and I the unsigned and signed vector of its width; the result stands first.
#define SC_V_V(name, V, S, U, I)     V name(V);
#define SC_V_VV(name, V, S, U, I)    V name(V, V);
#define SC_V_VVV(name, V, S, U, I)   V name(V, V, V);
#define SC_V_VS(name, V, S, U, I)    V name(V, S);
#define SC_V_SV(name, V, S, U, I)    V name(S, V);
#define SC_V_VU(name, V, S, U, I)    V name(V, U);
#define SC_V_VI(name, V, S, U, I)    V name(V, I);
#define SC_V_VVU(name, V, S, U, I)   V name(V, V, U);
#define SC_U_V(name, V, S, U, I)     U name(V);
#define SC_U_VV(name, V, S, U, I)    U name(V, V);
#define SC_U_VS(name, V, S, U, I)    U name(V, S);
#define SC_V_COUNT(name, V, S, U, I) V name(V, unsigned int);
#define SC_V_TURNS(name, V, S, U, I) V name(V, int);
#define SC_V_S(name, V, S, U, I)     V name(S);
#define SC_V_S_AT(name, V, S, U, I)  V name(S, int);
#define SC_V_SV_AT(name, V, S, U, I) V name(S, V, int);
#define SC_S_V_AT(name, V, S, U, I)  S name(V, int);
#define SC_V_VVP(name, V, S, U, I)   V name(V, V, vec_uchar16);
#define SC_BITS(name, V, S, U, I)    vec_uint4 name(V);

namespace softcell_check {

/// A second scalar: converted, whatever its type, and without a say in which row is meant.
struct Scalar {
  Scalar(long double);
};

// Constants, one lane
SC_ALL(SC_V_S, spu_splats)      template <class T_> void spu_splats(T_) = delete;
SC_ALL(SC_V_S_AT, spu_promote)  template <class T_> void spu_promote(T_, int) = delete;
SC_ALL(SC_V_SV_AT, spu_insert)
SC_ALL(SC_S_V_AT, spu_extract)

// Conversions; the scale is an immediate
vec_float4 spu_convtf(vec_uint4, int);
vec_float4 spu_convtf(vec_int4, int);
vec_int4 spu_convts(vec_float4, int);
vec_uint4 spu_convtu(vec_float4, int);
vec_short8 spu_extend(vec_char16);
vec_int4 spu_extend(vec_short8);
vec_llong2 spu_extend(vec_int4);
vec_double2 spu_extend(vec_float4);
vec_float4 spu_roundtf(vec_double2);

// Arithmetic
SC_16_32(SC_V_VV, spu_add)   SC_REALS(SC_V_VV, spu_add)   SC_16_32(SC_V_VS, spu_add)
SC_16_32(SC_V_VV, spu_sub)   SC_REALS(SC_V_VV, spu_sub)   SC_16_32(SC_V_SV, spu_sub)
SC_WORDS(SC_V_VVV, spu_addx)
SC_WORDS(SC_V_VVV, spu_subx)
SC_WORDS(SC_V_VV, spu_genc)
SC_WORDS(SC_V_VVV, spu_gencx)
SC_WORDS(SC_V_VV, spu_genb)
SC_WORDS(SC_V_VVV, spu_genbx)
SC_REALS(SC_V_VV, spu_mul)
SC_REALS(SC_V_VVV, spu_madd)  vec_int4 spu_madd(vec_short8, vec_short8, vec_int4);
SC_REALS(SC_V_VVV, spu_msub)
SC_REALS(SC_V_VVV, spu_nmsub)
SC_DOUBLES(SC_V_VVV, spu_nmadd)
vec_uint4 spu_mule(vec_ushort8, vec_ushort8);
vec_int4 spu_mule(vec_short8, vec_short8);
vec_uint4 spu_mulo(vec_ushort8, vec_ushort8);
vec_int4 spu_mulo(vec_short8, vec_short8);
vec_uint4 spu_mulo(vec_ushort8, unsigned short);
vec_int4 spu_mulo(vec_short8, short);
vec_int4 spu_mulh(vec_short8, vec_short8);
vec_int4 spu_mulsr(vec_short8, vec_short8);
vec_uint4 spu_mhhadd(vec_ushort8, vec_ushort8, vec_uint4);
vec_int4 spu_mhhadd(vec_short8, vec_short8, vec_int4);
vec_float4 spu_re(vec_float4);
vec_float4 spu_rsqrte(vec_float4);

// Bytes
vec_uchar16 spu_absd(vec_uchar16, vec_uchar16);
vec_uchar16 spu_avg(vec_uchar16, vec_uchar16);
vec_ushort8 spu_sumb(vec_uchar16, vec_uchar16);

// Comparisons; halts
SC_8_16_32(SC_U_VV, spu_cmpeq)  SC_REALS(SC_U_VV, spu_cmpeq)  SC_8_16_32(SC_U_VS, spu_cmpeq)
SC_8_16_32(SC_U_VV, spu_cmpgt)  SC_REALS(SC_U_VV, spu_cmpgt)  SC_8_16_32(SC_U_VS, spu_cmpgt)
SC_REALS(SC_U_VV, spu_cmpabseq)
SC_REALS(SC_U_VV, spu_cmpabsgt)
vec_ullong2 spu_testsv(vec_double2, int);
void spu_hcmpeq(int, Scalar);  void spu_hcmpeq(unsigned int, Scalar);  template <class T_> void spu_hcmpeq(T_, Scalar) = delete;
void spu_hcmpgt(int, Scalar);  void spu_hcmpgt(unsigned int, Scalar);  template <class T_> void spu_hcmpgt(T_, Scalar) = delete;

// Bits and masks
SC_BYTES(SC_U_V, spu_cntb)
SC_WORDS(SC_U_V, spu_cntlz)  SC_FLOATS(SC_U_V, spu_cntlz)
SC_8_16_32(SC_BITS, spu_gather)  SC_FLOATS(SC_BITS, spu_gather)
#define SC_MASK(name, V, T) V name(T); V name(unsigned T);
SC_MASK(spu_maskb, vec_uchar16, short)  SC_MASK(spu_maskb, vec_uchar16, int)
SC_MASK(spu_maskh, vec_ushort8, short)  SC_MASK(spu_maskh, vec_ushort8, int)
SC_MASK(spu_maskw, vec_uint4, short)    SC_MASK(spu_maskw, vec_uint4, int)
vec_ushort8 spu_maskh(signed char);     vec_ushort8 spu_maskh(unsigned char);
vec_uint4 spu_maskw(signed char);       vec_uint4 spu_maskw(unsigned char);
template <class T_> void spu_maskb(T_) = delete;
template <class T_> void spu_maskh(T_) = delete;
template <class T_> void spu_maskw(T_) = delete;
SC_ALL(SC_V_VVU, spu_sel)
SC_ALL(SC_V_VVP, spu_shuffle)

// Logic
SC_ALL(SC_V_VV, spu_and)  SC_8_16_32(SC_V_VS, spu_and)
SC_ALL(SC_V_VV, spu_or)   SC_8_16_32(SC_V_VS, spu_or)
SC_ALL(SC_V_VV, spu_xor)  SC_8_16_32(SC_V_VS, spu_xor)
SC_ALL(SC_V_VV, spu_andc)
SC_ALL(SC_V_VV, spu_orc)
SC_ALL(SC_V_VV, spu_nand)
SC_ALL(SC_V_VV, spu_nor)
SC_ALL(SC_V_VV, spu_eqv)
SC_WORDS(SC_V_V, spu_orx)

// Shifts and rotations of lanes: unsigned counts to shift, signed ones to rotate (negative is to the right)
SC_16_32(SC_V_VU, spu_sl)       SC_16_32(SC_V_COUNT, spu_sl)
SC_16_32(SC_V_VU, spu_sr)       SC_16_32(SC_V_COUNT, spu_sr)
SC_16_32(SC_V_VU, spu_sra)      SC_16_32(SC_V_COUNT, spu_sra)
SC_16_32(SC_V_VI, spu_rl)       SC_16_32(SC_V_TURNS, spu_rl)
SC_16_32(SC_V_VI, spu_rlmask)   SC_16_32(SC_V_TURNS, spu_rlmask)
SC_16_32(SC_V_VI, spu_rlmaska)  SC_16_32(SC_V_TURNS, spu_rlmaska)

// Shifts and rotations of the quadword
SC_ALL(SC_V_COUNT, spu_slqw)     SC_ALL(SC_V_COUNT, spu_slqwbyte)      SC_ALL(SC_V_COUNT, spu_slqwbytebc)
SC_ALL(SC_V_COUNT, spu_srqw)     SC_ALL(SC_V_COUNT, spu_srqwbyte)      SC_ALL(SC_V_COUNT, spu_srqwbytebc)
SC_ALL(SC_V_TURNS, spu_rlqw)     SC_ALL(SC_V_TURNS, spu_rlqwbyte)      SC_ALL(SC_V_TURNS, spu_rlqwbytebc)
SC_ALL(SC_V_TURNS, spu_rlmaskqw) SC_ALL(SC_V_TURNS, spu_rlmaskqwbyte)  SC_ALL(SC_V_TURNS, spu_rlmaskqwbytebc)

// Control, channels, special registers
void spu_idisable();
void spu_ienable();
void spu_sync();
void spu_sync_c();
void spu_dsync();
void spu_stop(int);
void spu_bisled(void*);
void spu_bisled_d(void*);
void spu_bisled_e(void*);
unsigned int spu_readch(int);
vec_uint4 spu_readchqw(int);
unsigned int spu_readchcnt(int);
void spu_writech(int, unsigned int);
void spu_writechqw(int, vec_uint4);
unsigned int spu_mfspr(int);
void spu_mtspr(int, unsigned int);
vec_uint4 spu_mffpscr();
void spu_mtfpscr(vec_uint4);
void align_hint(void*, int, int);

}  // namespace softcell_check

// Functions on a real compiler too.
using softcell_check::spu_re;
using softcell_check::spu_rsqrte;
void spu_mfcdma32(volatile void* ls, unsigned int ea, unsigned int size, unsigned int tag, unsigned int cmd);
void spu_mfcdma64(volatile void* ls, unsigned int eah, unsigned int eal, unsigned int size, unsigned int tag, unsigned int cmd);
unsigned int spu_mfcstat(unsigned int type);

// Macros, as on a real compiler: the comma of a compound literal separates arguments unless parentheses stand around the literal.
#define spu_splats(scalar)                  ::softcell_check::spu_splats(scalar)
#define spu_promote(scalar, element)        ::softcell_check::spu_promote(scalar, element)
#define spu_insert(scalar, a, element)      ::softcell_check::spu_insert(scalar, a, element)
#define spu_extract(a, element)             ::softcell_check::spu_extract(a, element)
#define spu_convtf(a, scale)                ::softcell_check::spu_convtf(a, SC_U7(scale))
#define spu_convts(a, scale)                ::softcell_check::spu_convts(a, SC_U7(scale))
#define spu_convtu(a, scale)                ::softcell_check::spu_convtu(a, SC_U7(scale))
#define spu_extend(a)                       ::softcell_check::spu_extend(a)
#define spu_roundtf(a)                      ::softcell_check::spu_roundtf(a)
#define spu_cntb(a)                         ::softcell_check::spu_cntb(a)
#define spu_cntlz(a)                        ::softcell_check::spu_cntlz(a)
#define spu_gather(a)                       ::softcell_check::spu_gather(a)
#define spu_maskb(a)                        ::softcell_check::spu_maskb(a)
#define spu_maskh(a)                        ::softcell_check::spu_maskh(a)
#define spu_maskw(a)                        ::softcell_check::spu_maskw(a)
#define spu_orx(a)                          ::softcell_check::spu_orx(a)
#define spu_add(a, b)                       ::softcell_check::spu_add(a, b)
#define spu_sub(a, b)                       ::softcell_check::spu_sub(a, b)
#define spu_genc(a, b)                      ::softcell_check::spu_genc(a, b)
#define spu_genb(a, b)                      ::softcell_check::spu_genb(a, b)
#define spu_mul(a, b)                       ::softcell_check::spu_mul(a, b)
#define spu_mule(a, b)                      ::softcell_check::spu_mule(a, b)
#define spu_mulo(a, b)                      ::softcell_check::spu_mulo(a, b)
#define spu_mulh(a, b)                      ::softcell_check::spu_mulh(a, b)
#define spu_mulsr(a, b)                     ::softcell_check::spu_mulsr(a, b)
#define spu_absd(a, b)                      ::softcell_check::spu_absd(a, b)
#define spu_avg(a, b)                       ::softcell_check::spu_avg(a, b)
#define spu_sumb(a, b)                      ::softcell_check::spu_sumb(a, b)
#define spu_cmpeq(a, b)                     ::softcell_check::spu_cmpeq(a, b)
#define spu_cmpgt(a, b)                     ::softcell_check::spu_cmpgt(a, b)
#define spu_cmpabseq(a, b)                  ::softcell_check::spu_cmpabseq(a, b)
#define spu_cmpabsgt(a, b)                  ::softcell_check::spu_cmpabsgt(a, b)
#define spu_hcmpeq(a, b)                    ::softcell_check::spu_hcmpeq(a, b)
#define spu_hcmpgt(a, b)                    ::softcell_check::spu_hcmpgt(a, b)
#define spu_and(a, b)                       ::softcell_check::spu_and(a, b)
#define spu_or(a, b)                        ::softcell_check::spu_or(a, b)
#define spu_xor(a, b)                       ::softcell_check::spu_xor(a, b)
#define spu_andc(a, b)                      ::softcell_check::spu_andc(a, b)
#define spu_orc(a, b)                       ::softcell_check::spu_orc(a, b)
#define spu_nand(a, b)                      ::softcell_check::spu_nand(a, b)
#define spu_nor(a, b)                       ::softcell_check::spu_nor(a, b)
#define spu_eqv(a, b)                       ::softcell_check::spu_eqv(a, b)
#define spu_sl(a, b)                        ::softcell_check::spu_sl(a, b)
#define spu_sr(a, b)                        ::softcell_check::spu_sr(a, b)
#define spu_sra(a, b)                       ::softcell_check::spu_sra(a, b)
#define spu_rl(a, b)                        ::softcell_check::spu_rl(a, b)
#define spu_rlmask(a, b)                    ::softcell_check::spu_rlmask(a, b)
#define spu_rlmaska(a, b)                   ::softcell_check::spu_rlmaska(a, b)
#define spu_addx(a, b, c)                   ::softcell_check::spu_addx(a, b, c)
#define spu_subx(a, b, c)                   ::softcell_check::spu_subx(a, b, c)
#define spu_gencx(a, b, c)                  ::softcell_check::spu_gencx(a, b, c)
#define spu_genbx(a, b, c)                  ::softcell_check::spu_genbx(a, b, c)
#define spu_madd(a, b, c)                   ::softcell_check::spu_madd(a, b, c)
#define spu_msub(a, b, c)                   ::softcell_check::spu_msub(a, b, c)
#define spu_nmsub(a, b, c)                  ::softcell_check::spu_nmsub(a, b, c)
#define spu_nmadd(a, b, c)                  ::softcell_check::spu_nmadd(a, b, c)
#define spu_mhhadd(a, b, c)                 ::softcell_check::spu_mhhadd(a, b, c)
#define spu_sel(a, b, c)                    ::softcell_check::spu_sel(a, b, c)
#define spu_shuffle(a, b, c)                ::softcell_check::spu_shuffle(a, b, c)
#define spu_testsv(a, imm)                  ::softcell_check::spu_testsv(a, SC_U7(imm))
#define spu_slqw(a, count)                  ::softcell_check::spu_slqw(a, count)
#define spu_slqwbyte(a, count)              ::softcell_check::spu_slqwbyte(a, count)
#define spu_slqwbytebc(a, count)            ::softcell_check::spu_slqwbytebc(a, count)
#define spu_srqw(a, count)                  ::softcell_check::spu_srqw(a, count)
#define spu_srqwbyte(a, count)              ::softcell_check::spu_srqwbyte(a, count)
#define spu_srqwbytebc(a, count)            ::softcell_check::spu_srqwbytebc(a, count)
#define spu_rlqw(a, count)                  ::softcell_check::spu_rlqw(a, count)
#define spu_rlqwbyte(a, count)              ::softcell_check::spu_rlqwbyte(a, count)
#define spu_rlqwbytebc(a, count)            ::softcell_check::spu_rlqwbytebc(a, count)
#define spu_rlmaskqw(a, count)              ::softcell_check::spu_rlmaskqw(a, count)
#define spu_rlmaskqwbyte(a, count)          ::softcell_check::spu_rlmaskqwbyte(a, count)
#define spu_rlmaskqwbytebc(a, count)        ::softcell_check::spu_rlmaskqwbytebc(a, count)
#define spu_idisable()                      ::softcell_check::spu_idisable()
#define spu_ienable()                       ::softcell_check::spu_ienable()
#define spu_sync()                          ::softcell_check::spu_sync()
#define spu_sync_c()                        ::softcell_check::spu_sync_c()
#define spu_dsync()                         ::softcell_check::spu_dsync()
#define spu_mffpscr()                       ::softcell_check::spu_mffpscr()
#define spu_stop(code)                      ::softcell_check::spu_stop(SC_U14(code))
#define spu_bisled(target)                  ::softcell_check::spu_bisled(target)
#define spu_bisled_d(target)                ::softcell_check::spu_bisled_d(target)
#define spu_bisled_e(target)                ::softcell_check::spu_bisled_e(target)
#define spu_readch(channel)                 ::softcell_check::spu_readch(SC_U7(channel))
#define spu_readchqw(channel)               ::softcell_check::spu_readchqw(SC_U7(channel))
#define spu_readchcnt(channel)              ::softcell_check::spu_readchcnt(SC_U7(channel))
#define spu_writech(channel, a)             ::softcell_check::spu_writech(SC_U7(channel), a)
#define spu_writechqw(channel, a)           ::softcell_check::spu_writechqw(SC_U7(channel), a)
#define spu_mfspr(spr)                      ::softcell_check::spu_mfspr(SC_U7(spr))
#define spu_mtspr(spr, a)                   ::softcell_check::spu_mtspr(SC_U7(spr), a)
#define spu_mtfpscr(a)                      ::softcell_check::spu_mtfpscr(a)
#define __align_hint(pointer, base, offset) ::softcell_check::align_hint(pointer, SC_W7(base), SC_W7(offset))
// clang-format on
