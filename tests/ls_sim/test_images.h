#pragma once
// The test kernels by name; their checked images have that name and "_checked".

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "softcell/ls_sim/image.h"

#define SC_TEST_KERNELS(X)  \
  X(echo_arguments)         \
  X(remembers)              \
  X(stack_overflow_deep)    \
  X(read_effective_address) \
  X(outside_local_store)    \
  X(illegal_instruction)    \
  X(endless)                \
  X(bad_dma)                \
  X(no_wait)                \
  X(padded)                 \
  X(arithmetic)             \
  X(waits)                  \
  X(pings)                  \
  X(doubles)                \
  X(increments)             \
  X(locks)                  \
  X(queues)                 \
  X(meets)                  \
  X(mixes)                  \
  X(exits)                  \
  X(overwrites)             \
  X(gets_over)              \
  X(leaves_a_stall)         \
  X(sleeps)                 \
  X(marks_jobs)             \
  X(sees_mask)              \
  X(takes_turns)            \
  X(computes)               \
  X(lists_by_number)        \
  X(stress_0)               \
  X(stress_1)               \
  X(stress_2)               \
  X(stress_3)               \
  X(resides)                \
  X(breaks_down)            \
  X(changes_images)

extern "C" {
#define SC_DECLARE(name)                                                         \
  extern const std::byte softcell_image_##name[], softcell_image_##name##_end[]; \
  extern const std::byte softcell_image_##name##_checked[], softcell_image_##name##_checked_end[];
SC_TEST_KERNELS(SC_DECLARE)
#undef SC_DECLARE
}

inline std::span<const std::byte> test_elf(const std::string& wanted) {
#define SC_CHOOSE(name)                                                             \
  if (wanted == #name) return {softcell_image_##name, softcell_image_##name##_end}; \
  if (wanted == #name "_checked")                                                   \
    return {softcell_image_##name##_checked, softcell_image_##name##_checked_end};
  SC_TEST_KERNELS(SC_CHOOSE)
#undef SC_CHOOSE
  throw std::logic_error("no test kernel " + wanted);
}

inline softcell::ls_sim::KernelImage test_image(const std::string& name) {
  return softcell::ls_sim::load_image(name, test_elf(name));
}
