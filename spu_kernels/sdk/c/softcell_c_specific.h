/* The specific intrinsics, si_*, for C: one for each instruction, operands in the assembler's order.  [LEXT, specific intrinsics;
 * SPU-ISA] documented
 */
#ifndef SOFTCELL_C_SPECIFIC_H
#define SOFTCELL_C_SPECIFIC_H

#include "softcell_c_generic.h"

SC_C_INLINE qword softcell_bytes_as_qword(vec_char16 v_) {
  return (qword)softcell_regroup((vec_uchar16)v_, 3);
}
SC_C_INLINE qword softcell_halves_as_qword(vec_short8 v_) {
  return (qword)softcell_regroup((vec_uchar16)v_, 2);
}
SC_C_INLINE qword softcell_doubles_as_qword(vec_ullong2 v_) {
  return (qword)softcell_regroup((vec_uchar16)v_, 4);
}
SC_C_INLINE vec_ullong2 softcell_qword_as_doubles(qword v_) {
  return (vec_ullong2)softcell_regroup((vec_uchar16)v_, 4);
}
SC_C_INLINE vec_char16 softcell_qword_as_bytes(qword v_) {
  return (vec_char16)softcell_regroup((vec_uchar16)v_, 3);
}
SC_C_INLINE vec_short8 softcell_qword_as_halves(qword v_) {
  return (vec_short8)softcell_regroup((vec_uchar16)v_, 2);
}

/* Immediates of 10 bits in every lane, and of 7 bits: counts. */
#define SC_C_WORDS10(imm) ((qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -512, 511)))
#define SC_C_HALVES10(imm) \
  softcell_halves_as_qword(softcell_c_splats_vec_short8((short)SC_C_CONSTANT(imm, -512, 511)))
#define SC_C_BYTES10(imm) \
  softcell_bytes_as_qword(softcell_c_splats_vec_char16((signed char)SC_C_CONSTANT(imm, -512, 511)))
#define SC_C_COUNT7(imm) ((qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -64, 127)))
#define SC_C_HALF_COUNT7(imm) \
  softcell_halves_as_qword(softcell_c_splats_vec_short8((short)SC_C_CONSTANT(imm, -64, 127)))

/* With registers only: calls of the functions of softcell_c_rows.h. */
#define si_cbx(a, b) (softcell_c_si_cbx(a, b))
#define si_chx(a, b) (softcell_c_si_chx(a, b))
#define si_cwx(a, b) (softcell_c_si_cwx(a, b))
#define si_cdx(a, b) (softcell_c_si_cdx(a, b))
#define si_a(a, b) (softcell_c_si_a(a, b))
#define si_ah(a, b) (softcell_c_si_ah(a, b))
#define si_sf(a, b) (softcell_c_si_sf(a, b))
#define si_sfh(a, b) (softcell_c_si_sfh(a, b))
#define si_cg(a, b) (softcell_c_si_cg(a, b))
#define si_bg(a, b) (softcell_c_si_bg(a, b))
#define si_addx(a, b, c) (softcell_c_si_addx(a, b, c))
#define si_sfx(a, b, c) (softcell_c_si_sfx(a, b, c))
#define si_cgx(a, b, c) (softcell_c_si_cgx(a, b, c))
#define si_bgx(a, b, c) (softcell_c_si_bgx(a, b, c))
#define si_mpy(a, b) (softcell_c_si_mpy(a, b))
#define si_mpyu(a, b) (softcell_c_si_mpyu(a, b))
#define si_mpyh(a, b) (softcell_c_si_mpyh(a, b))
#define si_mpys(a, b) (softcell_c_si_mpys(a, b))
#define si_mpyhh(a, b) (softcell_c_si_mpyhh(a, b))
#define si_mpyhhu(a, b) (softcell_c_si_mpyhhu(a, b))
#define si_mpyhha(a, b, c) (softcell_c_si_mpyhha(a, b, c))
#define si_mpyhhau(a, b, c) (softcell_c_si_mpyhhau(a, b, c))
#define si_mpya(a, b, c) (softcell_c_si_mpya(a, b, c))
#define si_clz(a) (softcell_c_si_clz(a))
#define si_cntb(a) (softcell_c_si_cntb(a))
#define si_fsm(a) (softcell_c_si_fsm(a))
#define si_fsmh(a) (softcell_c_si_fsmh(a))
#define si_fsmb(a) (softcell_c_si_fsmb(a))
#define si_gb(a) (softcell_c_si_gb(a))
#define si_gbh(a) (softcell_c_si_gbh(a))
#define si_gbb(a) (softcell_c_si_gbb(a))
#define si_xsbh(a) (softcell_c_si_xsbh(a))
#define si_xshw(a) (softcell_c_si_xshw(a))
#define si_xswd(a) (softcell_c_si_xswd(a))
#define si_orx(a) (softcell_c_si_orx(a))
#define si_avgb(a, b) (softcell_c_si_avgb(a, b))
#define si_absdb(a, b) (softcell_c_si_absdb(a, b))
#define si_sumb(a, b) (softcell_c_si_sumb(a, b))
#define si_and(a, b) (softcell_c_si_and(a, b))
#define si_andc(a, b) (softcell_c_si_andc(a, b))
#define si_or(a, b) (softcell_c_si_or(a, b))
#define si_orc(a, b) (softcell_c_si_orc(a, b))
#define si_xor(a, b) (softcell_c_si_xor(a, b))
#define si_nand(a, b) (softcell_c_si_nand(a, b))
#define si_nor(a, b) (softcell_c_si_nor(a, b))
#define si_eqv(a, b) (softcell_c_si_eqv(a, b))
#define si_selb(a, b, c) (softcell_c_si_selb(a, b, c))
#define si_shufb(a, b, c) (softcell_c_si_shufb(a, b, c))
#define si_shl(a, b) (softcell_c_si_shl(a, b))
#define si_shlh(a, b) (softcell_c_si_shlh(a, b))
#define si_rot(a, b) (softcell_c_si_rot(a, b))
#define si_roth(a, b) (softcell_c_si_roth(a, b))
#define si_rotm(a, b) (softcell_c_si_rotm(a, b))
#define si_rothm(a, b) (softcell_c_si_rothm(a, b))
#define si_rotma(a, b) (softcell_c_si_rotma(a, b))
#define si_rotmah(a, b) (softcell_c_si_rotmah(a, b))
#define si_shlqbi(a, b) (softcell_c_si_shlqbi(a, b))
#define si_shlqby(a, b) (softcell_c_si_shlqby(a, b))
#define si_shlqbybi(a, b) (softcell_c_si_shlqbybi(a, b))
#define si_rotqbi(a, b) (softcell_c_si_rotqbi(a, b))
#define si_rotqby(a, b) (softcell_c_si_rotqby(a, b))
#define si_rotqbybi(a, b) (softcell_c_si_rotqbybi(a, b))
#define si_rotqmbi(a, b) (softcell_c_si_rotqmbi(a, b))
#define si_rotqmby(a, b) (softcell_c_si_rotqmby(a, b))
#define si_rotqmbybi(a, b) (softcell_c_si_rotqmbybi(a, b))
#define si_ceq(a, b) (softcell_c_si_ceq(a, b))
#define si_ceqh(a, b) (softcell_c_si_ceqh(a, b))
#define si_ceqb(a, b) (softcell_c_si_ceqb(a, b))
#define si_cgt(a, b) (softcell_c_si_cgt(a, b))
#define si_cgth(a, b) (softcell_c_si_cgth(a, b))
#define si_cgtb(a, b) (softcell_c_si_cgtb(a, b))
#define si_clgt(a, b) (softcell_c_si_clgt(a, b))
#define si_clgth(a, b) (softcell_c_si_clgth(a, b))
#define si_clgtb(a, b) (softcell_c_si_clgtb(a, b))
#define si_fa(a, b) (softcell_c_si_fa(a, b))
#define si_fs(a, b) (softcell_c_si_fs(a, b))
#define si_fm(a, b) (softcell_c_si_fm(a, b))
#define si_fi(a, b) (softcell_c_si_fi(a, b))
#define si_fceq(a, b) (softcell_c_si_fceq(a, b))
#define si_fcgt(a, b) (softcell_c_si_fcgt(a, b))
#define si_fcmeq(a, b) (softcell_c_si_fcmeq(a, b))
#define si_fcmgt(a, b) (softcell_c_si_fcmgt(a, b))
#define si_fma(a, b, c) (softcell_c_si_fma(a, b, c))
#define si_fms(a, b, c) (softcell_c_si_fms(a, b, c))
#define si_fnms(a, b, c) (softcell_c_si_fnms(a, b, c))
#define si_frest(a) (softcell_c_si_frest(a))
#define si_frsqest(a) (softcell_c_si_frsqest(a))
#define si_frds(a) (softcell_c_si_frds(a))
#define si_fesd(a) (softcell_c_si_fesd(a))
#define si_dfa(a, b) (softcell_c_si_dfa(a, b))
#define si_dfs(a, b) (softcell_c_si_dfs(a, b))
#define si_dfm(a, b) (softcell_c_si_dfm(a, b))
#define si_dfma(a, b, c) (softcell_c_si_dfma(a, b, c))
#define si_dfms(a, b, c) (softcell_c_si_dfms(a, b, c))
#define si_dfnma(a, b, c) (softcell_c_si_dfnma(a, b, c))
#define si_dfnms(a, b, c) (softcell_c_si_dfnms(a, b, c))

/* Loads and stores take quadwords as words; the sum of addresses wraps at 256 KB, and its low four bits are ignored. */
SC_C_INLINE qword* softcell_quadword_at(uint32_t address) {
  return (qword*)((uintptr_t)softcell_environment() | (address & 0x3FFF0));
}
#define si_lqd(a, imm) (*softcell_quadword_at((a)[0] + (uint32_t)SC_C_CONSTANT(imm, -0x2000, 0x1FFF)))
#define si_lqx(a, b) (*softcell_quadword_at((a)[0] + (b)[0]))
#define si_lqa(imm) (*softcell_quadword_at((uint32_t)SC_C_CONSTANT(imm, 0, 0x3FFFF)))
#define si_stqd(t, a, imm) ((void)(si_lqd((a), imm) = (t)))
#define si_stqx(t, a, b) ((void)(si_lqx((a), (b)) = (t)))
#define si_stqa(t, imm) ((void)(si_lqa(imm) = (t)))

#define si_cbd(a, imm) \
  (softcell_c_si_cbx((a), (qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -64, 63))))
#define si_chd(a, imm) \
  (softcell_c_si_chx((a), (qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -64, 63))))
#define si_cwd(a, imm) \
  (softcell_c_si_cwx((a), (qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -64, 63))))
#define si_cdd(a, imm) \
  (softcell_c_si_cdx((a), (qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -64, 63))))

#define si_il(imm) ((qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, -0x8000, 0x7FFF)))
#define si_ila(imm) ((qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, 0, 0x3FFFF)))
#define si_ilh(imm) \
  softcell_halves_as_qword(softcell_c_splats_vec_short8((short)SC_C_CONSTANT(imm, -0x8000, 0xFFFF)))
#define si_ilhu(imm) \
  ((qword)softcell_c_splats_vec_uint4((unsigned int)SC_C_CONSTANT(imm, -0x8000, 0xFFFF) << 16))
#define si_iohl(a, imm) ((a) | (qword)softcell_c_splats_vec_int4(SC_C_CONSTANT(imm, 0, 0xFFFF)))
#define si_fsmbi(imm) \
  softcell_bytes_as_qword((vec_char16)softcell_c_maskb_int(SC_C_CONSTANT(imm, -0x8000, 0xFFFF)))
#define si_ai(a, imm) (softcell_c_si_a((a), SC_C_WORDS10(imm)))
#define si_sfi(a, imm) (softcell_c_si_sf((a), SC_C_WORDS10(imm)))
#define si_andi(a, imm) (softcell_c_si_and((a), SC_C_WORDS10(imm)))
#define si_ori(a, imm) (softcell_c_si_or((a), SC_C_WORDS10(imm)))
#define si_xori(a, imm) (softcell_c_si_xor((a), SC_C_WORDS10(imm)))
#define si_ceqi(a, imm) (softcell_c_si_ceq((a), SC_C_WORDS10(imm)))
#define si_cgti(a, imm) (softcell_c_si_cgt((a), SC_C_WORDS10(imm)))
#define si_clgti(a, imm) (softcell_c_si_clgt((a), SC_C_WORDS10(imm)))
#define si_ahi(a, imm) (softcell_c_si_ah((a), SC_C_HALVES10(imm)))
#define si_sfhi(a, imm) (softcell_c_si_sfh((a), SC_C_HALVES10(imm)))
#define si_mpyi(a, imm) (softcell_c_si_mpy((a), SC_C_HALVES10(imm)))
#define si_mpyui(a, imm) (softcell_c_si_mpyu((a), SC_C_HALVES10(imm)))
#define si_andhi(a, imm) (softcell_c_si_and((a), SC_C_HALVES10(imm)))
#define si_orhi(a, imm) (softcell_c_si_or((a), SC_C_HALVES10(imm)))
#define si_xorhi(a, imm) (softcell_c_si_xor((a), SC_C_HALVES10(imm)))
#define si_ceqhi(a, imm) (softcell_c_si_ceqh((a), SC_C_HALVES10(imm)))
#define si_cgthi(a, imm) (softcell_c_si_cgth((a), SC_C_HALVES10(imm)))
#define si_clgthi(a, imm) (softcell_c_si_clgth((a), SC_C_HALVES10(imm)))
#define si_andbi(a, imm) (softcell_c_si_and((a), SC_C_BYTES10(imm)))
#define si_orbi(a, imm) (softcell_c_si_or((a), SC_C_BYTES10(imm)))
#define si_xorbi(a, imm) (softcell_c_si_xor((a), SC_C_BYTES10(imm)))
#define si_ceqbi(a, imm) (softcell_c_si_ceqb((a), SC_C_BYTES10(imm)))
#define si_cgtbi(a, imm) (softcell_c_si_cgtb((a), SC_C_BYTES10(imm)))
#define si_clgtbi(a, imm) (softcell_c_si_clgtb((a), SC_C_BYTES10(imm)))
#define si_shli(a, imm) (softcell_c_si_shl((a), SC_C_COUNT7(imm)))
#define si_roti(a, imm) (softcell_c_si_rot((a), SC_C_COUNT7(imm)))
#define si_rotmi(a, imm) (softcell_c_si_rotm((a), SC_C_COUNT7(imm)))
#define si_rotmai(a, imm) (softcell_c_si_rotma((a), SC_C_COUNT7(imm)))
#define si_shlqbii(a, imm) (softcell_c_si_shlqbi((a), SC_C_COUNT7(imm)))
#define si_shlqbyi(a, imm) (softcell_c_si_shlqby((a), SC_C_COUNT7(imm)))
#define si_rotqbii(a, imm) (softcell_c_si_rotqbi((a), SC_C_COUNT7(imm)))
#define si_rotqbyi(a, imm) (softcell_c_si_rotqby((a), SC_C_COUNT7(imm)))
#define si_rotqmbii(a, imm) (softcell_c_si_rotqmbi((a), SC_C_COUNT7(imm)))
#define si_rotqmbyi(a, imm) (softcell_c_si_rotqmby((a), SC_C_COUNT7(imm)))
#define si_shlhi(a, imm) (softcell_c_si_shlh((a), SC_C_HALF_COUNT7(imm)))
#define si_rothi(a, imm) (softcell_c_si_roth((a), SC_C_HALF_COUNT7(imm)))
#define si_rothmi(a, imm) (softcell_c_si_rothm((a), SC_C_HALF_COUNT7(imm)))
#define si_rotmahi(a, imm) (softcell_c_si_rotmah((a), SC_C_HALF_COUNT7(imm)))

#define si_csflt(a, scale) ((qword)spu_convtf((vec_int4)(a), scale))
#define si_cuflt(a, scale) ((qword)spu_convtf((vec_uint4)(a), scale))
#define si_cflts(a, scale) ((qword)spu_convts((vec_float4)(a), scale))
#define si_cfltu(a, scale) ((qword)spu_convtu((vec_float4)(a), scale))

/* Halts compare word 0. */
#define si_heq(a, b) (softcell_halt_if((a)[0] == (b)[0]))
#define si_hgt(a, b) (softcell_halt_if((int)(a)[0] > (int)(b)[0]))
#define si_hlgt(a, b) (softcell_halt_if((a)[0] > (b)[0]))
#define si_heqi(a, imm) (softcell_halt_if((int)(a)[0] == SC_C_CONSTANT(imm, -512, 511)))
#define si_hgti(a, imm) (softcell_halt_if((int)(a)[0] > SC_C_CONSTANT(imm, -512, 511)))
#define si_hlgti(a, imm) (softcell_halt_if((a)[0] > (unsigned int)SC_C_CONSTANT(imm, -512, 511)))

#define si_stop(code) spu_stop(code)
#define si_stopd(a, b, c) ((void)(a), (void)(b), (void)(c), spu_stop(0x3FFF))
#define si_nop() ((void)0)
#define si_lnop() ((void)0)
#define si_sync() spu_sync()
#define si_syncc() spu_sync()
#define si_dsync() spu_dsync()
#define si_rdch(channel) ((qword){spu_readch(channel)})
#define si_rchcnt(channel) ((qword){spu_readchcnt(channel)})
#define si_wrch(channel, a) spu_writech(channel, (a)[0])

/* Scalars in and out of the preferred slot; the rest of the register is zero. */
#define si_from_char(s) ((qword){(unsigned int)(signed char)(s)})
#define si_from_uchar(s) ((qword){(unsigned char)(s)})
#define si_from_short(s) ((qword){(unsigned int)(short)(s)})
#define si_from_ushort(s) ((qword){(unsigned short)(s)})
#define si_from_int(s) ((qword){(unsigned int)(int)(s)})
#define si_from_uint(s) ((qword){(unsigned int)(s)})
#define si_from_llong(s) softcell_doubles_as_qword((vec_ullong2){(unsigned long long)(long long)(s)})
#define si_from_ullong(s) softcell_doubles_as_qword((vec_ullong2){(unsigned long long)(s)})
#define si_from_float(s) ((qword)(vec_float4){(float)(s)})
#define si_from_double(s) softcell_doubles_as_qword((vec_ullong2)(vec_double2){(double)(s)})
#define si_from_ptr(s) ((qword){softcell_lsa(s)})
#define si_to_char(a) ((signed char)(a)[0])
#define si_to_uchar(a) ((unsigned char)(a)[0])
#define si_to_short(a) ((short)(a)[0])
#define si_to_ushort(a) ((unsigned short)(a)[0])
#define si_to_int(a) ((int)(a)[0])
#define si_to_uint(a) ((a)[0])
#define si_to_llong(a) ((long long)softcell_qword_as_doubles(a)[0])
#define si_to_ullong(a) (softcell_qword_as_doubles(a)[0])
#define si_to_float(a) (((vec_float4)(a))[0])
#define si_to_double(a) (((vec_double2)softcell_qword_as_doubles(a))[0])
SC_C_INLINE void* softcell_pointer(uint32_t lsa) {
  return (lsa & 0x3FFFF) == 0 ? (void*)0 : (void*)((uintptr_t)softcell_environment() | (lsa & 0x3FFFF));
}
#define si_to_ptr(a) (softcell_pointer((a)[0]))

#endif
