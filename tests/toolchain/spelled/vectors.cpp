// Vectors as the SPU's compilers spell them, in C++, among other things that have these names or look like them.
// Its status is the number of the check that fails.
#include <spu_intrinsics.h>
#include <vec_literal.h>

template <class One, class Other>
constexpr bool kSame = false;
template <class One>
constexpr bool kSame<One, One> = true;
static_assert(kSame<vector unsigned char, vec_uchar16> && kSame<vector signed char, vec_char16> &&
              kSame<__vector char, vec_uchar16>);
static_assert(kSame<vector unsigned short, vec_ushort8> && kSame<vector short int, vec_short8> &&
              kSame<vector signed short, vec_short8>);
static_assert(kSame<vector unsigned, vec_uint4> && kSame<vector signed int, vec_int4> &&
              kSame<vector unsigned long, vec_uint4>);
static_assert(kSame<vector unsigned long long, vec_ullong2> && kSame<vector long long, vec_llong2>);
static_assert(kSame<__vector float, vec_float4> && kSame<vector double, vec_double2> &&
              kSame<const vector float, const vec_float4>);

namespace {

#define SWAPPED(v, pattern) ((vector float)spu_shuffle((v), (v), (pattern)))
typedef vector unsigned char bytes_t;
typedef vector float (*binary_t)(vector float, vector float);

class Vector3 {
 public:
  Vector3(float x, float y, float z) : v_((vector float){x, y, z, 0}) {}
  explicit Vector3(vector float v) : v_(v) {}
  float dot(const Vector3& other) const {
    const vector float products = v_ * other.v_;
    return products[0] + products[1] + products[2];
  }
  operator vector float() const { return v_; }

 private:
  vector float v_;
};
vector float sum(vector float a, vector float b) { return spu_add(a, b); }
const binary_t kSum = sum;
union Quadword {
  vector unsigned int v;
  unsigned int words[4];
};
const bytes_t kReversed = (vector unsigned char){12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3};
const vector signed int kOld = (vector signed int)(1, -2, 3, -4), kOther = (vec_int4)(5, 6, 7, 8);

int length(int vector, float x) { return vector + static_cast<int>(x); }

}  // namespace

int main() {
  int vector = 1'000;
  vector = vector * 2;
  const char* const text = R"(vector float "a)";
  Quadword quadword = {(__vector unsigned int){1, 2, 3, 4}};
  const int line = __LINE__;
  const vector  // a name in two lines
      float split = spu_splats(2.0f);
  if (__LINE__ != line + 3) return 8;
  __vector float* const pointer = const_cast<__vector float*>(&split);
  if (length(vector, 3.5f) != 2003 || text[13] != '"') return 1;
  if (Vector3(1, 2, 3).dot(Vector3(4, 5, 6)) != 32) return 2;
  if (spu_extract(kSum(Vector3(1, 2, 3), split), 1) != 4 || (*pointer)[3] != 2) return 3;
  if (spu_extract(SWAPPED(static_cast<vec_float4>(Vector3(1, 2, 3)), kReversed), 3) != 1) return 4;
  if (quadword.words[2] != 3 || sizeof(__vector double) != 16) return 5;
  if (kOld[1] != -2 || kOther[3] != 8 || VEC_LITERAL(__vector float, 1, 2, 3, 4)[2] != 3) return 6;
  if (((vec_uint4)kReversed)[0] != 0x0C0D0E0F) return 7;
  return 0;
}
