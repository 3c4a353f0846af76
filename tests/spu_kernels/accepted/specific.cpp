// sdk: check host
// One or two instructions of each operand shape, by their own names.
#include "returns.h"
#include "vectors.h"

RETURNS(qword, si_lqd(q, -32));
RETURNS(qword, si_lqa(0x3FFFC));
RETURNS(void, si_stqd(q, q, 16));
RETURNS(void, si_stqx(q, q, q));
RETURNS(qword, si_cwd(q, 4));
RETURNS(qword, si_il(-32768));
RETURNS(qword, si_ilhu(0xFFFF));
RETURNS(qword, si_iohl(si_ilhu(0x3F80), 0));
RETURNS(qword, si_fsmbi(0x0F0F));
RETURNS(qword, si_a(q, q));
RETURNS(qword, si_ai(q, 511));
RETURNS(qword, si_addx(q, q, q));
RETURNS(qword, si_mpyhhau(q, q, q));
RETURNS(qword, si_shufb(q, q, (qword)u8));
RETURNS(qword, si_rotqbyi(q, -4));
RETURNS(qword, si_rotmi(q, -31));
RETURNS(qword, si_clgtbi(q, 127));
RETURNS(qword, si_fma((qword)f32, (qword)f32, (qword)f32));
RETURNS(qword, si_csflt((qword)s32, 127));
RETURNS(qword, si_fi((qword)f32, si_frest((qword)f32)));
RETURNS(void, si_heqi(q, 0));
RETURNS(void, si_stop(0x2000));
RETURNS(qword, si_rdch(SPU_RdInMbox));
RETURNS(void, si_wrch(SPU_WrOutMbox, si_from_uint(1u)));
RETURNS(float, si_to_float(si_from_float(1.0f)));
RETURNS(unsigned long long, si_to_ullong(si_from_ullong(1ull)));
RETURNS(const volatile void*, si_to_ptr(si_from_ptr(&u)));
RETURNS(vec_uint4, spu_mffpscr());
RETURNS(vec_ullong2, spu_testsv(f64, SPU_SV_NAN | SPU_SV_POS_INFINITY));
RETURNS(void, spu_stop(0x3FFF));
RETURNS(vec_uint4, spu_readchqw(SPU_RdSigNotify1));
// Comparisons of doubles are generic, but a PS3 makes them of several instructions.
RETURNS(vec_ullong2, spu_cmpeq(f64, f64));
RETURNS(vec_ullong2, spu_cmpgt(f64, f64));
RETURNS(vec_ullong2, spu_cmpabseq(f64, f64));
// Of two scalars the first decides and the second is converted.
RETURNS(void, spu_hcmpeq(i, 7u));
RETURNS(void, spu_hcmpgt(u, 7));
