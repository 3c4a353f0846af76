/* Vectors of C: operators, casts, literals, storage. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "check.h"

typedef vec_float4 point;
typedef struct {
  vec_float4 position;
  vector unsigned int flags;
} particle;
union quadword {
  vec_uint4 v;
  unsigned int w[4];
};

static const vec_uchar16 reverse_words = {12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3};
static particle particles[2] = {{.flags = {1, 2, 3, 4}}, {{1.0f, 2.0f, 3.0f, 4.0f}, {5, 6, 7, 8}}};

static vec_float4 half(vec_float4 v) { return v * 0.5f; }

static void operators(void) {
  volatile vec_uint4 v = (vec_uint4){0};
  vec_int4 a = {1, -2, 3, -4}, b = {4, 3, 2, 1};
  int i;
  v = v + spu_splats(3u);
  v = v * spu_splats((unsigned int)2);
  CHECK(v[0] == 6 && v[3] == 6);
  a += b;
  CHECK(a[0] == 5 && a[1] == 1 && a[2] == 5 && a[3] == -3);
  a = -a << 1;
  CHECK(a[0] == -10 && a[3] == 6);
  CHECK(spu_extract(a > 0, 3) == -1 && spu_extract(a > 0, 0) == 0);
  for (i = 0; i < 4; ++i) b[i] = i * i;
  CHECK(b[3] == 9 && sizeof(b) == 16 && sizeof b[0] == 4);
  CHECK(half(particles[1].position)[3] == 2.0f);
  CHECK(particles[0].flags[2] == 3 && particles[0].position[0] == 0.0f);
  const vector float w = (vector float)(1.0f, 2.0f, 3.0f, 4.0f);
  CHECK(w[1] == 2.0f);
}

static void casts(void) {
  const vec_uint4 words = {0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F};
  const vec_uchar16 bytes = (vec_uchar16)words;
  const vec_ushort8 halves = (vec_ushort8)words;
  const vec_ullong2 longs = (vec_ullong2)bytes;
  CHECK(bytes[0] == 0 && bytes[5] == 5 && bytes[15] == 15);
  CHECK(halves[0] == 0x0001 && halves[1] == 0x0203 && halves[7] == 0x0E0F);
  CHECK(longs[0] == 0x0001020304050607ull);
  CHECK(((vec_uint4)(vec_uchar16)halves)[2] == 0x08090A0B);
  CHECK(((vec_uint4)(point){1.0f})[0] == 0x3F800000);
  CHECK(spu_extract((vec_ushort8)spu_splats(0x12345678u), 1) == 0x5678);
  const qword q = (qword)bytes;
  CHECK(si_to_uint(q) == 0x00010203);
}

static void intrinsics(void) {
  const vec_uint4 words = {1, 2, 3, 4};
  const vec_uint4 reversed = spu_shuffle(words, words, reverse_words);
  CHECK(reversed[0] == 4 && reversed[3] == 1);
  CHECK(spu_shuffle((vec_uchar16)words, (vec_uchar16)words, reverse_words)[3] == 4);
  CHECK(spu_extract(spu_add(words, 10), 1) == 12 && spu_extract(spu_sub(10, words), 1) == 8);
  CHECK(spu_extract(spu_madd(spu_splats(2.0f), spu_splats(3.0f), spu_splats(4.0f)), 2) == 10.0f);
  CHECK(spu_extract(spu_cmpgt(words, 2), 2) == 0xFFFFFFFF &&
        spu_extract(spu_cmpeq(words, spu_splats(2u)), 2) == 0);
  CHECK(spu_extract(spu_sel(words, spu_splats(9u), spu_cmpgt(words, 2)), 3) == 9);
  CHECK(spu_extract(spu_rlmask(words, -1), 3) == 2 && spu_extract(spu_sl(words, 4), 1) == 32);
  CHECK(spu_extract(spu_sl(words, ((vec_uint4){1, 2, 3, 4})), 3) == 64);
  CHECK(spu_extract(spu_rlqwbyte(words, 4), 0) == 2);
  CHECK(spu_extract(spu_gather(spu_cmpeq(words, 4)), 0) == 1);
  CHECK(spu_extract(spu_convtf(((vec_int4){-3, 8}), 1), 0) == -1.5f &&
        spu_extract(spu_convts(spu_splats(2.75f), 2), 0) == 11);
  CHECK(spu_extract(spu_extend(((vec_short8){0, -5})), 0) == -5);
  CHECK(spu_extract(spu_mulo(((vec_short8){0, 7}), ((vec_short8){0, -3})), 0) == -21);
  CHECK(spu_extract(spu_and(words, 1), 2) == 1 && spu_extract(spu_insert(7u, words, 2), 2) == 7);
  CHECK(spu_extract(spu_maskb(0x8001), 0) == 0xFF && spu_extract(spu_cntlz(words), 0) == 31);
  CHECK(spu_extract(spu_add(spu_add(spu_add(spu_add(spu_add(spu_add(words, 1), 2), 3), words),
                                    spu_and(spu_or(words, 8), 8)),
                            spu_sub(9, spu_sl(spu_add(words, words), 1))),
                    0) == 21);
  CHECK(si_to_int(si_ai(si_a(si_from_int(4), si_from_int(5)), -2)) == 7);
  CHECK(si_to_uchar(si_shufb(si_from_uint(0x11223344), si_from_uint(0), si_cbd(si_il(0), 3))) == 0x44);
  CHECK(si_to_float(si_fm(si_from_float(1.5f), si_from_float(2.0f))) == 3.0f);
}

/* Commas of a program's macro: the intrinsics of an SPU's compiler are functions. */
#define WORDS_1032 \
  (vec_uchar16) { 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11 }
#define ONES \
  (vec_uint4) { 1, 1, 1, 1 }
#define FLOATS \
  (vec_float4) { 1, 2, 3, 4 }
static void literals_of_macros(void) {
  const vec_uint4 words = {1, 2, 3, 4};
  CHECK(spu_extract(spu_shuffle(words, words, WORDS_1032), 2) == 4);
  CHECK(spu_extract(ONES, 3) == 1 && spu_extract(spu_add(ONES, words), 1) == 3 && spu_extract(spu_sub(words, ONES), 3) == 3);
  CHECK(spu_extract(spu_madd(FLOATS, FLOATS, FLOATS), 3) == 20 && spu_extract(spu_mul(FLOATS, FLOATS), 1) == 4);
  CHECK(spu_extract(spu_sel(words, ONES, spu_cmpgt(words, ONES)), 2) == 1 && spu_extract(spu_sl(words, ONES), 3) == 8);
  CHECK(spu_extract(spu_rlqwbyte(FLOATS, 4), 0) == 2 && spu_extract(spu_convts(FLOATS, 1), 0) == 2);
  CHECK(spu_extract(spu_insert(7u, ONES, 2), 2) == 7 && spu_extract(spu_splats(spu_extract(FLOATS, 1)), 3) == 2);
  CHECK(spu_extract(spu_gather(spu_cmpeq(ONES, ONES)), 0) == 15);
  CHECK(si_to_uint(si_a((qword)ONES, (qword)ONES)) == 2 && spu_extract(spu_or(ONES, spu_promote(6u, 0)), 0) == 7);
}

static void doubles(void) {
  const vec_double2 v = {-0.0, 1.0 / 0.0}, w = {0.0 / 0.0, -2.5};
  CHECK(spu_extract(spu_testsv(v, SPU_SV_NEG_ZERO | SPU_SV_NAN), 0) == ~0ull &&
        spu_extract(spu_testsv(v, SPU_SV_NEG_ZERO), 1) == 0);
  CHECK(spu_extract(spu_testsv(v, SPU_SV_POS_INFINITY), 1) == ~0ull &&
        spu_extract(spu_testsv(v, SPU_SV_NEG_INFINITY), 1) == 0);
  CHECK(spu_extract(spu_testsv(w, SPU_SV_NAN), 0) == ~0ull && spu_extract(spu_testsv(w, 0x7F), 1) == 0);
}

static void memory(unsigned long long ea) {
  union quadword q = {.v = {1, 2, 3, 4}};
  vec_float4* const row = (vec_float4*)particles;
  CHECK(q.w[0] == 1 && q.w[3] == 4);
  CHECK(row[2][0] == 1.0f);
  (void)ea;
}

int main(unsigned long long id, unsigned long long argp, unsigned long long envp) {
  operators();
  casts();
  intrinsics();
  literals_of_macros();
  doubles();
  memory(argp);
  return failures;
}
