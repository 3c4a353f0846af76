// Assertions that are off, whatever the build says.

#undef SOFTCELL_ASSERTIONS
#include "softcell/base/assert.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace softcell::base {
namespace {

int value_that_costs(int& evaluated) {
  ++evaluated;
  return 0;
}

bool condition_that_throws() { throw std::logic_error("evaluated"); }

TEST(AssertThatIsOff, EvaluatesNeitherConditionNorValues) {
  int evaluated = 0;
  SC_ASSERT(value_that_costs(evaluated) == 1, "{} is not 1", value_that_costs(evaluated));
  EXPECT_EQ(evaluated, 0);
  EXPECT_NO_THROW(SC_ASSERT(condition_that_throws(), "no values"));
}

// A constant expression cannot call what is no constant: nothing is left of the assertion.
constexpr int same(int value) {
  SC_ASSERT(value < 0, "{} is not below 0", value);
  return value;
}
static_assert(same(5) == 5);

}  // namespace
}  // namespace softcell::base
