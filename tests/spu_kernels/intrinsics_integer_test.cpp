// Integer arithmetic, bytes, counting, sign extension; shifts and rotates of lanes. Definitions from the
// instruction set.
#include "intrinsics_support.h"

namespace softcell::test {
namespace {

class IntrinsicsInteger : public SpuArithmetic {};

TEST_F(IntrinsicsInteger, AddAndSubtractWrap) {
  for_each(HalfAndWordVectors{}, []<class V>() {
    using T = typename V::Lane;
    const auto sum = [](T a, T b) { return std::int64_t{a} + b; };
    const auto difference = [](T a, T b) { return std::int64_t{a} - b; };
    check2<V, V, V>("spu_add", SC_CALL(spu_add), sum);
    check2<V, V, V>("spu_sub", SC_CALL(spu_sub), difference);
    check_scalar<V, V, T>("spu_add", SC_CALL(spu_add), sum);
    check_scalar<V, V, T>(
        "spu_sub", [](V b, T a) { return spu_sub(a, b); }, [](T b, T a) { return std::int64_t{a} - b; });
  });
}

TEST_F(IntrinsicsInteger, CarriesAndBorrowsReadOneBit) {
  for_each(WordVectors{}, []<class V>() {
    using T = typename V::Lane;
    const auto u = [](T x) { return std::uint64_t{static_cast<std::uint32_t>(x)}; };
    check3<V, V, V, V>("spu_addx", SC_CALL(spu_addx),
                       [u](T a, T b, T c) { return u(a) + u(b) + (u(c) & 1); });
    check3<V, V, V, V>("spu_subx", SC_CALL(spu_subx),
                       [u](T a, T b, T c) { return u(a) + (~u(b) & 0xFFFFFFFF) + (u(c) & 1); });
    check2<V, V, V>("spu_genc", SC_CALL(spu_genc), [u](T a, T b) { return (u(a) + u(b)) >> 32; });
    check3<V, V, V, V>("spu_gencx", SC_CALL(spu_gencx),
                       [u](T a, T b, T c) { return (u(a) + u(b) + (u(c) & 1)) >> 32; });
    check2<V, V, V>("spu_genb", SC_CALL(spu_genb), [u](T a, T b) { return u(a) >= u(b) ? 1 : 0; });
    check3<V, V, V, V>("spu_genbx", SC_CALL(spu_genbx),
                       [u](T a, T b, T c) { return ((u(c) & 1) != 0 ? u(a) >= u(b) : u(a) > u(b)) ? 1 : 0; });
  });
}

/// Products of halves: model(high half of a, low half of a, the same of b).
template <class R, class A, class F, class M>
void check_product(const char* what, F function, M model) {
  Operands operands(20);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>(), b = operands.vector<A>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t value = model(std::int64_t{lanes(a)[2 * i]}, std::int64_t{lanes(a)[2 * i + 1]},
                                       std::int64_t{lanes(b)[2 * i]}, std::int64_t{lanes(b)[2 * i + 1]});
      expected[i] = static_cast<typename R::Lane>(value);
    }
    const R actual = function(a, b);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what)) << register_of(a) << "* " << register_of(b);
  }
}

TEST_F(IntrinsicsInteger, ProductsOfHalves) {
  using I = std::int64_t;
  const auto odd = [](I, I al, I, I bl) { return al * bl; };
  const auto even = [](I ah, I, I bh, I) { return ah * bh; };
  check_product<vec_int4, vec_short8>("spu_mulo", SC_CALL(spu_mulo), odd);
  check_product<vec_uint4, vec_ushort8>("spu_mulo", SC_CALL(spu_mulo), odd);
  check_product<vec_int4, vec_short8>("spu_mule", SC_CALL(spu_mule), even);
  check_product<vec_uint4, vec_ushort8>("spu_mule", SC_CALL(spu_mule), even);
  check_product<vec_int4, vec_short8>("spu_mulh", SC_CALL(spu_mulh),
                                      [](I ah, I, I, I bl) { return (ah * bl) * 65536; });
  check_product<vec_int4, vec_short8>("spu_mulsr", SC_CALL(spu_mulsr),
                                      [](I, I al, I, I bl) { return (al * bl) >> 16; });
}

TEST_F(IntrinsicsInteger, ProductsWithAScalarAndWithASum) {
  Operands operands(21);
  for (int round = 0; round < kRounds; ++round) {
    const vec_short8 a = operands.vector<vec_short8>(), b = operands.vector<vec_short8>();
    const vec_ushort8 ua(a), ub(b);
    const vec_int4 c = operands.vector<vec_int4>();
    const short s = operands.lane<short>();
    const auto us = static_cast<unsigned short>(s);
    LanesOf<vec_int4> product, odd, even;
    LanesOf<vec_uint4> unsigned_product, unsigned_even;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t low = lanes(a)[2 * i + 1], high = lanes(a)[2 * i];
      product[i] = static_cast<int>(low * s);
      unsigned_product[i] = static_cast<unsigned int>(std::uint32_t{lanes(ua)[2 * i + 1]} * us);
      odd[i] = static_cast<int>(low * lanes(b)[2 * i + 1] + lanes(c)[i]);
      even[i] = static_cast<int>(high * lanes(b)[2 * i] + lanes(c)[i]);
      unsigned_even[i] =
          std::uint32_t{lanes(ua)[2 * i]} * lanes(ub)[2 * i] + static_cast<std::uint32_t>(lanes(c)[i]);
    }
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_mulo(a, s), product, "spu_mulo"));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_mulo(ua, us), unsigned_product, "spu_mulo"));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_madd(a, b, c), odd, "spu_madd"));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_mhhadd(a, b, c), even, "spu_mhhadd"));
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_mhhadd(ua, ub, vec_uint4(c)), unsigned_even, "spu_mhhadd"));
    // What the parts are for. [SPU-ISA]
    const vec_int4 whole = spu_add(spu_add(spu_mulh(a, b), spu_mulh(b, a)), vec_int4(spu_mulo(ua, ub)));
    LanesOf<vec_uint4> expected;
    for (int i = 0; i < 4; ++i)
      expected[static_cast<std::size_t>(i)] = register_of(a).w(i) * register_of(b).w(i);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(vec_uint4(whole), expected, "a product of words"));
  }
}

TEST_F(IntrinsicsInteger, Bytes) {
  check2<vec_uchar16, vec_uchar16, vec_uchar16>("spu_absd", SC_CALL(spu_absd),
                                                [](int a, int b) { return a > b ? a - b : b - a; });
  check2<vec_uchar16, vec_uchar16, vec_uchar16>("spu_avg", SC_CALL(spu_avg),
                                                [](int a, int b) { return (a + b + 1) >> 1; });
  Operands operands(22);
  for (int round = 0; round < kRounds; ++round) {
    const vec_uchar16 a = operands.vector<vec_uchar16>(), b = operands.vector<vec_uchar16>();
    LanesOf<vec_ushort8> expected{};
    for (std::size_t i = 0; i < 16; ++i) {
      expected[i / 4 * 2] = static_cast<unsigned short>(expected[i / 4 * 2] + lanes(b)[i]);
      expected[i / 4 * 2 + 1] = static_cast<unsigned short>(expected[i / 4 * 2 + 1] + lanes(a)[i]);
    }
    ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_sumb(a, b), expected, "spu_sumb"));
  }
}

int ones(std::uint32_t bits) {
  int count = 0;
  for (; bits != 0; bits &= bits - 1) ++count;
  return count;
}
int leading_zeros(std::uint32_t bits) {
  int count = 32;
  for (; bits != 0; bits >>= 1) --count;
  return count;
}

TEST_F(IntrinsicsInteger, CountsOfBits) {
  for_each(Types<vec_uchar16, vec_char16>{}, []<class V>() {
    check1<vec_uchar16, V>("spu_cntb", SC_CALL(spu_cntb), [](auto x) { return ones(bits_of(x)); });
  });
  for_each(Types<vec_uint4, vec_int4, vec_float4>{}, []<class V>() {
    check1<vec_uint4, V>("spu_cntlz", SC_CALL(spu_cntlz), [](auto x) { return leading_zeros(bits_of(x)); });
  });
  for (std::uint32_t i = 0; i < 32; ++i) {
    EXPECT_EQ(spu_extract(spu_cntlz(spu_splats(1u << i)), 0), 31 - i);
    EXPECT_EQ(spu_extract(spu_cntlz(spu_splats(0xFFFFFFFFu >> i)), 0), i);
  }
}

/// Lane i is the odd lane of the narrower type.
template <class R, class A>
void check_extend() {
  Operands operands(23);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = lanes(a)[2 * i + 1];
    ASSERT_NO_FATAL_FAILURE(expect_lanes(R(spu_extend(a)), expected, "spu_extend"));
  }
}

TEST_F(IntrinsicsInteger, ExtendReadsTheLowHalf) {
  check_extend<vec_short8, vec_char16>();
  check_extend<vec_int4, vec_short8>();
  check_extend<vec_llong2, vec_int4>();
}

// ---- shifts

template <class T>
constexpr int kBits = 8 * sizeof(T);

template <class T>
T left(T x, unsigned int n) {
  return n >= kBits<T> ? T{0} : static_cast<T>(static_cast<std::uint64_t>(x) << n);
}
template <class T>
T right(T x, unsigned int n) {
  const std::uint64_t bits = bits_of(x);
  return n >= kBits<T> ? T{0} : static_cast<T>(bits >> n);
}
template <class T>
T right_signed(T x, unsigned int n) {
  const auto value = std::int64_t{static_cast<std::make_signed_t<T>>(x)};
  return static_cast<T>(value >> (n >= kBits<T> ? kBits<T> - 1 : n));
}
template <class T>
T around(T x, unsigned int n) {
  const std::uint64_t bits = bits_of(x);
  n %= kBits<T>;
  return static_cast<T>(bits << n | bits >> (kBits<T> - n));
}
/// Counts as the instructions read them: one bit more than the lane's own.
template <class T>
unsigned int wide(std::int64_t count) {
  return static_cast<unsigned int>(count) & (2 * kBits<T> - 1);
}

TEST_F(IntrinsicsInteger, ShiftsByACountInEachLane) {
  for_each(HalfAndWordVectors{}, []<class V>() {
    using T = typename V::Lane;
    using U = UnsignedVector<T>;
    using S = SignedVector<T>;
    check2<V, V, U>("spu_sl", SC_CALL(spu_sl), [](T x, std::int64_t n) { return left(x, wide<T>(n)); });
    check2<V, V, U>("spu_sr", SC_CALL(spu_sr), [](T x, std::int64_t n) { return right(x, wide<T>(n)); });
    check2<V, V, U>("spu_sra", SC_CALL(spu_sra),
                    [](T x, std::int64_t n) { return right_signed(x, wide<T>(n)); });
    check2<V, V, S>("spu_rlmask", SC_CALL(spu_rlmask),
                    [](T x, std::int64_t n) { return right(x, wide<T>(-n)); });
    check2<V, V, S>("spu_rlmaska", SC_CALL(spu_rlmaska),
                    [](T x, std::int64_t n) { return right_signed(x, wide<T>(-n)); });
    check2<V, V, S>("spu_rl", SC_CALL(spu_rl),
                    [](T x, std::int64_t n) { return around(x, static_cast<unsigned int>(n)); });
  });
}

TEST_F(IntrinsicsInteger, ShiftsByOneScalar) {
  for_each(HalfAndWordVectors{}, []<class V>() {
    using T = typename V::Lane;
    using U = unsigned int;
    check_scalar<V, V, U>("spu_sl", SC_CALL(spu_sl), [](T x, U n) { return left(x, wide<T>(n)); });
    check_scalar<V, V, U>("spu_sr", SC_CALL(spu_sr), [](T x, U n) { return right(x, wide<T>(n)); });
    check_scalar<V, V, U>("spu_sra", SC_CALL(spu_sra), [](T x, U n) { return right_signed(x, wide<T>(n)); });
    check_scalar<V, V, int>("spu_rlmask", SC_CALL(spu_rlmask),
                            [](T x, std::int64_t n) { return right(x, wide<T>(-n)); });
    check_scalar<V, V, int>("spu_rlmaska", SC_CALL(spu_rlmaska),
                            [](T x, std::int64_t n) { return right_signed(x, wide<T>(-n)); });
    check_scalar<V, V, int>("spu_rl", SC_CALL(spu_rl),
                            [](T x, int n) { return around(x, static_cast<U>(n)); });
  });
}

}  // namespace
}  // namespace softcell::test
