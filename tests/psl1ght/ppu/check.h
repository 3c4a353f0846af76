/* Ends the program with the line of what is wrong. */
#include <stdio.h>
#include <stdlib.h>
#define CHECK(condition)                                     \
  do {                                                       \
    if (!(condition)) {                                      \
      printf("%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      exit(1);                                               \
    }                                                        \
  } while (0)
#define EA(pointer) ((u64)(uintptr_t)(pointer))
