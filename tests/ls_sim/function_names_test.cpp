#include "image/function_names.h"

#include <gtest/gtest.h>

namespace softcell::ls_sim {
namespace {

TEST(FunctionNames, OfCAreNotTakenForTypesOfCpp) {
  for (const char* name : {"f", "b", "i", "v", "main", "_start", ""}) EXPECT_EQ(demangled(name), name);
}

TEST(FunctionNames, OfCppAreShownAsTheyAreWritten) {
  EXPECT_EQ(demangled("_Z1fi"), "f(int)");
  EXPECT_EQ(demangled("_ZN6shapes4area"), "_ZN6shapes4area") << "not a whole name";
}

}  // namespace
}  // namespace softcell::ls_sim
