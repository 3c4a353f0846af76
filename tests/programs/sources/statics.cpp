// A program in C++: static constructors, pointers in static data, main with four arguments.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdlib.h>

namespace {

struct Counter {
  explicit Counter(unsigned int v) : value(v * spu_extract(spu_splats(2u), 0)) {}
  unsigned int value;
};
Counter counter(21);

struct Shape {
  virtual unsigned int area() const = 0;
};
struct Square : Shape {
  unsigned int area() const override { return 9; }
};
const Square square;
const Shape* const shapes[] = {&square, &square};
unsigned int at_exit_calls;

/// What compilers of the SPU do with vectors.
struct Particle {
  vec_float4 position;
  vec_uint4 flags;
};
union Quadword {
  vec_uint4 v;
  unsigned int w[4];
};
bool vectors_have_operators() {
  volatile vec_uint4 v = (vec_uint4){0};
  v = v + spu_splats(3u);
  v = v * spu_splats(2u);
  v += 1;
  volatile vec_uchar16 c;
  c = spu_splats((unsigned char)'b');
  const vec_uchar16 small = spu_cmpgt(c, spu_splats((unsigned char)('a' - 1)));
  c = c - (spu_splats((unsigned char)0x20) & small);
  vec_int4 a = {1, -2, 3, -4}, b = {7};
  b[3] = 2;
  a = -a << 1;
  ++b;
  vec_float4 x = (vec_float4){1.0f, 2.0f, 3.0f, 4.0f} * 2 / 4.0f;
  x -= 0.5f;
  const Particle p = {x, (vec_uint4)(x > 0.75f)};
  Quadword q, copy;
  const vec_uint4 mask = spu_cmpgt(x, spu_splats(0.75f));
  const vec_uint4 both = mask & b, other = b | mask;  // of both signs
  const vec_int4 half = a >> (vec_uint4){1, 1, 1, 1}, same = a == (vec_uint4)a;
  if (both[0] != 0 || both[2] != 1 || other[1] != 1 || other[3] != 0xFFFFFFFF) return false;
  if (half[0] != -1 || half[3] != 4 || same[2] != -1) return false;
  if (si_to_uint((si_from_uint(6) & ~si_from_uint(4)) | si_from_uint(8)) != 10) return false;
  const vec_uint4 bytes_of_words = {0x01020304, 0x05060708, 0x090A0B0C, 0x0D0E0F10};
  const vec_char16 byte_lanes = si_from_uint(0x01020304);
  if (byte_lanes[1] != 2 || si_to_uint(si_ai(byte_lanes, 1)) != 0x01020305) return false;
  const qword pair = spu_slqwbyte((qword)bytes_of_words, 4), same_pair = pair;
  if (si_to_uint(pair) != 0x05060708 || spu_extract(pair, 1) != 6) return false;
  if (spu_extract(spu_gather(spu_cmpeq(pair, same_pair)), 0) != 0xFFFF) return false;
  q.v = (vec_uint4)a;
  copy = q;
  return v[3] == 7 && c[15] == 'B' && a[0] == -2 && a[3] == 8 && b[0] == 8 && b[1] == 1 && b[3] == 3 &&
         p.position[3] == 1.5f && p.flags[1] == 0 && p.flags[2] == 0xFFFFFFFF && copy.w[1] == 4 &&
         spu_extract(a != b, 0) == -1 && sizeof(v) == 16;
}

}  // namespace

int main(uint64_t first, uint64_t second, uint64_t third, uint64_t fourth) {
  if (counter.value != 42 || shapes[1]->area() != 9) return 1;
  if (first != 1 || second != 2 || third != 0x300000003 || fourth != 4) return 2;
  if (!vectors_have_operators()) return 4;
  atexit([] { ++at_exit_calls; });
  exit(at_exit_calls == 0 ? 0 : 3);
}
