// One of the images of the stress test of image changes.
#include "stress_code.h"

int main(uint64_t, uint64_t argp, uint64_t) {
  return static_cast<int>(stress::run<3>(static_cast<uint32_t>(argp)));
}
