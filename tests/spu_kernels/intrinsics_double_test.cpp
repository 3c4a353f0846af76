// Double precision: IEEE 754 to nearest even with the SPU's treatment of denormals and NaN, whatever the
// kernel's own mode.
#include <cmath>

#include "intrinsics_support.h"

namespace softcell::test {
namespace {

class IntrinsicsDouble : public SpuArithmetic {};

using DoubleBits = std::uint64_t;
constexpr DoubleBits kNan = 0x7FF8000000000000, kSign = 0x8000000000000000;

bool is_nan(DoubleBits b) { return (b & ~kSign) > 0x7FF0000000000000; }
/// Denormal operands are zeros of their sign.
double operand(DoubleBits b) { return from_bits<double>((b & 0x7FF0000000000000) == 0 ? b & kSign : b); }

/// The host's own arithmetic for the time of one computation; volatile values stay between the switches.
template <class F>
DoubleBits nearest(F f, DoubleBits a, DoubleBits b, DoubleBits c = 0) {
  volatile double x = operand(a), y = operand(b), z = operand(c);
  const unsigned int mode = _mm_getcsr();
  _mm_setcsr(_MM_MASK_MASK);
  volatile double result = f(x, y, z);
  _mm_setcsr(mode);
  const DoubleBits bits = bits_of(double{result});
  return is_nan(bits) ? kNan : bits;
}
DoubleBits negated(DoubleBits b) { return b == kNan ? b : b ^ kSign; }

/// Random bits, or numbers near each other, or special ones.
DoubleBits value(Operands& operands) {
  switch (operands.count(0, 7)) {
    case 0: {
      const DoubleBits special[] = {0,
                                    kSign,
                                    1,
                                    kSign | 1,
                                    0x000FFFFFFFFFFFFF,
                                    0x0010000000000000,
                                    0x7FEFFFFFFFFFFFFF,
                                    0x7FF0000000000000,
                                    0xFFF0000000000000,
                                    kNan,
                                    0xFFF8000000000001,
                                    0x7FF0000000000001,
                                    0x3FF0000000000000};
      return special[operands.count(0, 12)];
    }
    case 1:
      return operands.bits();
    case 2:
      return (operands.bits() & 0x800FFFFFFFFFFFFF) | static_cast<DoubleBits>(operands.count(500, 520))
                                                          << 52;  // products denormal
    default:
      return (operands.bits() & 0x800FFFFFFFFFFFFF) | static_cast<DoubleBits>(operands.count(995, 1050))
                                                          << 52;
  }
}

template <class F, class M>
void check(const char* what, F function, M model) {
  Operands operands(70);
  for (int round = 0; round < 20000; ++round) {
    LanesOf<vec_ullong2> a, b, c, expected;
    for (std::size_t i = 0; i < 2; ++i) {
      a[i] = value(operands), b[i] = value(operands), c[i] = value(operands);
      expected[i] = model(a[i], b[i], c[i]);
    }
    const vec_ullong2 got(function(vec_double2(vector_of<vec_ullong2>(a)),
                                   vec_double2(vector_of<vec_ullong2>(b)),
                                   vec_double2(vector_of<vec_ullong2>(c))));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(got, expected, what))
        << std::hex << a[0] << ", " << b[0] << ", " << c[0] << "; " << a[1] << ", " << b[1] << ", " << c[1];
  }
}

TEST_F(IntrinsicsDouble, ArithmeticRoundsToNearest) {
  const auto fma = [](double x, double y, double z) { return std::fma(x, y, z); };
  const auto fms = [](double x, double y, double z) { return std::fma(x, y, -z); };
  check(
      "spu_add", [](auto a, auto b, auto) { return spu_add(a, b); },
      [](DoubleBits a, DoubleBits b, DoubleBits) {
        return nearest([](double x, double y, double) { return x + y; }, a, b);
      });
  check(
      "spu_sub", [](auto a, auto b, auto) { return spu_sub(a, b); },
      [](DoubleBits a, DoubleBits b, DoubleBits) {
        return nearest([](double x, double y, double) { return x - y; }, a, b);
      });
  check(
      "spu_mul", [](auto a, auto b, auto) { return spu_mul(a, b); },
      [](DoubleBits a, DoubleBits b, DoubleBits) {
        return nearest([](double x, double y, double) { return x * y; }, a, b);
      });
  check("spu_madd", SC_CALL(spu_madd),
        [&](DoubleBits a, DoubleBits b, DoubleBits c) { return nearest(fma, a, b, c); });
  check("spu_msub", SC_CALL(spu_msub),
        [&](DoubleBits a, DoubleBits b, DoubleBits c) { return nearest(fms, a, b, c); });
  check("spu_nmsub", SC_CALL(spu_nmsub),
        [&](DoubleBits a, DoubleBits b, DoubleBits c) { return negated(nearest(fms, a, b, c)); });
  check("spu_nmadd", SC_CALL(spu_nmadd),
        [&](DoubleBits a, DoubleBits b, DoubleBits c) { return negated(nearest(fma, a, b, c)); });
}

TEST_F(IntrinsicsDouble, Compares) {
  const auto mask = [](bool holds) { return holds ? ~DoubleBits{0} : DoubleBits{0}; };
  check(
      "spu_cmpeq", [](auto a, auto b, auto) { return spu_cmpeq(a, b); },
      [&](DoubleBits a, DoubleBits b, DoubleBits) {
        return mask(!is_nan(a) && !is_nan(b) && operand(a) == operand(b));
      });
  check(
      "spu_cmpgt", [](auto a, auto b, auto) { return spu_cmpgt(a, b); },
      [&](DoubleBits a, DoubleBits b, DoubleBits) {
        return mask(!is_nan(a) && !is_nan(b) && operand(a) > operand(b));
      });
  check(
      "spu_cmpabseq", [](auto a, auto b, auto) { return spu_cmpabseq(a, b); },
      [&](DoubleBits a, DoubleBits b, DoubleBits) {
        return mask(!is_nan(a) && !is_nan(b) && std::fabs(operand(a)) == std::fabs(operand(b)));
      });
  check(
      "spu_cmpabsgt", [](auto a, auto b, auto) { return spu_cmpabsgt(a, b); },
      [&](DoubleBits a, DoubleBits b, DoubleBits) {
        return mask(!is_nan(a) && !is_nan(b) && std::fabs(operand(a)) > std::fabs(operand(b)));
      });
  // Equal operands are rare among random ones.
  const vec_double2 a{-1.5, 2.0}, b{1.5, 2.0};
  expect_lanes(spu_cmpeq(a, b), {0, ~0ull}, "spu_cmpeq");
  expect_lanes(spu_cmpabseq(a, b), {~0ull, ~0ull}, "spu_cmpabseq");
}

TEST_F(IntrinsicsDouble, SpecialValues) {
  const struct {
    DoubleBits bits;
    int kind;
  } values[] = {{1, SPU_SV_POS_DENORM},
                {kSign | 0x000FFFFFFFFFFFFF, SPU_SV_NEG_DENORM},
                {0, SPU_SV_POS_ZERO},
                {kSign, SPU_SV_NEG_ZERO},
                {0x7FF0000000000000, SPU_SV_POS_INFINITY},
                {0xFFF0000000000000, SPU_SV_NEG_INFINITY},
                {0x7FF0000000000001, SPU_SV_NAN},
                {0xFFF8000000000000, SPU_SV_NAN},
                {0x3FF0000000000000, 0},
                {0x0010000000000000, 0},
                {0xFFEFFFFFFFFFFFFF, 0}};
  for (const auto& v : values) {
    const vec_double2 a(spu_splats(v.bits));
    const auto expect = [&](vec_ullong2 got, int kinds) {
      EXPECT_EQ(spu_extract(got, 1), (v.kind & kinds) != 0 ? ~DoubleBits{0} : 0)
          << std::hex << v.bits << " tested for " << kinds;
    };
    expect(spu_testsv(a, SPU_SV_NEG_DENORM), SPU_SV_NEG_DENORM);
    expect(spu_testsv(a, SPU_SV_POS_DENORM), SPU_SV_POS_DENORM);
    expect(spu_testsv(a, SPU_SV_NEG_ZERO), SPU_SV_NEG_ZERO);
    expect(spu_testsv(a, SPU_SV_POS_ZERO), SPU_SV_POS_ZERO);
    expect(spu_testsv(a, SPU_SV_NEG_INFINITY), SPU_SV_NEG_INFINITY);
    expect(spu_testsv(a, SPU_SV_POS_INFINITY), SPU_SV_POS_INFINITY);
    expect(spu_testsv(a, SPU_SV_NAN), SPU_SV_NAN);
    expect(spu_testsv(a, 0x7F), 0x7F);
    expect(spu_testsv(a, 0), 0);
  }
}

TEST_F(IntrinsicsDouble, ExtendReadsWordsZeroAndTwo) {
  Operands operands(71);
  for (int round = 0; round < 20000; ++round) {
    const vec_float4 a = operands.vector<vec_float4>();
    LanesOf<vec_ullong2> expected;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint32_t f = bits_of(lanes(a)[2 * i]);
      const DoubleBits sign = DoubleBits{f & 0x80000000} << 32, exponent = f >> 23 & 0xFF,
                       fraction = f & 0x7FFFFF;
      expected[i] = exponent == 0    ? sign
                    : exponent < 255 ? sign | (exponent + 896) << 52 | fraction << 29
                    : fraction == 0  ? sign | 0x7FF0000000000000
                                     : kNan;
    }
    ASSERT_NO_FATAL_FAILURE(expect_lanes(vec_ullong2(spu_extend(a)), expected, "spu_extend"))
        << register_of(a);
  }
}

TEST_F(IntrinsicsDouble, RoundToSingleIsToNearest) {
  Operands operands(72);
  for (int round = 0; round < 20000; ++round) {
    LanesOf<vec_ullong2> a;
    for (auto& lane : a) {
      lane = value(operands);
      if (round % 3 == 0) lane = (lane & ~0x1FFFFFFFull) | 0x10000000;  // halfway between two floats
      if (round % 5 == 0)
        lane = (lane & 0x800FFFFFFFFFFFFF) | static_cast<DoubleBits>(operands.count(870, 900))
                                                 << 52;  // denormal
    }
    LanesOf<vec_uint4> expected{};
    for (std::size_t i = 0; i < 2; ++i) {
      volatile double x = operand(a[i]);
      const unsigned int mode = _mm_getcsr();
      _mm_setcsr(_MM_MASK_MASK);
      volatile float result = static_cast<float>(x);
      _mm_setcsr(mode);
      expected[2 * i] = is_nan(a[i]) ? 0x7FC00000 : bits_of(float{result});
    }
    const vec_float4 got = spu_roundtf(vec_double2(vector_of<vec_ullong2>(a)));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(vec_uint4(got), expected, "spu_roundtf"))
        << std::hex << a[0] << ", " << a[1];
  }
}

}  // namespace
}  // namespace softcell::test
