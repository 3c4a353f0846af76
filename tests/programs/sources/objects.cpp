// A program in C++ with objects on the heap, virtual destructors, static variables of functions, and C's headers in namespace std.
#include "check.h"

#include <spu_intrinsics.h>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cfloat>
#include <cinttypes>
#include <climits>
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <initializer_list>
#include <new>

namespace {

int alive;

struct Shape {
  Shape() { ++alive; }
  Shape(const Shape&) = delete;
  virtual ~Shape() { --alive; }
  virtual float area() const = 0;
};
struct Square : Shape {
  explicit Square(float length) : side(length) {}
  float area() const override { return side * side; }
  float side;
};
struct alignas(128) Line {
  unsigned char bytes[128];
};

void objects_are_on_the_heap_of_the_local_store() {
  Shape* volatile shape = new Square(3);
  CHECK(alive == 1 && shape->area() == 9);
  delete shape;
  CHECK(alive == 0);
  int* volatile numbers = new int[100]();
  CHECK(numbers[99] == 0);
  CHECK(((reinterpret_cast<std::uintptr_t>(numbers) ^ reinterpret_cast<std::uintptr_t>(&alive)) &
         ~0x3FFFFu) == 0);
  delete[] numbers;
  Line* volatile line = new Line;
  CHECK(reinterpret_cast<std::uintptr_t>(line) % 128 == 0);
  delete line;
  Square* volatile squares = new Square[3]{Square(1), Square(2), Square(3)};
  CHECK(alive == 3 && squares[2].area() == 9);
  delete[] squares;
  CHECK(alive == 0);
  // Blocks that are given back can be had again.
  for (int round = 0; round < 1000; ++round) {
    char* volatile block = new char[10000];
    delete[] block;
  }
  volatile std::size_t too_many = 0x40000;
  CHECK(new (std::nothrow) char[too_many] == nullptr);
  CHECK(new (std::align_val_t(256), std::nothrow) char[too_many] == nullptr);
  alignas(Square) unsigned char place[sizeof(Square)];
  auto* const placed = new (place) Square(2);
  CHECK(static_cast<void*>(placed) == place && std::launder(placed)->area() == 4);
  placed->~Square();
  CHECK(alive == 0);
}

int made;
struct Table {
  explicit Table(int first) : value(first) { ++made; }
  int value;
};
int value_of_the_table(int first) {
  static Table table(first);
  return table.value++;
}

void static_variables_are_made_once() {
  CHECK(made == 0);
  volatile int first = 5;
  CHECK(value_of_the_table(first) == 5 && value_of_the_table(7) == 6 && value_of_the_table(8) == 7);
  CHECK(made == 1);
}

int sum(std::initializer_list<int> numbers) {
  int all = 0;
  for (const int number : numbers) all += number;
  return all;
}

template <class One, class Two>
constexpr bool kSame = false;
template <class One>
constexpr bool kSame<One, One> = true;

int of_arguments(int count, ...) {
  std::va_list arguments;
  va_start(arguments, count);
  int all = 0;
  for (int i = 0; i < count; ++i) all += va_arg(arguments, int);
  va_end(arguments);
  return all;
}

void headers_of_c_are_in_std() {
  char text[40];
  CHECK(std::snprintf(text, sizeof text, "%d %" PRIu32, 7, std::uint32_t{8}) == 3);
  CHECK(std::strcmp(text, "7 8") == 0 && std::strlen(text) == 3 && std::isdigit(text[0]));
  CHECK(std::strtol("12", nullptr, 10) == 12 && std::abs(-3l) == 3 && std::div(7, 2).rem == 1);
  volatile float two = 2;
  volatile double three = 3;
  static_assert(kSame<decltype(std::sqrt(1.0f)), float> && kSame<decltype(std::sqrt(1)), double>);
  static_assert(kSame<decltype(std::pow(1.0f, 1.0f)), float> && kSame<decltype(std::pow(1.0f, 2)), double>);
  static_assert(kSame<decltype(std::abs(1.0f)), float> && kSame<decltype(std::fabs(1.0f)), float>);
  CHECK(std::sqrt(two) == sqrtf(2) && std::sqrt(three) == sqrt(3.0) && std::sqrt(4) == 2);
  CHECK(std::fmax(two, 3.0f) == 3 && std::abs(-two) == 2 && std::floor(2.5f) == 2 &&
        std::lround(std::pow(two, 3)) == 8);
  int exponent = 0;
  CHECK(std::ldexp(two, 3) == 16 && std::frexp(two, &exponent) == 0.5f && exponent == 2 &&
        std::lround(2.5f) == 3);
  int quotient;
  static_assert(kSame<decltype(std::erf(1.0f)), float> && kSame<decltype(std::tgamma(1)), double>);
  CHECK(std::tgamma(5) == 24 && std::erf(0.0f) == 0 && std::remquo(7.0f, 2.0f, &quotient) == -1 &&
        quotient == 4);
  CHECK(std::isgreater(three, two) && isless(two, 3) && !std::isunordered(two, three));
  CHECK(!std::isnan(two) && isfinite(three) && std::signbit(-two) && std::fpclassify(two) == FP_NORMAL &&
        std::isfinite(4));
  CHECK(std::fma(two, three, 1.0f) == 7 && std::fma(2.0, 3.0, 1.0) == 7 && std::nextafter(two, 9.0f) > two);
  errno = 0;
  std::strtod("1e999", nullptr);
  CHECK(errno == ERANGE && INT_MAX == 0x7FFFFFFF && FLT_MAX > 1e38f);
  std::byte byte{0x0F};
  byte = (byte << 4) | std::byte{1};
  CHECK(std::to_integer<int>(byte) == 0xF1);
  CHECK(sum({1, 2, 3}) == 6 && of_arguments(3, 4, 5, 6) == 15);
  std::tm day{};
  day.tm_year = 70;
  day.tm_mday = 2;
  CHECK(std::mktime(&day) == std::time_t{86400});
  std::jmp_buf place;
  if (setjmp(place) == 0) std::longjmp(place, 1);
  assert(failures == 0);
}

void vectors_are_true_lane_by_lane() {
  const vec_int4 a = {0, 1, -1, 0}, b = {0, 0, 2, 3};
  const vec_float4 c = {0.0f, -0.0f, 1.0f, 1e-30f};
  const auto lanes = [](vec_int4 mask) { return spu_extract(spu_gather(mask), 0); };
  CHECK(lanes(!a) == 0b1001 && lanes(!c) == 0b1100 && lanes(!!b) == 0b0011);
  CHECK(lanes(a && b) == 0b0010 && lanes(a || b) == 0b0111 && lanes(a && c) == 0b0010);
}

}  // namespace

int main() {
  vectors_are_true_lane_by_lane();
  objects_are_on_the_heap_of_the_local_store();
  static_variables_are_made_once();
  headers_of_c_are_in_std();
  return failures;
}
