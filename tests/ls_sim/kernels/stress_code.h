#pragma once
// Code for the stress test of image changes: long runs of arithmetic, a different one for each seed, so that
// instructions of two images never agree for long at the same addresses. Compiled into kernels, and into the
// test, which knows by it what must come out.

#include <stdint.h>

namespace stress {

constexpr uint32_t kImages = 4;  // seeds 0, 1, 2, 3
constexpr uint32_t kInputs = 16;
constexpr uint32_t kSteps = 700;

constexpr uint32_t mixed(uint32_t x) {
  x = (x ^ x >> 16) * 0x7FEB352Du;
  x = (x ^ x >> 15) * 0x846CA68Bu;
  return x ^ x >> 16;
}

/// One step of a few instructions, whose kinds and constants come from the seed.
template <uint32_t kSeed, uint32_t kStep>
__attribute__((always_inline)) inline uint32_t step(uint32_t x) {
  constexpr uint32_t kConstant = mixed(kSeed * 0x10001u + kStep * 8u + 1u);
  constexpr uint32_t kTurn = kConstant % 31u + 1u;
  if constexpr (kConstant >> 30 == 0) {
    return x * (kConstant | 1u) + kTurn;
  } else if constexpr (kConstant >> 30 == 1) {
    return (x << kTurn | x >> (32u - kTurn)) ^ kConstant;
  } else if constexpr (kConstant >> 30 == 2) {
    return x - (kConstant ^ x >> kTurn);
  } else {
    return (x & 1u << kTurn) != 0 ? x + kConstant : ~x;
  }
}

/// All steps, ten to an instance: the compiler's time grows with the square of the depth.
template <uint32_t kSeed, uint32_t kStep = 0>
__attribute__((always_inline)) inline uint32_t run(uint32_t x) {
  static_assert(kSteps % 10 == 0);
  if constexpr (kStep < kSteps) {
    x = step<kSeed, kStep + 4>(
        step<kSeed, kStep + 3>(step<kSeed, kStep + 2>(step<kSeed, kStep + 1>(step<kSeed, kStep>(x)))));
    x = step<kSeed, kStep + 9>(
        step<kSeed, kStep + 8>(step<kSeed, kStep + 7>(step<kSeed, kStep + 6>(step<kSeed, kStep + 5>(x)))));
    return run<kSeed, kStep + 10>(x);
  } else {
    return x;
  }
}

/// How the bytes of an image come to where they are executed.
enum class Way : uint32_t {
  kGets,            ///< the SPE's own gets
  kList,            ///< one list command of its own
  kPutsOfNeighbour  ///< puts of another SPE, which fetches them first; SPEs work in pairs
};

/// What one SPE is asked to do, in main storage at argp.
struct alignas(128) Task {
  uint32_t way;  ///< a Way
  uint32_t rounds;
  uint32_t seed;          ///< of the order of images and inputs
  uint32_t syncs;         ///< 0: the kernel leaves out the sync
  uint64_t neighbour;     ///< the local store of the other SPE of the pair
  uint32_t fetches_only;  ///< 1: of a pair, the one that puts
  uint32_t image_bytes[kImages];
  uint32_t entry[kImages];  ///< local-store addresses
  uint32_t padding;
  uint64_t image_ea[kImages];
  uint32_t padding_2[2];
};
static_assert(sizeof(Task) == 128, "one line");

/// What must come out, behind the task in main storage.
struct alignas(128) Expected {
  uint32_t of[kImages][kInputs];
};
static_assert(sizeof(Expected) == 256, "two lines");

/// What came out, in main storage at envp: the first that was wrong, or rounds == Task::rounds.
struct alignas(128) Outcome {
  uint32_t rounds, image, input, result;
  uint32_t padding[28];
};

}  // namespace stress
