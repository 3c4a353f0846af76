// Scalars in lanes, bits, masks, compares of integers.
#include "intrinsics_support.h"

namespace softcell::test {
namespace {

class IntrinsicsLogic : public SpuArithmetic {};

TEST_F(IntrinsicsLogic, SplatsFillEveryLane) {
  for_each(AllVectors{}, []<class V>() {
    Operands operands(10);
    for (int round = 0; round < kRounds; ++round) {
      const auto value = operands.lane<typename V::Lane>();
      LanesOf<V> expected;
      expected.fill(value);
      static_assert(std::is_same_v<decltype(spu_splats(value)), V>);
      ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_splats(value), expected, "spu_splats"));
    }
  });
}

TEST_F(IntrinsicsLogic, SplatsOfStandardIntegersAreTheLanesOfTheirWidth) {
  static_assert(std::is_same_v<decltype(spu_splats(std::uint64_t{1})), vec_ullong2>);
  static_assert(std::is_same_v<decltype(spu_splats(std::int64_t{1})), vec_llong2>);
  static_assert(std::is_same_v<decltype(spu_splats(std::uint32_t{1})), vec_uint4>);
  static_assert(std::is_same_v<decltype(spu_splats(std::int16_t{1})), vec_short8>);
  static_assert(std::is_same_v<decltype(spu_splats(std::uint8_t{1})), vec_uchar16>);
  expect_lanes(spu_splats(std::uint64_t{5}), {5, 5}, "spu_splats");
}

TEST_F(IntrinsicsLogic, ExtractInsertAndPromoteCountElementsModuloTheLanes) {
  for_each(AllVectors{}, []<class V>() {
    Operands operands(11);
    for (int round = 0; round < kRounds; ++round) {
      const V a = operands.vector<V>();
      const auto value = operands.lane<typename V::Lane>();
      const int element = operands.count(-3 * kLanes<V>, 3 * kLanes<V>);
      const auto place = static_cast<std::size_t>(element + 3 * kLanes<V>) % kLanes<V>;
      ASSERT_EQ(bits_of(spu_extract(a, element)), bits_of(lanes(a)[place]));
      auto expected = lanes(a);
      expected[place] = value;
      ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_insert(value, a, element), expected, "spu_insert"));
      ASSERT_EQ(bits_of(lanes(V(spu_promote(value, element)))[place]), bits_of(value));
    }
  });
}

#define SC_CHECK_LOGIC(name, expression)                                              \
  for_each(AllVectors{}, []<class V>() {                                              \
    using T = typename V::Lane;                                                       \
    check2<V, V, V>(#name, SC_CALL(name), [](T va, T vb) {                            \
      const std::uint64_t a = bits_of(va), b = bits_of(vb);                           \
      return from_bits<T>(static_cast<typename BitsOf<sizeof(T)>::Type>(expression)); \
    });                                                                               \
  })

TEST_F(IntrinsicsLogic, LogicWorksOnTheBitsOfEveryType) {
  SC_CHECK_LOGIC(spu_and, a & b);
  SC_CHECK_LOGIC(spu_andc, a & ~b);
  SC_CHECK_LOGIC(spu_or, a | b);
  SC_CHECK_LOGIC(spu_orc, a | ~b);
  SC_CHECK_LOGIC(spu_xor, a ^ b);
  SC_CHECK_LOGIC(spu_nand, ~(a & b));
  SC_CHECK_LOGIC(spu_nor, ~(a | b));
  SC_CHECK_LOGIC(spu_eqv, ~(a ^ b));
}

TEST_F(IntrinsicsLogic, LogicTakesAScalarForEveryLane) {
  for_each(IntegerVectors{}, []<class V>() {
    using T = typename V::Lane;
    check_scalar<V, V, T>("spu_and", SC_CALL(spu_and), [](T a, T b) { return a & b; });
    check_scalar<V, V, T>("spu_or", SC_CALL(spu_or), [](T a, T b) { return a | b; });
    check_scalar<V, V, T>("spu_xor", SC_CALL(spu_xor), [](T a, T b) { return a ^ b; });
  });
}

TEST_F(IntrinsicsLogic, SelectTakesTheSecondWhereTheMaskHasOnes) {
  for_each(AllVectors{}, []<class V>() {
    using T = typename V::Lane;
    using Bits = typename BitsOf<sizeof(T)>::Type;
    check3<V, V, V, UnsignedVector<T>>("spu_sel", SC_CALL(spu_sel), [](T a, T b, auto mask) {
      Bits result = 0;
      for (std::size_t i = 0; i < 8 * sizeof(T); ++i) {
        const Bits bit = static_cast<Bits>(Bits{1} << i);
        result = static_cast<Bits>(result | ((mask & bit) != 0 ? bits_of(b) & bit : bits_of(a) & bit));
      }
      return from_bits<T>(result);
    });
  });
}

TEST_F(IntrinsicsLogic, OrAcrossLeavesTheUnionInWordZero) {
  for_each(WordVectors{}, []<class V>() {
    Operands operands(12);
    for (int round = 0; round < kRounds; ++round) {
      const V a = operands.vector<V>();
      const auto v = lanes(a);
      ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_orx(a), {v[0] | v[1] | v[2] | v[3], 0, 0, 0}, "spu_orx"));
    }
  });
}

TEST_F(IntrinsicsLogic, GatherCollectsTheLowestBitsLaneZeroFirst) {
  for_each(Types<vec_uchar16, vec_char16, vec_ushort8, vec_short8, vec_uint4, vec_int4, vec_float4>{},
           []<class V>() {
             Operands operands(13);
             for (int round = 0; round < kRounds; ++round) {
               const V a = operands.vector<V>();
               std::uint32_t gathered = 0;
               for (const auto lane : lanes(a))
                 gathered = gathered << 1 | static_cast<std::uint32_t>(bits_of(lane) & 1u);
               ASSERT_NO_FATAL_FAILURE(expect_lanes(spu_gather(a), {gathered, 0, 0, 0}, "spu_gather"));
             }
           });
}

template <class V, class S, class F>
void check_mask(const char* what, F function) {
  Operands operands(14);
  for (int round = 0; round < kRounds; ++round) {
    const auto scalar = operands.lane<S>();
    LanesOf<V> expected;
    for (int i = 0; i < kLanes<V>; ++i) {
      const bool set = (static_cast<std::int64_t>(scalar) >> (kLanes<V> - 1 - i) & 1) != 0;
      expected[static_cast<std::size_t>(i)] = static_cast<typename V::Lane>(set ? ~std::uint64_t{0} : 0);
    }
    const V actual = function(scalar);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what)) << "of " << +scalar;
  }
}

TEST_F(IntrinsicsLogic, MasksSpreadTheBitsOfAScalarLaneZeroFirst) {
  for_each(Types<vec_ushort8, vec_short8, vec_uint4, vec_int4>{},
           []<class V>() { check_mask<vec_uchar16, typename V::Lane>("spu_maskb", SC_CALL(spu_maskb)); });
  for_each(IntegerVectors{}, []<class V>() {
    check_mask<vec_ushort8, typename V::Lane>("spu_maskh", SC_CALL(spu_maskh));
    check_mask<vec_uint4, typename V::Lane>("spu_maskw", SC_CALL(spu_maskw));
  });
}

TEST_F(IntrinsicsLogic, ComparesOfIntegersMakeMasksBySignedness) {
  for_each(IntegerVectors{}, []<class V>() {
    using T = typename V::Lane;
    using R = UnsignedVector<T>;
    const auto equal = [](T a, T b) { return a == b ? -1 : 0; };
    const auto greater = [](T a, T b) { return a > b ? -1 : 0; };
    check2<R, V, V>("spu_cmpeq", SC_CALL(spu_cmpeq), equal);
    check2<R, V, V>("spu_cmpgt", SC_CALL(spu_cmpgt), greater);
    check_scalar<R, V, T>("spu_cmpeq", SC_CALL(spu_cmpeq), equal);
    check_scalar<R, V, T>("spu_cmpgt", SC_CALL(spu_cmpgt), greater);
  });
}

}  // namespace
}  // namespace softcell::test
