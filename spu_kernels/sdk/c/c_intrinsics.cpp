// The functions behind the intrinsics of C kernels: see softcell_c_rows.h. Each is the C++ intrinsic of the host, called with
// vectors as the C compiler passes them, which is how C++ passes the classes around them.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#define SC_C_NAME(name, V) softcell_c_##name##_##V
#define SC_C_V_V(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a) { return spu_##name(a); }
#define SC_C_U_V(name, V, S, U, I) \
  extern "C" U SC_C_NAME(name, V)(V a) { return spu_##name(a); }
#define SC_C_B_V(name, V, S, U, I) \
  extern "C" vec_uint4 SC_C_NAME(name, V)(V a) { return spu_##name(a); }
#define SC_C_V_VV(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, V b) { return spu_##name(a, b); }
#define SC_C_U_VV(name, V, S, U, I) \
  extern "C" U SC_C_NAME(name, V)(V a, V b) { return spu_##name(a, b); }
#define SC_C_V_VVV(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, V b, V c) { return spu_##name(a, b, c); }
#define SC_C_V_VVU(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, V b, U c) { return spu_##name(a, b, c); }
#define SC_C_V_VVP(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, V b, vec_uchar16 c) { return spu_##name(a, b, c); }
#define SC_C_V_VU(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, U b) { return spu_##name(a, b); }
#define SC_C_V_VI(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, I b) { return spu_##name(a, b); }
#define SC_C_V_VN(name, V, S, U, I) \
  extern "C" V SC_C_NAME(name, V)(V a, int count) { return SC_C_COUNTED_##name(a, count); }
#define SC_C_COUNTED_sl_n(a, n) spu_sl(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_sr_n(a, n) spu_sr(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_sra_n(a, n) spu_sra(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_rl_n(a, n) spu_rl(a, n)
#define SC_C_COUNTED_rlmask_n(a, n) spu_rlmask(a, n)
#define SC_C_COUNTED_rlmaska_n(a, n) spu_rlmaska(a, n)
#define SC_C_COUNTED_slqw(a, n) spu_slqw(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_slqwbyte(a, n) spu_slqwbyte(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_slqwbytebc(a, n) spu_slqwbytebc(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_srqw(a, n) spu_srqw(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_srqwbyte(a, n) spu_srqwbyte(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_srqwbytebc(a, n) spu_srqwbytebc(a, static_cast<unsigned int>(n))
#define SC_C_COUNTED_rlqw(a, n) spu_rlqw(a, n)
#define SC_C_COUNTED_rlqwbyte(a, n) spu_rlqwbyte(a, n)
#define SC_C_COUNTED_rlqwbytebc(a, n) spu_rlqwbytebc(a, n)
#define SC_C_COUNTED_rlmaskqw(a, n) spu_rlmaskqw(a, n)
#define SC_C_COUNTED_rlmaskqwbyte(a, n) spu_rlmaskqwbyte(a, n)
#define SC_C_COUNTED_rlmaskqwbytebc(a, n) spu_rlmaskqwbytebc(a, n)

#define SC_C_1(R, name, A) \
  extern "C" R SC_C_NAME(name, A)(A a) { return SC_C_CALL_##name(a); }
#define SC_C_2(R, name, A, B) \
  extern "C" R SC_C_NAME(name, A)(A a, B b) { return SC_C_CALL_##name(a, b); }
#define SC_C_3(R, name, A, B, C) \
  extern "C" R SC_C_NAME(name, A)(A a, B b, C c) { return SC_C_CALL_##name(a, b, c); }
#define SC_C_CALL_convtf(a, scale) softcell_sdk::to_float_by(a, scale)
#define SC_C_CALL_convts(a, scale) softcell_sdk::to_signed_by(a, scale)
#define SC_C_CALL_convtu(a, scale) softcell_sdk::to_unsigned_by(a, scale)
#define SC_C_CALL_testsv(a, kinds) softcell_sdk::special_values(a, kinds)
#define SC_C_CALL_extend(a) spu_extend(a)
#define SC_C_CALL_roundtf(a) spu_roundtf(a)
#define SC_C_CALL_re(a) spu_re(a)
#define SC_C_CALL_rsqrte(a) spu_rsqrte(a)
#define SC_C_CALL_madd(a, b, c) spu_madd(a, b, c)
#define SC_C_CALL_mule(a, b) spu_mule(a, b)
#define SC_C_CALL_mulo(a, b) spu_mulo(a, b)
#define SC_C_CALL_mulh(a, b) spu_mulh(a, b)
#define SC_C_CALL_mulsr(a, b) spu_mulsr(a, b)
#define SC_C_CALL_mhhadd(a, b, c) spu_mhhadd(a, b, c)
#define SC_C_CALL_absd(a, b) spu_absd(a, b)
#define SC_C_CALL_avg(a, b) spu_avg(a, b)
#define SC_C_CALL_sumb(a, b) spu_sumb(a, b)
#define SC_C_CALL_maskb(a) spu_maskb(a)
#define SC_C_CALL_maskh(a) spu_maskh(a)
#define SC_C_CALL_maskw(a) spu_maskw(a)

#define SC_C_Q1(name) \
  extern "C" qword softcell_c_si_##name(qword a) { return si_##name(a); }
#define SC_C_Q2(name) \
  extern "C" qword softcell_c_si_##name(qword a, qword b) { return si_##name(a, b); }
#define SC_C_Q3(name) \
  extern "C" qword softcell_c_si_##name(qword a, qword b, qword c) { return si_##name(a, b, c); }

#include "softcell_c_rows.h"

extern "C" unsigned int softcell_c_tag_reserve(unsigned int count) {
  return softcell_sdk::reserve_tags(count);
}
extern "C" unsigned int softcell_c_tag_release(unsigned int first, unsigned int count) {
  return softcell_sdk::release_tags(first, count);
}
