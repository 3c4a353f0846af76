// vmx2spu.h: operations of VMX, each lane against what the manual of AltiVec says of it.
#include <vec_literal.h>
#include <vmx2spu.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "check.h"

namespace {

unsigned int state = 1;
unsigned int any_number() {
  state = state * 1664525u + 1013904223u;
  return state ^ state >> 13;
}
template <class V>
V any_vector() {
  vec_uint4 v = spu_splats(0u);
  for (int i = 0; i < 4; ++i) v = spu_insert(any_number(), v, i);
  return (V)v;
}
template <class V>
using Lane = softcell_vmx::Lane<V>;
template <class V>
constexpr int kLanes = softcell_vmx::Lanes<V>::kCount;

#define FOR_LANES(V, condition)                           \
  do {                                                    \
    for (int i = 0; i < kLanes<V>; ++i) CHECK(condition); \
  } while (0)
#define AT(v) spu_extract(v, i)

template <class V>
void whole_numbers() {
  using N = Lane<V>;
  using M = softcell_vmx::Mask<V>;
  constexpr unsigned int kBits = 8 * sizeof(N);
  constexpr long long kMost = N(-1) > N(0) ? (1ll << kBits) - 1 : (1ll << (kBits - 1)) - 1;
  constexpr long long kLeast = N(-1) > N(0) ? 0 : -kMost - 1;
  const auto cut = [&](long long n) { return n > kMost ? kMost : n < kLeast ? kLeast : n; };
  for (int n = 0; n < 20; ++n) {
    const V a = any_vector<V>(), b = any_vector<V>();
    const M counts = (M)any_vector<M>();
    FOR_LANES(V, AT(vec_add(a, b)) == (N)(AT(a) + AT(b)) && AT(vec_sub(a, b)) == (N)(AT(a) - AT(b)));
    FOR_LANES(V, AT(vec_adds(a, b)) == cut((long long)AT(a) + AT(b)) &&
                     AT(vec_subs(a, b)) == cut((long long)AT(a) - AT(b)));
    FOR_LANES(V, AT(vec_min(a, b)) == (AT(a) < AT(b) ? AT(a) : AT(b)) &&
                     AT(vec_max(a, b)) == (AT(a) > AT(b) ? AT(a) : AT(b)));
    FOR_LANES(V, AT(vec_avg(a, b)) == (N)(((long long)AT(a) + AT(b) + 1) >> 1));
    FOR_LANES(V, AT(vec_sl(a, counts)) == (N)((unsigned long long)AT(a) << AT(counts) % kBits));
    FOR_LANES(V, AT(vec_sr(a, counts)) == (N)((Lane<M>)AT(a) >> AT(counts) % kBits));
    FOR_LANES(V, AT(vec_rl(a, counts)) ==
                     (N)(AT(vec_sl(a, counts)) |
                         (Lane<M>)((unsigned long long)(Lane<M>)AT(a) >> (kBits - AT(counts) % kBits))));
    FOR_LANES(V, AT(vec_cmpeq(a, a)) == (Lane<M>)-1 && (AT(vec_cmpgt(a, b)) != 0) == (AT(a) > AT(b)) &&
                     (AT(vec_cmplt(a, b)) != 0) == (AT(a) < AT(b)));
    FOR_LANES(V, AT(vec_sel(a, b, counts)) == (N)((AT(a) & ~AT(counts)) | (AT(b) & AT(counts))));
    FOR_LANES(V, AT(vec_mergeh(a, b)) == spu_extract(i % 2 == 0 ? a : b, i / 2));
    FOR_LANES(V, AT(vec_mergel(a, b)) == spu_extract(i % 2 == 0 ? a : b, kLanes<V> / 2 + i / 2));
    FOR_LANES(V, AT(vec_splat(a, 1)) == spu_extract(a, 1));
    FOR_LANES(V, AT(vec_and(a, b)) == (N)(AT(a) & AT(b)) && AT(vec_andc(a, b)) == (N)(AT(a) & ~AT(b)) &&
                     AT(vec_nor(a, b)) == (N) ~(AT(a) | AT(b)));
    FOR_LANES(V, AT(vec_or(a, counts)) == (N)(AT(a) | AT(counts)) &&
                     AT(vec_xor(counts, a)) == (N)(AT(a) ^ AT(counts)));
    CHECK(vec_all_eq(a, a) &&
          vec_any_ne(a, vec_add(a, (V)vec_splat(b, 0))) == !vec_all_eq(a, vec_add(a, (V)vec_splat(b, 0))));
    CHECK(vec_all_ge(a, a) && vec_all_le(a, a) && !vec_any_gt(a, a) && !vec_any_lt(a, a) &&
          vec_any_eq(a, a) && !vec_all_ne(a, a));
    CHECK(vec_all_gt(a, b) == !vec_any_le(a, b) && vec_all_lt(a, b) == !vec_any_ge(a, b));
  }
}

void signed_numbers() {
  const vec_short8 a = any_vector<vec_short8>(), b = any_vector<vec_short8>(),
                   least = spu_splats((short)-32768);
  const vec_ushort8 ua = (vec_ushort8)a, ub = (vec_ushort8)b;
  const vec_char16 c = any_vector<vec_char16>(), d = any_vector<vec_char16>();
  const vec_int4 w = any_vector<vec_int4>();
  FOR_LANES(vec_short8, AT(vec_abs(a)) == (short)std::abs(AT(a)) && AT(vec_abs(least)) == -32768 &&
                            AT(vec_abss(least)) == 32767);
  FOR_LANES(vec_int4, AT(vec_sra(w, spu_splats(35u))) == AT(w) >> 3);
  FOR_LANES(vec_int4, AT(vec_mule(a, b)) == spu_extract(a, 2 * i) * spu_extract(b, 2 * i));
  FOR_LANES(vec_uint4,
            AT(vec_mulo(ua, ub)) == (unsigned int)spu_extract(ua, 2 * i + 1) * spu_extract(ub, 2 * i + 1));
  FOR_LANES(vec_short8, AT(vec_mule(c, d)) == spu_extract(c, 2 * i) * spu_extract(d, 2 * i) &&
                            AT(vec_mulo(c, d)) == spu_extract(c, 2 * i + 1) * spu_extract(d, 2 * i + 1));
  FOR_LANES(vec_short8, AT(vec_mladd(a, b, a)) == (short)(AT(a) * AT(b) + AT(a)));
  FOR_LANES(vec_short8, AT(vec_madds(least, least, a)) == (AT(a) >= 0 ? 32767 : (short)(32768 + AT(a))));
  FOR_LANES(vec_short8, AT(vec_mradds(a, spu_splats((short)0x4000), spu_splats((short)1))) ==
                            ((AT(a) * 0x4000 + 0x4000) >> 15) + 1);
  FOR_LANES(vec_short8,
            AT(vec_unpackh(c)) == spu_extract(c, i) && AT(vec_unpackl(c)) == spu_extract(c, 8 + i));
  FOR_LANES(vec_int4, AT(vec_unpackh(a)) == spu_extract(a, i) && AT(vec_unpackl(a)) == spu_extract(a, 4 + i));
  FOR_LANES(vec_uchar16,
            AT(vec_pack(ua, ub)) == (unsigned char)(i < 8 ? spu_extract(ua, i) : spu_extract(ub, i - 8)));
  const vec_char16 packed = vec_packs(a, b);
  const vec_uchar16 unsigned_ones = vec_packsu(a, b);
  for (int i = 0; i < 16; ++i) {
    const int number = i < 8 ? spu_extract(a, i) : spu_extract(b, i - 8);
    CHECK(AT(packed) == (number > 127 ? 127 : number < -128 ? -128 : number));
    CHECK(AT(unsigned_ones) == (number > 255 ? 255 : number < 0 ? 0 : number));
  }
}

void floats() {
  const vec_float4 a = {1.5f, -2.5f, 3.5f, -0.25f}, b = {2.0f, -2.5f, -1.0f, 1e10f};
  FOR_LANES(vec_float4, AT(vec_madd(a, b, a)) == AT(spu_madd(a, b, a)) &&
                            AT(vec_nmsub(a, b, a)) == AT(spu_nmsub(a, b, a)));
  FOR_LANES(vec_float4, AT(vec_floor(a)) == floorf(AT(a)) && AT(vec_ceil(a)) == ceilf(AT(a)) &&
                            AT(vec_trunc(a)) == truncf(AT(a)));
  FOR_LANES(vec_float4, AT(vec_round(a)) == rintf(AT(a)) && AT(vec_floor(b)) == floorf(AT(b)) &&
                            AT(vec_round(b)) == rintf(AT(b)));
  FOR_LANES(vec_float4, AT(vec_abs(a)) == fabsf(AT(a)) && AT(vec_min(a, b)) == fminf(AT(a), AT(b)) &&
                            AT(vec_max(a, b)) == fmaxf(AT(a), AT(b)));
  FOR_LANES(vec_float4, AT(vec_add(a, b)) == AT(spu_add(a, b)) && AT(vec_sub(a, b)) == AT(spu_sub(a, b)));
  FOR_LANES(vec_float4,
            (AT(vec_cmpge(a, b)) != 0) == (AT(a) >= AT(b)) && (AT(vec_cmple(a, b)) != 0) == (AT(a) <= AT(b)));
  FOR_LANES(vec_float4,
            fabsf(AT(vec_re(b)) * AT(b) - 1) < 0x1p-11f &&
                fabsf(AT(vec_rsqrte(vec_abs(a))) * AT(vec_rsqrte(vec_abs(a))) * fabsf(AT(a)) - 1) < 0x1p-10f);
  FOR_LANES(vec_float4, AT(vec_ctf(spu_splats(12), 2)) == 3 && AT(vec_cts(a, 1)) == (int)(AT(a) * 2) &&
                            AT(vec_ctu(vec_abs(a), 2)) == (unsigned int)(fabsf(AT(a)) * 4));
  FOR_LANES(vec_float4, AT(vec_and(a, vec_cmpgt(a, b))) == (AT(a) > AT(b) ? AT(a) : 0) &&
                            AT(vec_or(vec_cmpgt(b, spu_splats(1e30f)), a)) == AT(a));
  CHECK(vec_all_numeric(a) && !vec_any_nan(a) && vec_all_in(a, spu_splats(4.0f)) &&
        vec_any_out(b, spu_splats(4.0f)) && vec_any_nge(a, b) && !vec_all_nlt(a, b));
}

void places() {
  alignas(16) static unsigned char bytes[64];
  alignas(16) static float numbers[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  for (int i = 0; i < 64; ++i) bytes[i] = (unsigned char)i;
  for (int at = 0; at < 17; ++at) {
    const unsigned char* const from = bytes + 16 + at;
    const vec_uchar16 whole = vec_perm(vec_ld(0, from), vec_ld(15, from), vec_lvsl(0, from));
    FOR_LANES(vec_uchar16, AT(whole) == 16 + at + i);
    const vec_uchar16 parts = vec_or(vec_lvlx(0, from), vec_lvrx(16, from));
    FOR_LANES(vec_uchar16, AT(parts) == 16 + at + i);
    const vec_uchar16 right = vec_perm(vec_ld(0, bytes), vec_ld(16, bytes), vec_lvsr(0, from));
    FOR_LANES(vec_uchar16, AT(right) == 16 - at % 16 + i);
    const vec_uchar16 moved = vec_sld(vec_ld(0, bytes), vec_ld(16, bytes), at % 16);
    FOR_LANES(vec_uchar16, AT(moved) == at % 16 + i);
  }
  const vec_float4 second = vec_ld(16, numbers);
  CHECK(spu_extract(second, 0) == 5 && spu_extract(vec_ld(0, numbers + 3), 0) == 1 &&
        spu_extract(vec_lde(0, numbers + 6), 2) == 7);
  vec_st(vec_add(second, second), 0, numbers);
  vec_ste(second, 4, numbers + 4);
  CHECK(numbers[0] == 10 && numbers[3] == 16 && numbers[5] == 6 && spu_extract(vec_ldl(0, numbers), 1) == 12);
  vec_stl(second, 16, numbers);
  const vec_uchar16 ramp = vec_ld(0, bytes), three_bytes = vec_splat_u8(24);
  CHECK(spu_extract(vec_slo(ramp, three_bytes), 0) == 3 && spu_extract(vec_slo(ramp, three_bytes), 13) == 0);
  CHECK(spu_extract(vec_sro(ramp, three_bytes), 3) == 0 && spu_extract(vec_sro(ramp, three_bytes), 15) == 12);
  CHECK(spu_extract(vec_splat_s8(-3), 9) == -3 && spu_extract(vec_splat_s16(-3), 7) == -3 &&
        spu_extract(vec_splat_u16(3), 7) == 3);
  CHECK(spu_extract(vec_splat_s32(-3), 3) == -3 && spu_extract(vec_splat_u32(3), 3) == 3);
  vec_dst(bytes, 0, 0);
  vec_dss(0);
}

void literals() {
  const vec_float4 v = VEC_LITERAL(vec_float4, 1, 2, 3, 4);
  static const vec_bint4 mask = VEC_SPLAT_U32(0xFFFFFFFFu);
  CHECK(spu_extract(v, 2) == 3 && vec_all_eq(mask, vec_cmpeq(v, v)) &&
        spu_extract(VEC_SPLAT_F32(0.5f), 3) == 0.5f);
  CHECK(spu_extract(VEC_SPLAT_U8(200), 15) == 200 && spu_extract(VEC_SPLAT_S8(-2), 15) == -2 &&
        spu_extract(VEC_SPLAT_U16(60000), 7) == 60000);
  CHECK(spu_extract(VEC_SPLAT_S16(-2), 7) == -2 && spu_extract(VEC_SPLAT_S32(-2), 3) == -2 &&
        spu_extract(VEC_SPLAT_U64(5), 1) == 5);
  CHECK(spu_extract(VEC_SPLAT_S64(-5), 1) == -5 && spu_extract(VEC_SPLAT_F64(2.5), 1) == 2.5);
}

}  // namespace

int main() {
  whole_numbers<vec_uchar16>();
  whole_numbers<vec_char16>();
  whole_numbers<vec_ushort8>();
  whole_numbers<vec_short8>();
  whole_numbers<vec_uint4>();
  whole_numbers<vec_int4>();
  signed_numbers();
  floats();
  places();
  literals();
  std::exit(failures);
}
