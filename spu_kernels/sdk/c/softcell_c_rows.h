/* The intrinsics that C kernels call as functions, one row for each operation and vector type: declared by softcell_c_generic.h,
 * defined in C++ by c_intrinsics.cpp, from the host's intrinsics for C++. An image holds those that it uses.
 *
 * Whoever includes this defines the shapes first. SC_C_<result>_<operands>(name, V, S, U, I): V the vector, S its lane, U and I the
 * unsigned and signed vector of its width; the letter N is an int, P the pattern of a shuffle.
 */
// clang-format off
#define SC_C_BYTES(ROW, name)   ROW(name, vec_uchar16, unsigned char,      vec_uchar16, vec_char16) \
                                ROW(name, vec_char16,  signed char,        vec_uchar16, vec_char16)
#define SC_C_HALVES(ROW, name)  ROW(name, vec_ushort8, unsigned short,     vec_ushort8, vec_short8) \
                                ROW(name, vec_short8,  short,              vec_ushort8, vec_short8)
#define SC_C_WORDS(ROW, name)   ROW(name, vec_uint4,   unsigned int,       vec_uint4,   vec_int4) \
                                ROW(name, vec_int4,    int,                vec_uint4,   vec_int4)
#define SC_C_LONGS(ROW, name)   ROW(name, vec_ullong2, unsigned long long, vec_ullong2, vec_llong2) \
                                ROW(name, vec_llong2,  long long,          vec_ullong2, vec_llong2)
#define SC_C_FLOATS(ROW, name)  ROW(name, vec_float4,  float,              vec_uint4,   vec_int4)
#define SC_C_DOUBLES(ROW, name) ROW(name, vec_double2, double,             vec_ullong2, vec_llong2)

#define SC_C_16_32(ROW, name)   SC_C_HALVES(ROW, name) SC_C_WORDS(ROW, name)
#define SC_C_8_16_32(ROW, name) SC_C_BYTES(ROW, name) SC_C_16_32(ROW, name)
#define SC_C_REALS(ROW, name)   SC_C_FLOATS(ROW, name) SC_C_DOUBLES(ROW, name)
#define SC_C_ALL(ROW, name)     SC_C_8_16_32(ROW, name) SC_C_LONGS(ROW, name) SC_C_REALS(ROW, name)

SC_C_ALL(SC_C_V_VVP, shuffle)
SC_C_REALS(SC_C_U_VV, cmpeq)
SC_C_REALS(SC_C_U_VV, cmpgt)
SC_C_REALS(SC_C_U_VV, cmpabseq)
SC_C_REALS(SC_C_U_VV, cmpabsgt)

SC_C_DOUBLES(SC_C_V_VV, add)  SC_C_DOUBLES(SC_C_V_VV, sub)  SC_C_DOUBLES(SC_C_V_VV, mul)
SC_C_DOUBLES(SC_C_V_VVV, madd)  SC_C_DOUBLES(SC_C_V_VVV, msub)  SC_C_DOUBLES(SC_C_V_VVV, nmsub)  SC_C_DOUBLES(SC_C_V_VVV, nmadd)
SC_C_WORDS(SC_C_V_VVV, addx)  SC_C_WORDS(SC_C_V_VVV, subx)
SC_C_WORDS(SC_C_V_VV, genc)   SC_C_WORDS(SC_C_V_VVV, gencx)
SC_C_WORDS(SC_C_V_VV, genb)   SC_C_WORDS(SC_C_V_VVV, genbx)

SC_C_BYTES(SC_C_U_V, cntb)
SC_C_WORDS(SC_C_U_V, cntlz)  SC_C_FLOATS(SC_C_U_V, cntlz)
SC_C_8_16_32(SC_C_B_V, gather)  SC_C_FLOATS(SC_C_B_V, gather)
SC_C_WORDS(SC_C_V_V, orx)

SC_C_16_32(SC_C_V_VU, sl)       SC_C_16_32(SC_C_V_VN, sl_n)
SC_C_16_32(SC_C_V_VU, sr)       SC_C_16_32(SC_C_V_VN, sr_n)
SC_C_16_32(SC_C_V_VU, sra)      SC_C_16_32(SC_C_V_VN, sra_n)
SC_C_16_32(SC_C_V_VI, rl)       SC_C_16_32(SC_C_V_VN, rl_n)
SC_C_16_32(SC_C_V_VI, rlmask)   SC_C_16_32(SC_C_V_VN, rlmask_n)
SC_C_16_32(SC_C_V_VI, rlmaska)  SC_C_16_32(SC_C_V_VN, rlmaska_n)

SC_C_ALL(SC_C_V_VN, slqw)      SC_C_ALL(SC_C_V_VN, slqwbyte)      SC_C_ALL(SC_C_V_VN, slqwbytebc)
SC_C_ALL(SC_C_V_VN, srqw)      SC_C_ALL(SC_C_V_VN, srqwbyte)      SC_C_ALL(SC_C_V_VN, srqwbytebc)
SC_C_ALL(SC_C_V_VN, rlqw)      SC_C_ALL(SC_C_V_VN, rlqwbyte)      SC_C_ALL(SC_C_V_VN, rlqwbytebc)
SC_C_ALL(SC_C_V_VN, rlmaskqw)  SC_C_ALL(SC_C_V_VN, rlmaskqwbyte)  SC_C_ALL(SC_C_V_VN, rlmaskqwbytebc)

/* SC_C_1(result, name, operand), SC_C_2, SC_C_3: the function's name ends with its first operand's type. */
SC_C_2(vec_float4, convtf, vec_uint4, int)  SC_C_2(vec_float4, convtf, vec_int4, int)
SC_C_2(vec_int4, convts, vec_float4, int)   SC_C_2(vec_uint4, convtu, vec_float4, int)
SC_C_1(vec_short8, extend, vec_char16)      SC_C_1(vec_int4, extend, vec_short8)
SC_C_1(vec_llong2, extend, vec_int4)        SC_C_1(vec_double2, extend, vec_float4)
SC_C_1(vec_float4, roundtf, vec_double2)    SC_C_2(vec_ullong2, testsv, vec_double2, int)
SC_C_1(vec_float4, re, vec_float4)          SC_C_1(vec_float4, rsqrte, vec_float4)
SC_C_3(vec_int4, madd, vec_short8, vec_short8, vec_int4)
SC_C_2(vec_uint4, mule, vec_ushort8, vec_ushort8)  SC_C_2(vec_int4, mule, vec_short8, vec_short8)
SC_C_2(vec_uint4, mulo, vec_ushort8, vec_ushort8)  SC_C_2(vec_int4, mulo, vec_short8, vec_short8)
SC_C_2(vec_int4, mulh, vec_short8, vec_short8)     SC_C_2(vec_int4, mulsr, vec_short8, vec_short8)
SC_C_3(vec_uint4, mhhadd, vec_ushort8, vec_ushort8, vec_uint4)
SC_C_3(vec_int4, mhhadd, vec_short8, vec_short8, vec_int4)
SC_C_2(vec_uchar16, absd, vec_uchar16, vec_uchar16)
SC_C_2(vec_uchar16, avg, vec_uchar16, vec_uchar16)
SC_C_2(vec_ushort8, sumb, vec_uchar16, vec_uchar16)
SC_C_1(vec_uchar16, maskb, int)  SC_C_1(vec_ushort8, maskh, int)  SC_C_1(vec_uint4, maskw, int)

/* The specific intrinsics, whose operands are registers without a type. */
SC_C_Q2(cbx) SC_C_Q2(chx) SC_C_Q2(cwx) SC_C_Q2(cdx)
SC_C_Q2(a) SC_C_Q2(ah) SC_C_Q2(sf) SC_C_Q2(sfh) SC_C_Q2(cg) SC_C_Q2(bg) SC_C_Q3(addx) SC_C_Q3(sfx) SC_C_Q3(cgx) SC_C_Q3(bgx)
SC_C_Q2(mpy) SC_C_Q2(mpyu) SC_C_Q2(mpyh) SC_C_Q2(mpys) SC_C_Q2(mpyhh) SC_C_Q2(mpyhhu) SC_C_Q3(mpyhha) SC_C_Q3(mpyhhau) SC_C_Q3(mpya)
SC_C_Q1(clz) SC_C_Q1(cntb) SC_C_Q1(fsm) SC_C_Q1(fsmh) SC_C_Q1(fsmb) SC_C_Q1(gb) SC_C_Q1(gbh) SC_C_Q1(gbb)
SC_C_Q1(xsbh) SC_C_Q1(xshw) SC_C_Q1(xswd) SC_C_Q1(orx) SC_C_Q2(avgb) SC_C_Q2(absdb) SC_C_Q2(sumb)
SC_C_Q2(and) SC_C_Q2(andc) SC_C_Q2(or) SC_C_Q2(orc) SC_C_Q2(xor) SC_C_Q2(nand) SC_C_Q2(nor) SC_C_Q2(eqv) SC_C_Q3(selb) SC_C_Q3(shufb)
SC_C_Q2(shl) SC_C_Q2(shlh) SC_C_Q2(rot) SC_C_Q2(roth) SC_C_Q2(rotm) SC_C_Q2(rothm) SC_C_Q2(rotma) SC_C_Q2(rotmah)
SC_C_Q2(shlqbi) SC_C_Q2(shlqby) SC_C_Q2(shlqbybi) SC_C_Q2(rotqbi) SC_C_Q2(rotqby) SC_C_Q2(rotqbybi)
SC_C_Q2(rotqmbi) SC_C_Q2(rotqmby) SC_C_Q2(rotqmbybi)
SC_C_Q2(ceq) SC_C_Q2(ceqh) SC_C_Q2(ceqb) SC_C_Q2(cgt) SC_C_Q2(cgth) SC_C_Q2(cgtb) SC_C_Q2(clgt) SC_C_Q2(clgth) SC_C_Q2(clgtb)
SC_C_Q2(fa) SC_C_Q2(fs) SC_C_Q2(fm) SC_C_Q2(fi) SC_C_Q2(fceq) SC_C_Q2(fcgt) SC_C_Q2(fcmeq) SC_C_Q2(fcmgt)
SC_C_Q3(fma) SC_C_Q3(fms) SC_C_Q3(fnms) SC_C_Q1(frest) SC_C_Q1(frsqest) SC_C_Q1(frds) SC_C_Q1(fesd)
SC_C_Q2(dfa) SC_C_Q2(dfs) SC_C_Q2(dfm) SC_C_Q3(dfma) SC_C_Q3(dfms) SC_C_Q3(dfnma) SC_C_Q3(dfnms)
    // clang-format on
