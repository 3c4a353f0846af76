// The parts of the C++ library that a local store has.
#include <spu_intrinsics.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "check.h"

namespace {

enum class Colour : unsigned short { kRed };
struct Base {
  virtual ~Base() = default;
};
struct Derived : Base {};

static_assert(std::is_same_v<std::remove_cv_t<const volatile int>, int> && !std::is_same<int, long>::value);
static_assert(std::is_same_v<std::remove_reference_t<int&&>, int> &&
              std::is_same_v<std::decay_t<const int (&)[3]>, const int*>);
static_assert(std::is_same_v<std::conditional_t<false, int, float>, float> &&
              std::is_same_v<std::enable_if_t<true, int>, int>);
static_assert(std::is_same_v<std::underlying_type_t<Colour>, unsigned short> &&
              std::is_same_v<std::make_unsigned_t<int>, unsigned int>);
static_assert(std::is_same_v<std::make_signed_t<unsigned char>, signed char> &&
              std::is_same_v<std::remove_pointer_t<int*>, int>);
static_assert(std::is_integral_v<unsigned long> && std::is_floating_point_v<float> &&
              !std::is_integral_v<float> && std::is_arithmetic_v<char>);
static_assert(std::is_signed_v<int> && std::is_unsigned_v<char> && !std::is_unsigned_v<float> &&
              std::is_enum_v<Colour>);
static_assert(std::is_pointer_v<int* const> && !std::is_pointer_v<int> && std::is_array_v<int[2]> &&
              std::is_const_v<const int>);
static_assert(std::is_base_of_v<Base, Derived> && std::is_polymorphic_v<Derived> && std::is_class_v<Base> &&
              std::is_pod_v<int>);
static_assert(std::is_reference_v<int&> && std::is_lvalue_reference_v<int&> &&
              std::is_rvalue_reference_v<int&&> && std::is_void_v<const void>);
static_assert(std::is_trivially_copyable_v<std::array<int, 3>> && std::true_type::value &&
              !std::false_type() && sizeof(std::array<float, 4>) == 16);

using Ints = std::numeric_limits<int>;
static_assert(Ints::max() == 0x7FFFFFFF && Ints::min() == -0x7FFFFFFF - 1 && Ints::digits == 31 &&
              Ints::digits10 == 9);
static_assert(std::numeric_limits<unsigned char>::max() == 255 &&
              std::numeric_limits<unsigned long long>::max() == ~0ull);
static_assert(std::numeric_limits<long long>::lowest() == -0x7FFFFFFFFFFFFFFFll - 1 &&
              std::numeric_limits<bool>::max());
static_assert(std::numeric_limits<float>::max() == FLT_MAX &&
              std::numeric_limits<float>::lowest() == -FLT_MAX && !std::numeric_limits<float>::has_infinity);
static_assert(std::numeric_limits<double>::epsilon() == DBL_EPSILON &&
              std::numeric_limits<double>::infinity() > DBL_MAX && std::numeric_limits<float>::digits == 24);
static_assert(std::min(3, 2) == 2 && std::max({1, 5, 3}) == 5 && std::clamp(7, 0, 5) == 5 &&
              std::min({2.0f, 1.5f}) == 1.5f);

void sequences() {
  int numbers[100], copy[100];
  unsigned int state = 1;
  std::iota(std::begin(numbers), std::end(numbers), -50);
  CHECK(std::accumulate(numbers, numbers + 100, 0) == -50 && std::size(numbers) == 100 &&
        std::distance(numbers, std::end(numbers)) == 100);
  for (int i = 99; i > 0; --i) {
    state = state * 1664525u + 1013904223u;
    std::swap(numbers[i], numbers[(state >> 8) % static_cast<unsigned int>(i + 1)]);
  }
  CHECK(numbers[0] != -50 || numbers[1] != -49);
  std::copy(numbers, numbers + 100, copy);
  CHECK(std::equal(numbers, numbers + 100, copy) && *std::min_element(copy, copy + 100) == -50 &&
        *std::max_element(copy, copy + 100) == 49);
  std::sort(copy, copy + 100);
  for (int i = 0; i < 100; ++i) CHECK(copy[i] == i - 50);
  CHECK(*std::lower_bound(copy, copy + 100, 7) == 7 && *std::upper_bound(copy, copy + 100, 7) == 8 &&
        std::binary_search(copy, copy + 100, 3));
  CHECK(!std::binary_search(copy, copy + 100, 60) && std::lower_bound(copy, copy + 100, 60) == copy + 100);
  std::sort(copy, copy + 100, [](int one, int other) { return one > other; });
  CHECK(copy[0] == 49 && copy[99] == -50);
  std::reverse(copy, copy + 100);
  CHECK(copy[0] == -50 && copy[99] == 49 && std::find(copy, copy + 100, 0) == copy + 50 &&
        std::count(copy, copy + 100, 5) == 1);
  CHECK(std::count_if(copy, copy + 100, [](int n) { return n < 0; }) == 50 &&
        *std::find_if(copy, copy + 100, [](int n) { return n > 10; }) == 11);
  CHECK(std::all_of(copy, copy + 100, [](int n) { return n < 50; }) &&
        std::any_of(copy, copy + 100, [](int n) { return n == 0; }));
  CHECK(std::none_of(copy, copy + 100, [](int n) { return n > 49; }));
  std::stable_sort(copy, copy + 100, [](int one, int other) { return one / 10 < other / 10; });
  for (int i = 0; i < 100; ++i) CHECK(copy[i] == i - 50);
  std::fill_n(copy, 50, 1);
  std::fill(copy + 50, copy + 100, 2);
  CHECK(std::unique(copy, copy + 100) == copy + 2 && copy[1] == 2 &&
        std::remove(copy, copy + 2, 1) == copy + 1 && copy[0] == 2);
  std::transform(numbers, numbers + 100, copy, [](int n) { return -n; });
  std::transform(numbers, numbers + 100, copy, copy, [](int one, int other) { return one + other; });
  CHECK(std::accumulate(copy, copy + 100, 7, [](int one, int other) { return one | other; }) == 7 &&
        std::inner_product(copy, copy + 100, numbers, 3) == 3);
  std::copy_n(numbers, 10, copy);
  std::copy_backward(copy, copy + 10, copy + 12);
  CHECK(copy[11] == numbers[9] && copy[2] == numbers[0]);
  int sum = 0;
  std::for_each(copy, copy + 3, [&](int n) { sum += n; });
  CHECK(sum == copy[0] + copy[1] + copy[2] && *std::next(copy, 2) == copy[2] &&
        *std::prev(copy + 3) == copy[2]);
}

void wholes() {
  std::array<vec_float4, 3> vectors{};
  vectors.fill(spu_splats(2.0f));
  for (vec_float4& each : vectors) each = spu_mul(each, each);
  CHECK(vectors.size() == 3 && !vectors.empty() && spu_extract(vectors.back(), 3) == 4 &&
        vectors.data() == &vectors.front());
  std::array numbers{3, 1, 2};
  const auto before = numbers;
  std::sort(numbers.begin(), numbers.end());
  CHECK(numbers != before && numbers == (std::array<int, 3>{1, 2, 3}) && before[0] == 3);
  auto two = std::make_pair(5, 2.5f);
  const std::pair other{5, 3.5f};
  CHECK(two < other && two != other && std::exchange(two.second, 3.5f) == 2.5f && two == other);
  CHECK(std::move(two).first == 5 && std::forward<int>(7) == 7 && std::as_const(two).second == 3.5f);
}

}  // namespace

int main() {
  sequences();
  wholes();
  std::exit(failures);
}
