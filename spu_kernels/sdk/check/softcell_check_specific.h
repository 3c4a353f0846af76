#pragma once
// The specific intrinsics: one row for each instruction, operands in the assembler's order; an instruction
// that also reads its target takes that last. [LEXT, specific intrinsics; SPU-ISA] documented

#include "softcell_check_types.h"

namespace softcell_check {

// Shapes: what the operands are, registers (r) or immediates (i).
qword q_();
qword q_r(qword);
qword q_rr(qword, qword);
qword q_rrr(qword, qword, qword);
qword q_ri(qword, int);
qword q_i(int);
void v_();
void v_i(int);
void v_r(qword);
void v_rr(qword, qword);
void v_rrr(qword, qword, qword);
void v_ri(qword, int);
void v_ir(int, qword);
void v_rri(qword, qword, int);

// A scalar into the preferred slot and out of it.
qword from_char(signed char);
qword from_uchar(unsigned char);
qword from_short(short);
qword from_ushort(unsigned short);
qword from_int(int);
qword from_uint(unsigned int);
qword from_llong(long long);
qword from_ullong(unsigned long long);
qword from_float(float);
qword from_double(double);
qword from_ptr(void*);
signed char to_char(qword);
unsigned char to_uchar(qword);
short to_short(qword);
unsigned short to_ushort(qword);
int to_int(qword);
unsigned int to_uint(qword);
long long to_llong(qword);
unsigned long long to_ullong(qword);
float to_float(qword);
double to_double(qword);
const volatile void* to_ptr(qword);

}  // namespace softcell_check

// clang-format off
// Loads and stores; addresses in bytes
#define si_lqd(ra, imm)        ::softcell_check::q_ri(ra, SC_S10_QUADWORDS(imm))
#define si_lqx(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_lqa(imm)            ::softcell_check::q_i(SC_U16_WORDS(imm))
#define si_lqr(imm)            ::softcell_check::q_i(SC_S16_WORDS(imm))
#define si_stqd(rt, ra, imm)   ::softcell_check::v_rri(rt, ra, SC_S10_QUADWORDS(imm))
#define si_stqx(rt, ra, rb)    ::softcell_check::v_rrr(rt, ra, rb)
#define si_stqa(rt, imm)       ::softcell_check::v_ri(rt, SC_U16_WORDS(imm))
#define si_stqr(rt, imm)       ::softcell_check::v_ri(rt, SC_S16_WORDS(imm))

// Insertion controls
#define si_cbd(ra, imm)        ::softcell_check::q_ri(ra, SC_S7(imm))
#define si_chd(ra, imm)        ::softcell_check::q_ri(ra, SC_S7(imm))
#define si_cwd(ra, imm)        ::softcell_check::q_ri(ra, SC_S7(imm))
#define si_cdd(ra, imm)        ::softcell_check::q_ri(ra, SC_S7(imm))
#define si_cbx(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_chx(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_cwx(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_cdx(ra, rb)         ::softcell_check::q_rr(ra, rb)

// Constants
#define si_ilh(imm)            ::softcell_check::q_i(SC_W16(imm))
#define si_ilhu(imm)           ::softcell_check::q_i(SC_W16(imm))
#define si_fsmbi(imm)          ::softcell_check::q_i(SC_W16(imm))
#define si_il(imm)             ::softcell_check::q_i(SC_S16(imm))
#define si_ila(imm)            ::softcell_check::q_i(SC_U18(imm))
#define si_iohl(rt, imm)       ::softcell_check::q_ri(rt, SC_U16(imm))

// Integer arithmetic
#define si_a(ra, rb)           ::softcell_check::q_rr(ra, rb)
#define si_ah(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_sf(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_sfh(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_cg(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_bg(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_mpy(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_mpyu(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_mpyh(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_mpys(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_mpyhh(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_mpyhhu(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_ai(ra, imm)         ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_ahi(ra, imm)        ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_sfi(ra, imm)        ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_sfhi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_mpyi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_mpyui(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_addx(ra, rb, rt)    ::softcell_check::q_rrr(ra, rb, rt)
#define si_sfx(ra, rb, rt)     ::softcell_check::q_rrr(ra, rb, rt)
#define si_cgx(ra, rb, rt)     ::softcell_check::q_rrr(ra, rb, rt)
#define si_bgx(ra, rb, rt)     ::softcell_check::q_rrr(ra, rb, rt)
#define si_mpyhha(ra, rb, rt)  ::softcell_check::q_rrr(ra, rb, rt)
#define si_mpyhhau(ra, rb, rt) ::softcell_check::q_rrr(ra, rb, rt)
#define si_mpya(ra, rb, rc)    ::softcell_check::q_rrr(ra, rb, rc)

// Bits, masks, bytes
#define si_clz(ra)             ::softcell_check::q_r(ra)
#define si_cntb(ra)            ::softcell_check::q_r(ra)
#define si_fsm(ra)             ::softcell_check::q_r(ra)
#define si_fsmh(ra)            ::softcell_check::q_r(ra)
#define si_fsmb(ra)            ::softcell_check::q_r(ra)
#define si_gb(ra)              ::softcell_check::q_r(ra)
#define si_gbh(ra)             ::softcell_check::q_r(ra)
#define si_gbb(ra)             ::softcell_check::q_r(ra)
#define si_xsbh(ra)            ::softcell_check::q_r(ra)
#define si_xshw(ra)            ::softcell_check::q_r(ra)
#define si_xswd(ra)            ::softcell_check::q_r(ra)
#define si_orx(ra)             ::softcell_check::q_r(ra)
#define si_avgb(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_absdb(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_sumb(ra, rb)        ::softcell_check::q_rr(ra, rb)

// Logic
#define si_and(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_andc(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_or(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_orc(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_xor(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_nand(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_nor(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_eqv(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_andbi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_andhi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_andi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_orbi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_orhi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_ori(ra, imm)        ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_xorbi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_xorhi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_xori(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_selb(ra, rb, rc)    ::softcell_check::q_rrr(ra, rb, rc)
#define si_shufb(ra, rb, rc)   ::softcell_check::q_rrr(ra, rb, rc)

// Shifts and rotations
#define si_shl(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_shlh(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_rot(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_roth(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_rotm(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_rothm(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_rotma(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_rotmah(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_shli(ra, imm)       ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_shlhi(ra, imm)      ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_roti(ra, imm)       ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rothi(ra, imm)      ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotmi(ra, imm)      ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rothmi(ra, imm)     ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotmai(ra, imm)     ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotmahi(ra, imm)    ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_shlqbi(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_shlqby(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_shlqbybi(ra, rb)    ::softcell_check::q_rr(ra, rb)
#define si_rotqbi(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_rotqby(ra, rb)      ::softcell_check::q_rr(ra, rb)
#define si_rotqbybi(ra, rb)    ::softcell_check::q_rr(ra, rb)
#define si_rotqmbi(ra, rb)     ::softcell_check::q_rr(ra, rb)
#define si_rotqmby(ra, rb)     ::softcell_check::q_rr(ra, rb)
#define si_rotqmbybi(ra, rb)   ::softcell_check::q_rr(ra, rb)
#define si_shlqbii(ra, imm)    ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_shlqbyi(ra, imm)    ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotqbii(ra, imm)    ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotqbyi(ra, imm)    ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotqmbii(ra, imm)   ::softcell_check::q_ri(ra, SC_W7(imm))
#define si_rotqmbyi(ra, imm)   ::softcell_check::q_ri(ra, SC_W7(imm))

// Comparisons and halts
#define si_ceq(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_ceqh(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_ceqb(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_cgt(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_cgth(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_cgtb(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_clgt(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_clgth(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_clgtb(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_ceqi(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_ceqhi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_ceqbi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_cgti(ra, imm)       ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_cgthi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_cgtbi(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_clgti(ra, imm)      ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_clgthi(ra, imm)     ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_clgtbi(ra, imm)     ::softcell_check::q_ri(ra, SC_S10(imm))
#define si_heq(ra, rb)         ::softcell_check::v_rr(ra, rb)
#define si_hgt(ra, rb)         ::softcell_check::v_rr(ra, rb)
#define si_hlgt(ra, rb)        ::softcell_check::v_rr(ra, rb)
#define si_heqi(ra, imm)       ::softcell_check::v_ri(ra, SC_S10(imm))
#define si_hgti(ra, imm)       ::softcell_check::v_ri(ra, SC_S10(imm))
#define si_hlgti(ra, imm)      ::softcell_check::v_ri(ra, SC_S10(imm))

// Floating point; the scale is a power of two, 0..127
#define si_fa(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_fs(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_fm(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_fi(ra, rb)          ::softcell_check::q_rr(ra, rb)
#define si_fceq(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_fcgt(ra, rb)        ::softcell_check::q_rr(ra, rb)
#define si_fcmeq(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_fcmgt(ra, rb)       ::softcell_check::q_rr(ra, rb)
#define si_dfa(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_dfs(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_dfm(ra, rb)         ::softcell_check::q_rr(ra, rb)
#define si_fma(ra, rb, rc)     ::softcell_check::q_rrr(ra, rb, rc)
#define si_fms(ra, rb, rc)     ::softcell_check::q_rrr(ra, rb, rc)
#define si_fnms(ra, rb, rc)    ::softcell_check::q_rrr(ra, rb, rc)
#define si_dfma(ra, rb, rt)    ::softcell_check::q_rrr(ra, rb, rt)
#define si_dfms(ra, rb, rt)    ::softcell_check::q_rrr(ra, rb, rt)
#define si_dfnma(ra, rb, rt)   ::softcell_check::q_rrr(ra, rb, rt)
#define si_dfnms(ra, rb, rt)   ::softcell_check::q_rrr(ra, rb, rt)
#define si_frest(ra)           ::softcell_check::q_r(ra)
#define si_frsqest(ra)         ::softcell_check::q_r(ra)
#define si_frds(ra)            ::softcell_check::q_r(ra)
#define si_fesd(ra)            ::softcell_check::q_r(ra)
#define si_csflt(ra, scale)    ::softcell_check::q_ri(ra, SC_U7(scale))
#define si_cuflt(ra, scale)    ::softcell_check::q_ri(ra, SC_U7(scale))
#define si_cflts(ra, scale)    ::softcell_check::q_ri(ra, SC_U7(scale))
#define si_cfltu(ra, scale)    ::softcell_check::q_ri(ra, SC_U7(scale))
#define si_fscrrd()            ::softcell_check::q_()
#define si_fscrwr(ra)          ::softcell_check::v_r(ra)

// Control, channels, special registers
#define si_stop(code)          ::softcell_check::v_i(SC_U14(code))
#define si_stopd(ra, rb, rc)   ::softcell_check::v_rrr(ra, rb, rc)
#define si_nop()               ::softcell_check::v_()
#define si_lnop()              ::softcell_check::v_()
#define si_sync()              ::softcell_check::v_()
#define si_syncc()             ::softcell_check::v_()
#define si_dsync()             ::softcell_check::v_()
#define si_rdch(channel)       ::softcell_check::q_i(SC_U7(channel))
#define si_rchcnt(channel)     ::softcell_check::q_i(SC_U7(channel))
#define si_wrch(channel, ra)   ::softcell_check::v_ir(SC_U7(channel), ra)
#define si_mfspr(spr)          ::softcell_check::q_i(SC_U7(spr))
#define si_mtspr(spr, ra)      ::softcell_check::v_ir(SC_U7(spr), ra)

// Scalars
#define si_from_char(scalar)   ::softcell_check::from_char(scalar)
#define si_from_uchar(scalar)  ::softcell_check::from_uchar(scalar)
#define si_from_short(scalar)  ::softcell_check::from_short(scalar)
#define si_from_ushort(scalar) ::softcell_check::from_ushort(scalar)
#define si_from_int(scalar)    ::softcell_check::from_int(scalar)
#define si_from_uint(scalar)   ::softcell_check::from_uint(scalar)
#define si_from_llong(scalar)  ::softcell_check::from_llong(scalar)
#define si_from_ullong(scalar) ::softcell_check::from_ullong(scalar)
#define si_from_float(scalar)  ::softcell_check::from_float(scalar)
#define si_from_double(scalar) ::softcell_check::from_double(scalar)
#define si_from_ptr(scalar)    ::softcell_check::from_ptr(scalar)
#define si_to_char(ra)         ::softcell_check::to_char(ra)
#define si_to_uchar(ra)        ::softcell_check::to_uchar(ra)
#define si_to_short(ra)        ::softcell_check::to_short(ra)
#define si_to_ushort(ra)       ::softcell_check::to_ushort(ra)
#define si_to_int(ra)          ::softcell_check::to_int(ra)
#define si_to_uint(ra)         ::softcell_check::to_uint(ra)
#define si_to_llong(ra)        ::softcell_check::to_llong(ra)
#define si_to_ullong(ra)       ::softcell_check::to_ullong(ra)
#define si_to_float(ra)        ::softcell_check::to_float(ra)
#define si_to_double(ra)       ::softcell_check::to_double(ra)
#define si_to_ptr(ra)          ::softcell_check::to_ptr(ra)
// clang-format on
