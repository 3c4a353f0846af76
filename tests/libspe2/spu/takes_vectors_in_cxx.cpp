// The same in C++, with a static constructor before main.
#include "takes_vectors.c"

struct Made {
  explicit Made(unsigned int v) : value(v) {}
  volatile unsigned int value;
};
Made made(7);
