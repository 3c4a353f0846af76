/* What the programs of these tests check with: a failure prints its line, and main returns the number of failures. */
#include <stdio.h>

static int failures;
#define CHECK(condition) \
  ((condition) ? (void)0 : (++failures, (void)printf("%s:%d: %s\n", __FILE__, __LINE__, #condition)))
