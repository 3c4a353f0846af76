// Assertions that are alive, whatever the build says.

#ifndef SOFTCELL_ASSERTIONS
#define SOFTCELL_ASSERTIONS
#endif
#include "softcell/base/assert.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace softcell::base {
namespace {

enum class Colour { kRed = 3 };

struct Handle {
  unsigned value = 0;
};

constexpr int half_of(int even) {
  SC_ASSERT(even % 2 == 0, "{} is odd", even);
  return even / 2;
}
static_assert(half_of(4) == 2, "an assertion that holds is no obstacle to a constant");

TEST(AssertDeathTest, NamesItselfWhenItIsViolated) {
  EXPECT_EQ(half_of(6), 3);
  EXPECT_DEATH(
      half_of(7),
      "assert_test\\.cpp:[0-9]+: .*half_of\\(int\\): SC_ASSERT\\(even % 2 == 0\\) does not hold: 7 is odd\n");
}

TEST(AssertDeathTest, WritesValuesOfManyTypes) {
  const std::string name = "match";
  EXPECT_DEATH(SC_ASSERT(name.empty(), "{} {} {} {} {} {} {}.", name, "text", true, -5, 0.25, Colour::kRed,
                         std::filesystem::path("a/b")),
               "SC_ASSERT\\(name.empty\\(\\)\\) does not hold: match text true -5 0.25 3 a/b\\.\n");
  EXPECT_DEATH(SC_ASSERT(name.empty(), "{} {}", Handle{31}, static_cast<const void*>(nullptr)),
               "does not hold: 0x1f 0x0\n");
  EXPECT_DEATH(SC_ASSERT(false, "no values"), "SC_ASSERT\\(false\\) does not hold: no values\n");
}

TEST(Assert, DoesNothingWhenItHolds) {
  int evaluated = 0;
  SC_ASSERT(++evaluated == 1, "evaluated {} times", evaluated);
  EXPECT_EQ(evaluated, 1);
}

}  // namespace
}  // namespace softcell::base
