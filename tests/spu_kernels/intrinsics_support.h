#pragma once
// What the tests of the host's intrinsics share: the SPU's arithmetic mode, vectors as arrays of lanes,
// registers as the sixteen big-endian bytes of an SPU register, and operands that are random or on an edge.

#include <gtest/gtest.h>
#include <spu_intrinsics.h>
#include <xmmintrin.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <ostream>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace softcell::test {

/// Truncation, denormal operands and results zero, exceptions masked: what a worker sets before it runs a
/// kernel.
constexpr unsigned int kSpuArithmetic = _MM_MASK_MASK | _MM_ROUND_TOWARD_ZERO | _MM_FLUSH_ZERO_ON | 0x0040;

/// Every test here runs in the SPU's mode.
class SpuArithmetic : public ::testing::Test {
 protected:
  void SetUp() override { _mm_setcsr(kSpuArithmetic); }
  void TearDown() override {
    EXPECT_EQ(_mm_getcsr() & ~_MM_EXCEPT_MASK, kSpuArithmetic)
        << "an intrinsic left another arithmetic mode behind";
    _mm_setcsr(host_);
  }

 private:
  const unsigned int host_ = _mm_getcsr();
};

template <class V>
constexpr int kLanes = 16 / sizeof(typename V::Lane);
template <class V>
using LanesOf = std::array<typename V::Lane, kLanes<V>>;

/// Lane 0 first, as in memory.
template <class V>
LanesOf<V> lanes(V v) {
  LanesOf<V> result;
  std::memcpy(result.data(), &v, sizeof v);
  return result;
}
template <class V>
V vector_of(const LanesOf<V>& values) {
  V result;
  std::memcpy(&result, values.data(), sizeof result);
  return result;
}

template <std::size_t Width>
struct BitsOf;
template <>
struct BitsOf<1> {
  using Type = std::uint8_t;
};
template <>
struct BitsOf<2> {
  using Type = std::uint16_t;
};
template <>
struct BitsOf<4> {
  using Type = std::uint32_t;
};
template <>
struct BitsOf<8> {
  using Type = std::uint64_t;
};
/// The bits of a lane.
template <class T>
typename BitsOf<sizeof(T)>::Type bits_of(T value) {
  typename BitsOf<sizeof(T)>::Type bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
template <class T>
T from_bits(typename BitsOf<sizeof(T)>::Type bits) {
  T value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// A register as the SPU sees it: byte 0 is the most significant one. [SPU-ISA] documented
struct Register {
  std::array<std::uint8_t, 16> byte{};

  template <class T>
  T get(int element) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value = value << 8 | byte[static_cast<std::size_t>(element) * sizeof(T) + i];
    return from_bits<T>(static_cast<typename BitsOf<sizeof(T)>::Type>(value));
  }
  template <class T>
  void set(int element, T value) {
    const std::uint64_t bits = bits_of(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      byte[static_cast<std::size_t>(element) * sizeof(T) + i] =
          static_cast<std::uint8_t>(bits >> (8 * (sizeof(T) - 1 - i)));
    }
  }
  std::uint32_t w(int i) const { return get<std::uint32_t>(i); }
  friend bool operator==(const Register&, const Register&) = default;
};
inline std::ostream& operator<<(std::ostream& out, const Register& r) {
  char text[3];
  for (int i = 0; i < 16; ++i) {
    std::snprintf(text, sizeof text, "%02x", r.byte[static_cast<std::size_t>(i)]);
    out << text << (i % 4 == 3 ? " " : "");
  }
  return out;
}

template <class V>
Register register_of(V v) {
  Register result;
  const auto values = lanes(v);
  for (int i = 0; i < kLanes<V>; ++i) result.set(i, values[static_cast<std::size_t>(i)]);
  return result;
}
inline Register register_of(qword q) { return register_of(vec_uint4(q)); }
template <class V>
V vector_of(const Register& r) {
  LanesOf<V> values;
  for (int i = 0; i < kLanes<V>; ++i) values[static_cast<std::size_t>(i)] = r.get<typename V::Lane>(i);
  return vector_of<V>(values);
}
inline qword qword_of(const Register& r) { return qword(vector_of<vec_uint4>(r)); }

/// Operands: half of the lanes are random bits, the others lie on an edge of their type or are small.
class Operands {
 public:
  explicit Operands(unsigned int seed) : random_(seed) {}

  std::uint64_t bits() { return random_(); }
  int count(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  template <class T>
  T lane() {
    using Bits = typename BitsOf<sizeof(T)>::Type;
    const auto any = static_cast<Bits>(random_());
    constexpr int kBits = 8 * sizeof(T);
    const Bits top = static_cast<Bits>(Bits{1} << (kBits - 1));
    switch (random_() % 12) {
      case 0:
        return from_bits<T>(0);
      case 1:
        return from_bits<T>(static_cast<Bits>(~Bits{0}));
      case 2:
        return from_bits<T>(top);
      case 3:
        return from_bits<T>(static_cast<Bits>(top - 1));
      case 4:
        return from_bits<T>(static_cast<Bits>(any % 67));
      case 5:
        return from_bits<T>(static_cast<Bits>(Bits{0} - static_cast<Bits>(any % 67)));
      default:
        return from_bits<T>(any);
    }
  }
  template <class V>
  V vector() {
    LanesOf<V> values;
    for (auto& value : values) value = lane<typename V::Lane>();
    return vector_of<V>(values);
  }
  Register reg() {
    // Edges of words, of halves or of bytes.
    switch (random_() % 3) {
      case 0:
        return register_of(vector<vec_uint4>());
      case 1:
        return register_of(vector<vec_ushort8>());
      default:
        return register_of(vector<vec_uchar16>());
    }
  }

 private:
  std::mt19937_64 random_;
};

constexpr int kRounds = 400;

/// Lanes by bits, so that NaNs and zeros of either sign count as what they are.
template <class V>
void expect_lanes(const V& actual, const LanesOf<V>& expected, const std::string& what) {
  const auto values = lanes(actual);
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(std::uint64_t{bits_of(values[i])}, std::uint64_t{bits_of(expected[i])})
        << std::hex << what << ", lane " << i << ": got 0x" << std::uint64_t{bits_of(values[i])}
        << ", expected 0x" << std::uint64_t{bits_of(expected[i])};
  }
}

/// result[i] = model(a[i], ...) for random operands.
template <class R, class A, class F, class M>
void check1(const char* what, F function, M model) {
  Operands operands(1);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = static_cast<typename R::Lane>(model(lanes(a)[i]));
    const R actual = function(a);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what)) << "a = " << register_of(a);
  }
}
template <class R, class A, class B, class F, class M>
void check2(const char* what, F function, M model) {
  Operands operands(2);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>();
    const B b = operands.vector<B>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expected[i] = static_cast<typename R::Lane>(model(lanes(a)[i], lanes(b)[i]));
    }
    const R actual = function(a, b);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what))
        << "a = " << register_of(a) << "b = " << register_of(b);
  }
}
template <class R, class A, class B, class C, class F, class M>
void check3(const char* what, F function, M model) {
  Operands operands(3);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>();
    const B b = operands.vector<B>();
    const C c = operands.vector<C>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expected[i] = static_cast<typename R::Lane>(model(lanes(a)[i], lanes(b)[i], lanes(c)[i]));
    }
    const R actual = function(a, b, c);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what))
        << "a = " << register_of(a) << "b = " << register_of(b) << "c = " << register_of(c);
  }
}
/// A vector and one scalar for all its lanes.
template <class R, class A, class S, class F, class M>
void check_scalar(const char* what, F function, M model) {
  Operands operands(4);
  for (int round = 0; round < kRounds; ++round) {
    const A a = operands.vector<A>();
    const S s = operands.lane<S>();
    LanesOf<R> expected;
    for (std::size_t i = 0; i < expected.size(); ++i)
      expected[i] = static_cast<typename R::Lane>(model(lanes(a)[i], s));
    const R actual = function(a, s);
    ASSERT_NO_FATAL_FAILURE(expect_lanes(actual, expected, what)) << "a = " << register_of(a) << "s = " << +s;
  }
}

/// The operation as a function, for the checks above.
#define SC_CALL(name) [](auto... operands) { return name(operands...); }

// Vector types of a lane type's width.
template <class T>
using UnsignedVector = softcell_sdk::Vector<softcell_sdk::Unsigned<T>>;
template <class T>
using SignedVector = softcell_sdk::Vector<softcell_sdk::Signed<T>>;

template <class... V>
struct Types {};
using AllVectors = Types<vec_uchar16, vec_char16, vec_ushort8, vec_short8, vec_uint4, vec_int4, vec_ullong2,
                         vec_llong2, vec_float4, vec_double2>;
using IntegerVectors = Types<vec_uchar16, vec_char16, vec_ushort8, vec_short8, vec_uint4, vec_int4>;
using HalfAndWordVectors = Types<vec_ushort8, vec_short8, vec_uint4, vec_int4>;
using WordVectors = Types<vec_uint4, vec_int4>;

/// Calls f.template operator()<V>() for each type; stops at the first failure.
template <class... V, class F>
void for_each(Types<V...>, F f) {
  const auto once = [&f]<class One>() {
    if (!::testing::Test::HasFatalFailure()) f.template operator()<One>();
  };
  (once.template operator()<V>(), ...);
}

}  // namespace softcell::test
