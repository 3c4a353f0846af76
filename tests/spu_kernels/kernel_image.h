#pragma once
// The project's kernels by name, for tests. With SOFTCELL_TEST_ENGINE=interpreter in the environment they are those built for the SPU.

#include <cstdlib>
#include <string>

#include "softcell/ls_sim/image.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::test {

inline ls_sim::Machine machine_of_tests() {
  const char* const engine = std::getenv("SOFTCELL_TEST_ENGINE");
  return engine != nullptr && std::string(engine) == "interpreter" ? ls_sim::Machine::kSpu
                                                                   : ls_sim::Machine::kHost;
}

inline ls_sim::KernelImage kernel_image(const std::string& name, bool checked = false,
                                        ls_sim::Machine machine = machine_of_tests()) {
  return spu_kernels::load_kernel(name, checked, machine);
}

}  // namespace softcell::test
