#pragma once
// The specific intrinsics, si_*: one for each instruction that makes sense in C, operands in assembler order,
// all of them registers without a type.  [LEXT, specific intrinsics; SPU-ISA] documented
//
// An instruction that also reads its target takes that as its last operand. Immediates are constants, in the
// assembler's range and unit: conversions take the scale 0..127, loads and stores bytes. A scalar is in a
// register's preferred slot, which for words and addresses is word 0. Missing on purpose: branches and their
// hints, loads and stores relative to the program counter.
//
// Memory holds lanes in the host's order, and loads and stores take them for words: right for words and
// floats in memory.

#include "softcell_compare.h"
#include "softcell_control.h"
#include "softcell_convert.h"
#include "softcell_estimate.h"
#include "softcell_integer.h"
#include "softcell_logic.h"
#include "softcell_quadword.h"
#include "softcell_shift.h"

namespace softcell_sdk {

SC_SDK_INLINE unsigned int word0(qword q_) { return q_.raw[0]; }
SC_SDK_INLINE int signed_word0(qword q_) { return static_cast<int>(q_.raw[0]); }
SC_SDK_INLINE qword words(unsigned int w0, unsigned int w1) { return qword(vec_uint4(w0, w1)); }

template <int Value, int Low, int High>
SC_SDK_INLINE constexpr int immediate() {
  static_assert(Value >= Low && Value <= High, "this instruction's immediate does not hold that value");
  return Value;
}

// Immediates of 10 bits in every lane: signed; bytes keep the low eight.
template <int Value>
SC_SDK_INLINE vec_char16 immediate_bytes() {
  return splats(static_cast<signed char>(immediate<Value, -512, 511>() & 0xFF));
}
template <int Value>
SC_SDK_INLINE vec_short8 immediate_halves() {
  return splats(static_cast<short>(immediate<Value, -512, 511>()));
}
template <int Value>
SC_SDK_INLINE vec_int4 immediate_words() {
  return splats(immediate<Value, -512, 511>());
}
/// Of 7 bits: counts of shifts and rotates, negative for those that shift right.
template <int Value>
SC_SDK_INLINE constexpr int immediate_count() {
  return immediate<Value, -64, 127>();
}

}  // namespace softcell_sdk

// name, type the operands are read as, intrinsic
#define SC_SDK_SI1(name, A, function) \
  SC_SDK_INLINE qword name(qword a_) { return qword(function(A(a_))); }
#define SC_SDK_SI2(name, A, B, function) \
  SC_SDK_INLINE qword name(qword a_, qword b_) { return qword(function(A(a_), B(b_))); }
#define SC_SDK_SI3(name, A, B, C, function) \
  SC_SDK_INLINE qword name(qword a_, qword b_, qword c_) { return qword(function(A(a_), B(b_), C(c_))); }
/// As above with the operands of the instruction swapped.
#define SC_SDK_SI2_SWAPPED(name, A, function) \
  SC_SDK_INLINE qword name(qword a_, qword b_) { return qword(function(A(b_), A(a_))); }
#define SC_SDK_SI3_SWAPPED(name, A, function) \
  SC_SDK_INLINE qword name(qword a_, qword b_, qword c_) { return qword(function(A(b_), A(a_), A(c_))); }

// ---- loads and stores: the sum of addresses wraps at 256 KB, and its low four bits are ignored

namespace softcell_sdk {

SC_SDK_INLINE qword& quadword_at(unsigned int address) {
  return *reinterpret_cast<qword*>(local_store_base() | (address & kLocalStoreMask & ~uintptr_t{15}));
}
template <int Offset>
SC_SDK_INLINE unsigned int displaced(qword a_) {
  static_assert(Offset % 16 == 0, "quadwords lie at multiples of 16 bytes");
  return word0(a_) + static_cast<unsigned int>(immediate<Offset, -0x2000, 0x1FFF>());
}
template <int Address>
SC_SDK_INLINE constexpr unsigned int absolute() {
  static_assert(Address % 4 == 0, "the instruction holds an address in words");
  return static_cast<unsigned int>(immediate<Address, 0, 0x3FFFF>());
}

}  // namespace softcell_sdk

/// Loads and stores take quadwords as words.
#define si_lqd(ra, offset) (qword(softcell_sdk::quadword_at(softcell_sdk::displaced<(offset)>(ra))))
#define si_lqa(address) (qword(softcell_sdk::quadword_at(softcell_sdk::absolute<(address)>())))
#define si_stqd(rt, ra, offset) \
  (static_cast<void>(softcell_sdk::quadword_at(softcell_sdk::displaced<(offset)>(ra)) = (rt)))
#define si_stqa(rt, address) \
  (static_cast<void>(softcell_sdk::quadword_at(softcell_sdk::absolute<(address)>()) = (rt)))
SC_SDK_INLINE qword si_lqx(qword a_, qword b_) {
  return softcell_sdk::quadword_at(softcell_sdk::word0(a_) + softcell_sdk::word0(b_));
}
SC_SDK_INLINE void si_stqx(qword t_, qword a_, qword b_) {
  softcell_sdk::quadword_at(softcell_sdk::word0(a_) + softcell_sdk::word0(b_)) = t_;
}

// ---- controls for si_shufb that put a preferred slot into one place of a quadword

namespace softcell_sdk {

/// Copies the second operand, but for `Width` bytes at `position`, which come from the first one's preferred
/// slot.
template <int Width>
SC_SDK_INLINE qword insertion_control(unsigned int position) {
  const auto first = static_cast<unsigned char>(position & 15u & ~(Width - 1u));
  const auto slot = static_cast<unsigned char>(Width < 4 ? 4 - Width : 0);
  const Bytes place = places() - first;
  const auto inside = (Bytes)(place < static_cast<unsigned char>(Width));
  return qword(make<vec_uchar16>(((place + slot) & inside) | ((places() + 16) & ~inside)));
}
template <int Width, int Offset>
SC_SDK_INLINE qword insertion_control_at(qword a_) {
  return insertion_control<Width>(word0(a_) + static_cast<unsigned int>(immediate<Offset, -64, 63>()));
}

}  // namespace softcell_sdk

#define si_cbd(ra, offset) (softcell_sdk::insertion_control_at<1, (offset)>(ra))
#define si_chd(ra, offset) (softcell_sdk::insertion_control_at<2, (offset)>(ra))
#define si_cwd(ra, offset) (softcell_sdk::insertion_control_at<4, (offset)>(ra))
#define si_cdd(ra, offset) (softcell_sdk::insertion_control_at<8, (offset)>(ra))
#define SC_SDK_INSERTION(name, width)                                                                 \
  SC_SDK_INLINE qword name(qword a_, qword b_) {                                                      \
    return softcell_sdk::insertion_control<width>(softcell_sdk::word0(a_) + softcell_sdk::word0(b_)); \
  }
SC_SDK_INSERTION(si_cbx, 1)
SC_SDK_INSERTION(si_chx, 2)
SC_SDK_INSERTION(si_cwx, 4)
SC_SDK_INSERTION(si_cdx, 8)
#undef SC_SDK_INSERTION

// ---- constants

#define si_ilh(imm) \
  (qword(softcell_sdk::splats(static_cast<short>(softcell_sdk::immediate<(imm), -0x8000, 0xFFFF>()))))
#define si_ilhu(imm)                                                                                       \
  (qword(softcell_sdk::splats(static_cast<unsigned int>(softcell_sdk::immediate<(imm), -0x8000, 0xFFFF>()) \
                              << 16)))
#define si_il(imm) (qword(softcell_sdk::splats(softcell_sdk::immediate<(imm), -0x8000, 0x7FFF>())))
#define si_ila(imm) (qword(softcell_sdk::splats(softcell_sdk::immediate<(imm), 0, 0x3FFFF>())))
#define si_iohl(ra, imm) \
  (si_or((ra), qword(softcell_sdk::splats(softcell_sdk::immediate<(imm), 0, 0xFFFF>()))))
#define si_fsmbi(imm) (qword(spu_maskb(softcell_sdk::immediate<(imm), -0x8000, 0xFFFF>())))

// ---- add, subtract, carry

SC_SDK_SI2(si_a, vec_int4, vec_int4, spu_add)
SC_SDK_SI2(si_ah, vec_short8, vec_short8, spu_add)
#define si_ai(ra, imm) (si_a((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_ahi(ra, imm) (si_ah((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
/// The first operand is taken from the second.
SC_SDK_SI2_SWAPPED(si_sf, vec_int4, spu_sub)
SC_SDK_SI2_SWAPPED(si_sfh, vec_short8, spu_sub)
#define si_sfi(ra, imm) (si_sf((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_sfhi(ra, imm) (si_sfh((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
SC_SDK_SI3(si_addx, vec_uint4, vec_uint4, vec_uint4, spu_addx)
SC_SDK_SI2(si_cg, vec_uint4, vec_uint4, spu_genc)
SC_SDK_SI3(si_cgx, vec_uint4, vec_uint4, vec_uint4, spu_gencx)
SC_SDK_SI3_SWAPPED(si_sfx, vec_uint4, spu_subx)
SC_SDK_SI2_SWAPPED(si_bg, vec_uint4, spu_genb)
SC_SDK_SI3_SWAPPED(si_bgx, vec_uint4, spu_genbx)

// ---- multiply

SC_SDK_SI2(si_mpy, vec_short8, vec_short8, spu_mulo)
SC_SDK_SI2(si_mpyu, vec_ushort8, vec_ushort8, spu_mulo)
#define si_mpyi(ra, imm) (si_mpy((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_mpyui(ra, imm) (si_mpyu((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
SC_SDK_SI3(si_mpya, vec_short8, vec_short8, vec_int4, spu_madd)
SC_SDK_SI2(si_mpyh, vec_short8, vec_short8, spu_mulh)
SC_SDK_SI2(si_mpys, vec_short8, vec_short8, spu_mulsr)
SC_SDK_SI2(si_mpyhh, vec_short8, vec_short8, spu_mule)
SC_SDK_SI2(si_mpyhhu, vec_ushort8, vec_ushort8, spu_mule)
SC_SDK_SI3(si_mpyhha, vec_short8, vec_short8, vec_int4, spu_mhhadd)
SC_SDK_SI3(si_mpyhhau, vec_ushort8, vec_ushort8, vec_uint4, spu_mhhadd)

// ---- bits, masks, bytes

SC_SDK_SI1(si_clz, vec_uint4, spu_cntlz)
SC_SDK_SI1(si_cntb, vec_uchar16, spu_cntb)
SC_SDK_SI1(si_fsmb, softcell_sdk::word0, spu_maskb)
SC_SDK_SI1(si_fsmh, softcell_sdk::word0, spu_maskh)
SC_SDK_SI1(si_fsm, softcell_sdk::word0, spu_maskw)
SC_SDK_SI1(si_gbb, vec_uchar16, spu_gather)
SC_SDK_SI1(si_gbh, vec_ushort8, spu_gather)
SC_SDK_SI1(si_gb, vec_uint4, spu_gather)
SC_SDK_SI2(si_avgb, vec_uchar16, vec_uchar16, spu_avg)
SC_SDK_SI2(si_absdb, vec_uchar16, vec_uchar16, spu_absd)
SC_SDK_SI2(si_sumb, vec_uchar16, vec_uchar16, spu_sumb)
SC_SDK_SI1(si_xsbh, vec_char16, spu_extend)
SC_SDK_SI1(si_xshw, vec_short8, spu_extend)
SC_SDK_SI1(si_xswd, vec_int4, spu_extend)
SC_SDK_SI1(si_orx, vec_uint4, spu_orx)

// ---- logic

SC_SDK_SI2(si_and, vec_uint4, vec_uint4, spu_and)
SC_SDK_SI2(si_andc, vec_uint4, vec_uint4, spu_andc)
SC_SDK_SI2(si_or, vec_uint4, vec_uint4, spu_or)
SC_SDK_SI2(si_orc, vec_uint4, vec_uint4, spu_orc)
SC_SDK_SI2(si_xor, vec_uint4, vec_uint4, spu_xor)
SC_SDK_SI2(si_nand, vec_uint4, vec_uint4, spu_nand)
SC_SDK_SI2(si_nor, vec_uint4, vec_uint4, spu_nor)
SC_SDK_SI2(si_eqv, vec_uint4, vec_uint4, spu_eqv)
#define si_andbi(ra, imm) (si_and((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
#define si_andhi(ra, imm) (si_and((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_andi(ra, imm) (si_and((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_orbi(ra, imm) (si_or((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
#define si_orhi(ra, imm) (si_or((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_ori(ra, imm) (si_or((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_xorbi(ra, imm) (si_xor((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
#define si_xorhi(ra, imm) (si_xor((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_xori(ra, imm) (si_xor((ra), qword(softcell_sdk::immediate_words<(imm)>())))
SC_SDK_SI3(si_selb, vec_uint4, vec_uint4, vec_uint4, spu_sel)
SC_SDK_SI3(si_shufb, vec_uint4, vec_uint4, vec_uchar16, spu_shuffle)

// ---- shifts and rotates of elements

SC_SDK_SI2(si_shl, vec_uint4, vec_uint4, spu_sl)
SC_SDK_SI2(si_shlh, vec_ushort8, vec_ushort8, spu_sl)
SC_SDK_SI2(si_rot, vec_uint4, vec_int4, spu_rl)
SC_SDK_SI2(si_roth, vec_ushort8, vec_short8, spu_rl)
SC_SDK_SI2(si_rotm, vec_uint4, vec_int4, spu_rlmask)
SC_SDK_SI2(si_rothm, vec_ushort8, vec_short8, spu_rlmask)
SC_SDK_SI2(si_rotma, vec_uint4, vec_int4, spu_rlmaska)
SC_SDK_SI2(si_rotmah, vec_ushort8, vec_short8, spu_rlmaska)
#define si_shli(ra, imm) \
  (qword(spu_sl(vec_uint4(ra), static_cast<unsigned int>(softcell_sdk::immediate_count<(imm)>()))))
#define si_shlhi(ra, imm) \
  (qword(spu_sl(vec_ushort8(ra), static_cast<unsigned int>(softcell_sdk::immediate_count<(imm)>()))))
#define si_roti(ra, imm) (qword(spu_rl(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rothi(ra, imm) (qword(spu_rl(vec_ushort8(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotmi(ra, imm) (qword(spu_rlmask(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rothmi(ra, imm) (qword(spu_rlmask(vec_ushort8(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotmai(ra, imm) (qword(spu_rlmaska(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotmahi(ra, imm) (qword(spu_rlmaska(vec_ushort8(ra), softcell_sdk::immediate_count<(imm)>())))

// ---- shifts and rotates of the quadword, by word 0 of the second operand

#define SC_SDK_SI_QUADWORD(name, word, function)                   \
  SC_SDK_INLINE qword name(qword a_, qword b_) {                   \
    return qword(function(vec_uint4(a_), softcell_sdk::word(b_))); \
  }
SC_SDK_SI_QUADWORD(si_shlqbi, word0, spu_slqw)
SC_SDK_SI_QUADWORD(si_shlqby, word0, spu_slqwbyte)
SC_SDK_SI_QUADWORD(si_shlqbybi, word0, spu_slqwbytebc)
SC_SDK_SI_QUADWORD(si_rotqbi, signed_word0, spu_rlqw)
SC_SDK_SI_QUADWORD(si_rotqby, signed_word0, spu_rlqwbyte)
SC_SDK_SI_QUADWORD(si_rotqbybi, signed_word0, spu_rlqwbytebc)
SC_SDK_SI_QUADWORD(si_rotqmbi, signed_word0, spu_rlmaskqw)
SC_SDK_SI_QUADWORD(si_rotqmby, signed_word0, spu_rlmaskqwbyte)
SC_SDK_SI_QUADWORD(si_rotqmbybi, signed_word0, spu_rlmaskqwbytebc)
#undef SC_SDK_SI_QUADWORD
#define si_shlqbii(ra, imm) \
  (qword(spu_slqw(vec_uint4(ra), static_cast<unsigned int>(softcell_sdk::immediate_count<(imm)>()))))
#define si_shlqbyi(ra, imm) \
  (qword(spu_slqwbyte(vec_uint4(ra), static_cast<unsigned int>(softcell_sdk::immediate_count<(imm)>()))))
#define si_rotqbii(ra, imm) (qword(spu_rlqw(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotqbyi(ra, imm) (qword(spu_rlqwbyte(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotqmbii(ra, imm) (qword(spu_rlmaskqw(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))
#define si_rotqmbyi(ra, imm) (qword(spu_rlmaskqwbyte(vec_uint4(ra), softcell_sdk::immediate_count<(imm)>())))

// ---- compares

SC_SDK_SI2(si_ceqb, vec_char16, vec_char16, spu_cmpeq)
SC_SDK_SI2(si_cgtb, vec_char16, vec_char16, spu_cmpgt)
SC_SDK_SI2(si_clgtb, vec_uchar16, vec_uchar16, spu_cmpgt)
#define si_ceqbi(ra, imm) (si_ceqb((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
#define si_cgtbi(ra, imm) (si_cgtb((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
#define si_clgtbi(ra, imm) (si_clgtb((ra), qword(softcell_sdk::immediate_bytes<(imm)>())))
SC_SDK_SI2(si_ceqh, vec_short8, vec_short8, spu_cmpeq)
SC_SDK_SI2(si_cgth, vec_short8, vec_short8, spu_cmpgt)
SC_SDK_SI2(si_clgth, vec_ushort8, vec_ushort8, spu_cmpgt)
#define si_ceqhi(ra, imm) (si_ceqh((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_cgthi(ra, imm) (si_cgth((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
#define si_clgthi(ra, imm) (si_clgth((ra), qword(softcell_sdk::immediate_halves<(imm)>())))
SC_SDK_SI2(si_ceq, vec_int4, vec_int4, spu_cmpeq)
SC_SDK_SI2(si_cgt, vec_int4, vec_int4, spu_cmpgt)
SC_SDK_SI2(si_clgt, vec_uint4, vec_uint4, spu_cmpgt)
#define si_ceqi(ra, imm) (si_ceq((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_cgti(ra, imm) (si_cgt((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_clgti(ra, imm) (si_clgt((ra), qword(softcell_sdk::immediate_words<(imm)>())))

/// Halts compare word 0.
SC_SDK_INLINE void si_heq(qword a_, qword b_) {
  spu_hcmpeq(softcell_sdk::word0(a_), softcell_sdk::word0(b_));
}
SC_SDK_INLINE void si_hgt(qword a_, qword b_) {
  spu_hcmpgt(softcell_sdk::signed_word0(a_), softcell_sdk::signed_word0(b_));
}
SC_SDK_INLINE void si_hlgt(qword a_, qword b_) {
  spu_hcmpgt(softcell_sdk::word0(a_), softcell_sdk::word0(b_));
}
#define si_heqi(ra, imm) (si_heq((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_hgti(ra, imm) (si_hgt((ra), qword(softcell_sdk::immediate_words<(imm)>())))
#define si_hlgti(ra, imm) (si_hlgt((ra), qword(softcell_sdk::immediate_words<(imm)>())))

// ---- single precision

SC_SDK_SI2(si_fa, vec_float4, vec_float4, spu_add)
SC_SDK_SI2(si_fs, vec_float4, vec_float4, spu_sub)
SC_SDK_SI2(si_fm, vec_float4, vec_float4, spu_mul)
SC_SDK_SI3(si_fma, vec_float4, vec_float4, vec_float4, spu_madd)
SC_SDK_SI3(si_fms, vec_float4, vec_float4, vec_float4, spu_msub)
SC_SDK_SI3(si_fnms, vec_float4, vec_float4, vec_float4, spu_nmsub)
SC_SDK_SI1(si_frest, vec_float4, softcell_sdk::reciprocal_estimate)
SC_SDK_SI1(si_frsqest, vec_float4, softcell_sdk::reciprocal_square_root_estimate)
SC_SDK_SI2(si_fi, vec_float4, vec_float4, softcell_sdk::interpolate)
SC_SDK_SI2(si_fceq, vec_float4, vec_float4, spu_cmpeq)
SC_SDK_SI2(si_fcmeq, vec_float4, vec_float4, spu_cmpabseq)
SC_SDK_SI2(si_fcgt, vec_float4, vec_float4, spu_cmpgt)
SC_SDK_SI2(si_fcmgt, vec_float4, vec_float4, spu_cmpabsgt)
#define si_csflt(ra, scale) (qword(spu_convtf(vec_int4(ra), scale)))
#define si_cuflt(ra, scale) (qword(spu_convtf(vec_uint4(ra), scale)))
#define si_cflts(ra, scale) (qword(spu_convts(vec_float4(ra), scale)))
#define si_cfltu(ra, scale) (qword(spu_convtu(vec_float4(ra), scale)))
SC_SDK_SI1(si_fesd, vec_float4, spu_extend)
SC_SDK_SI1(si_frds, vec_double2, spu_roundtf)
#define si_fscrrd() (softcell_sdk::no_fpscr<>())
#define si_fscrwr(ra) (static_cast<void>(ra), softcell_sdk::no_fpscr<>())

// ---- double precision; compares and si_dftsv are the PowerXCell 8i's

SC_SDK_SI2(si_dfa, vec_double2, vec_double2, spu_add)
SC_SDK_SI2(si_dfs, vec_double2, vec_double2, spu_sub)
SC_SDK_SI2(si_dfm, vec_double2, vec_double2, spu_mul)
SC_SDK_SI3(si_dfma, vec_double2, vec_double2, vec_double2, spu_madd)
SC_SDK_SI3(si_dfms, vec_double2, vec_double2, vec_double2, spu_msub)
SC_SDK_SI3(si_dfnms, vec_double2, vec_double2, vec_double2, spu_nmsub)
SC_SDK_SI3(si_dfnma, vec_double2, vec_double2, vec_double2, spu_nmadd)
SC_SDK_SI2(si_dfceq, vec_double2, vec_double2, spu_cmpeq)
SC_SDK_SI2(si_dfcmeq, vec_double2, vec_double2, spu_cmpabseq)
SC_SDK_SI2(si_dfcgt, vec_double2, vec_double2, spu_cmpgt)
SC_SDK_SI2(si_dfcmgt, vec_double2, vec_double2, spu_cmpabsgt)
#define si_dftsv(ra, kinds) (qword(spu_testsv(vec_double2(ra), kinds)))

// ---- control and channels

#define si_stop(code) (softcell_sdk::stop<(code)>())
/// Stops with the code 0x3FFF.
SC_SDK_INLINE void si_stopd(qword, qword, qword) { softcell_sdk::stop<0x3FFF>(); }
#define si_nop() (static_cast<void>(0))
#define si_lnop() (static_cast<void>(0))
#define si_sync() (softcell_sdk::sync())
#define si_syncc() (softcell_sdk::sync())
#define si_dsync() (softcell_sdk::barrier())
#define si_rdch(channel) (softcell_sdk::words(softcell_sdk::read_channel<(channel)>(), 0))
#define si_rchcnt(channel) (softcell_sdk::words(softcell_sdk::read_channel_count<(channel)>(), 0))
#define si_wrch(channel, ra) (softcell_sdk::write_channel<(channel)>(softcell_sdk::word0(ra)))
#define si_mfspr(number) (softcell_sdk::no_special_register<>())
#define si_mtspr(number, ra) (static_cast<void>(ra), softcell_sdk::no_special_register<>())

#undef SC_SDK_SI1
#undef SC_SDK_SI2
#undef SC_SDK_SI3
#undef SC_SDK_SI2_SWAPPED
#undef SC_SDK_SI3_SWAPPED

// ---- scalars: in and out of the preferred slot. What else is in the register the SPU leaves undefined; here
// it is zero.

SC_SDK_INLINE qword si_from_char(signed char value) {
  return softcell_sdk::words(static_cast<unsigned int>(value), 0);
}
SC_SDK_INLINE qword si_from_uchar(unsigned char value) { return softcell_sdk::words(value, 0); }
SC_SDK_INLINE qword si_from_short(short value) {
  return softcell_sdk::words(static_cast<unsigned int>(value), 0);
}
SC_SDK_INLINE qword si_from_ushort(unsigned short value) { return softcell_sdk::words(value, 0); }
SC_SDK_INLINE qword si_from_int(int value) {
  return softcell_sdk::words(static_cast<unsigned int>(value), 0);
}
SC_SDK_INLINE qword si_from_uint(unsigned int value) { return softcell_sdk::words(value, 0); }
SC_SDK_INLINE qword si_from_llong(long long value) { return qword(vec_llong2(value, 0)); }
SC_SDK_INLINE qword si_from_ullong(unsigned long long value) { return qword(vec_ullong2(value, 0)); }
SC_SDK_INLINE qword si_from_float(float value) { return qword(vec_float4(value, 0.0f)); }
SC_SDK_INLINE qword si_from_double(double value) { return qword(vec_double2(value, 0.0)); }
/// The local-store address; 0 for a null pointer.
SC_SDK_INLINE qword si_from_ptr(const volatile void* pointer) {
  return softcell_sdk::words(softcell_sdk::local_store_address(pointer), 0);
}

SC_SDK_INLINE signed char si_to_char(qword a_) { return static_cast<signed char>(softcell_sdk::word0(a_)); }
SC_SDK_INLINE unsigned char si_to_uchar(qword a_) {
  return static_cast<unsigned char>(softcell_sdk::word0(a_));
}
SC_SDK_INLINE short si_to_short(qword a_) { return static_cast<short>(softcell_sdk::word0(a_)); }
SC_SDK_INLINE unsigned short si_to_ushort(qword a_) {
  return static_cast<unsigned short>(softcell_sdk::word0(a_));
}
SC_SDK_INLINE int si_to_int(qword a_) { return softcell_sdk::signed_word0(a_); }
SC_SDK_INLINE unsigned int si_to_uint(qword a_) { return softcell_sdk::word0(a_); }
SC_SDK_INLINE long long si_to_llong(qword a_) { return vec_llong2(a_).raw[0]; }
SC_SDK_INLINE unsigned long long si_to_ullong(qword a_) { return vec_ullong2(a_).raw[0]; }
SC_SDK_INLINE float si_to_float(qword a_) { return vec_float4(a_).raw[0]; }
SC_SDK_INLINE double si_to_double(qword a_) { return vec_double2(a_).raw[0]; }
/// A pointer into this SPE's local store; null for address 0. Its type is that of an SPU compiler: cast it.
SC_SDK_INLINE const volatile void* si_to_ptr(qword a_) {
  const uintptr_t address = softcell_sdk::word0(a_) & softcell_sdk::kLocalStoreMask;
  return address == 0 ? nullptr : reinterpret_cast<void*>(softcell_sdk::local_store_base() | address);
}
