/* Which parentheses are a cast between vectors: through names of types, in every kind of function, of every kind of operand. */
#include <spu_intrinsics.h>
#include <vec_literal.h>

#include "check.h"

/* Names of types. */
typedef vector unsigned char bytes_of_vector;
typedef __vector unsigned char bytes_of_attribute;
typedef unsigned char bytes_behind __attribute__((__vector_size__(16)));
typedef unsigned char byte;
typedef vec_uchar16 first_name, second_name, *bytes_pointer;
typedef vec_uchar16 aligned_bytes __attribute__((aligned(16)));
typedef second_name renamed;
typedef __typeof__((vec_uchar16){0}) bytes_of_value;
typedef void (*handler)(vec_uchar16);

/* Members are no names of types. */
typedef struct {
  vec_float4 pos;
  vec_float4 vel;
  float mass;
} particle;
typedef union {
  vec_float4 v;
  float f[4];
} u4;
#define MUL(a, b) ((a) * (b))
#define SUB(a, b) ((a) - (b))
#define AND(a, b) ((a) & (b))

static const vec_uint4 words = {0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F};
static int counted;

static int in_order(vec_uchar16 v) {
  int i, right = 0;
  for (i = 0; i < 16; ++i) right += v[i] == i;
  return right == 16;
}

static void names(void) {
  typedef vector unsigned char local;
  vec_uchar16 x = {0};
  CHECK(in_order((bytes_of_vector)words));
  CHECK(in_order((bytes_of_attribute)words));
  CHECK(in_order((bytes_behind)words));
  CHECK(in_order((first_name)words));
  CHECK(in_order((second_name)words));
  CHECK(in_order((aligned_bytes)words));
  CHECK(in_order((renamed)words));
  CHECK(in_order((local)words));
  CHECK(in_order((const vector unsigned char)words));
  CHECK(in_order((__vector unsigned char)words));
  CHECK(in_order((__vector byte)words));
  CHECK(in_order((unsigned vector char)words));
  CHECK(in_order((__typeof__(x))words));
  CHECK(in_order((bytes_of_value)words));
  CHECK(in_order((__typeof__(x))(__typeof__(words))(vec_ushort8)words));
  CHECK(((vec_uint4)(renamed)words)[1] == 0x04050607);
}

/* A cast to the type of a value that is no vector stays what it is. */
static void types_of_values(void) {
  struct {
    unsigned int low : 4, high : 4;
  } fields = {5, 9};
  unsigned int count = 0;
  float real = 2.75f;
  const char* text = "text";
  static int seven = (__typeof__(counted))7;
  count = (__typeof__(count))real + (__typeof__(count))fields.high + (__typeof__(count))seven;
  CHECK(count == 18 && (__typeof__(text))&text[1] == text + 1);
  CHECK(((__typeof__(real))count) / 4 == 4.5f);
}

static vec_float4 step(particle* p, vec_float4 dt) {
  vec_float4 pos = p->pos, vel = p->vel;
  pos = pos + MUL(vel, dt);
  return SUB(pos, dt);
}

static void members(void) {
  particle p = {{1.0f, 2.0f, 3.0f, 4.0f}, {4.0f, 3.0f, 2.0f, 1.0f}, 1.0f};
  const vec_uint4 v = {7, 6, 5, 4};
  u4 f;
  f.v = step(&p, spu_splats(2.0f));
  CHECK(f.f[0] == 7.0f && f.f[3] == 4.0f);
  CHECK(AND(v, words)[0] == (7 & 0x00010203));
}

/* Parameters as old C declares them. */
// clang-format off
static unsigned int byte_of_words(i, more)
int i;
int *more;
{
  return spu_extract((vec_uchar16)words, i + *more);
}
// clang-format on

static vec_uint4 next(vec_uint4 v) {
  ++counted;
  return v;
}

static void operands(void) {
  unsigned int array[8]
      __attribute__((aligned(16))) = {0, 0, 0, 0, 0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F};
  const vec_uint4 rows[2] = {{1, 2, 3, 4}, {0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F}};
  const vec_uint4* row = rows;
  void* const memory = array;
  int i = 4, two = 2;
  CHECK(byte_of_words(i, &two) == 6);
  CHECK(in_order((vec_uchar16) * (vec_uint4*)&array[4]));
  CHECK(in_order((vec_uchar16) * ((vec_uint4*)memory + 1)));
  CHECK(in_order((vec_uchar16)((vec_uint4*)memory)[1]));
  CHECK(in_order((vec_uchar16) * (const vec_uint4*)(const void*)&array[i]));
  CHECK(in_order((vec_uchar16) * ++row) && row == rows + 1);
  CHECK(in_order((vec_uchar16)*row--) && row == rows);
  CHECK(in_order((vec_uchar16)(row[1])));
  CHECK(in_order((vec_uchar16) ~(vec_ushort8)~words));
  CHECK(in_order((vec_uchar16) - (vec_int4)-words));
  CHECK(in_order(
      (vec_uchar16)(spu_sel((vec_ushort8)words, (vec_ushort8)rows[0], (vec_ushort8)(words == rows[0])))));
  CHECK(((vec_uint4)spu_promote(0x0001020304050607ull, 0))[1] == 0x04050607);
  CHECK(((vec_ullong2)spu_promote(0x0001020304050607ull, 0))[0] == 0x0001020304050607ull);
  CHECK(in_order((vec_uchar16)next(words)) && counted == 1);
  CHECK(in_order((__typeof__((vec_uchar16){0}))next(words)) && counted == 2);
  CHECK(in_order((vec_uchar16)(counted = 3, words)) && counted == 3);
  CHECK(((vec_ushort8)(i++, words))[1] == 0x0203);
  CHECK(in_order((vec_uchar16)(vec_uint4)(0x00010203, 0x04050607, 0x08090A0B, 0x0C0D0E0F)));
  CHECK(((vec_uchar16)words)[5] - 1 == 4 && ((vec_float4)(words))[1] > 0);
}

/* In a macro of the SDK. */
static void channels(void) {
  const vec_uchar16 bytes = {0, 0, 0, 1, 2, 3};
  spu_writechqw(SPU_WrEventMask, bytes);
  CHECK(spu_readch(SPU_RdEventMask) == 1);
  spu_writechqw(SPU_WrEventMask, ((vec_uint4){2, 3, 4, 5}));
  CHECK(spu_readch(SPU_RdEventMask) == 2);
}

/* Static data begin with literals of either spelling, const or not, in as many parentheses as macros have, also of the SDK's headers. */
#define SPLAT_BYTES(n) ((vec_uchar16){n, n, n, n, n, n, n, n, n, n, n, n, n, n, n, n})
struct packet {
  vector unsigned int words;
  int count;
  vector unsigned char bytes[2];
};
static vector unsigned char places = ((vec_uchar16){3, 1, 4, 1, 5, 9});
static const vec_float4 point = (vec_float4){1, 2, 3, 4}, other = ((vector float){5, 6, 7, 8});
const vector float points[3] = {((vec_float4){1, 2, 3, 4}), (vector float){5, 6, 7, 8}, (vec_float4)(9, 10, 11, 12)};
static const struct packet packet = {(vec_uint4){1, 2, 3, 4}, 5, {SPLAT_BYTES(7), (((vec_uchar16){8}))}};
static struct packet named = {.count = 9, .words = (vec_uint4){10, 11, 12, 13}};
static const vector unsigned int ones = VEC_SPLAT_U32(1), counted_ones = VEC_LITERAL(vec_uint4, 1, 2, 3, 4);

static vec_uint4 added(vec_uint4 v) {
  static const vec_uint4 hundreds = ((vec_uint4){100, 200, 300, 400});
  static vec_uint4 calls = (vector unsigned int){0, 0};
  vec_uint4 result;
  result = (vec_uint4){1, 2, 3, 4};
  calls += (vec_uint4){1};
  return result + v + hundreds + calls;
}

static void static_literals(void) {
  const vector unsigned char here = ((vec_uchar16){6});
  CHECK(places[5] == 9 && places[6] == 0 && point[3] == 4 && other[0] == 5 && here[0] == 6);
  CHECK(points[0][1] == 2 && points[1][2] == 7 && points[2][3] == 12);
  CHECK(packet.words[2] == 3 && packet.count == 5 && packet.bytes[0][15] == 7 && packet.bytes[1][0] == 8);
  CHECK(named.count == 9 && named.words[3] == 13 && ones[3] == 1 && counted_ones[2] == 3);
  CHECK(added(ones)[0] == 103 && added(ones)[0] == 104 && added(ones)[3] == 405);
}

int main(void) {
  static_literals();
  names();
  types_of_values();
  members();
  operands();
  channels();
  return failures;
}
