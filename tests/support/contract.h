#pragma once
// Tests of contracts: a violated SC_ASSERT ends the program and names itself.

#include <gtest/gtest.h>

/// Expects that the statement violates an assertion, whose line on standard error matches the regular
/// expression `line`. Skips the rest of the test, visibly, in a build without assertions.
#ifdef SOFTCELL_ASSERTIONS
#define SC_EXPECT_VIOLATES(statement, line) EXPECT_DEATH(statement, line)
#else
#define SC_EXPECT_VIOLATES(statement, line)             \
  if (false) { /* compiled, so that it stays correct */ \
    statement;                                          \
  } else                                                \
    GTEST_SKIP() << "this build has no assertions (SOFTCELL_ASSERTIONS is off): " << (line)
#endif
