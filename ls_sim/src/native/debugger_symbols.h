#pragma once
// Lets gdb see the kernels: their symbols and source lines at the addresses where they run.
//
// gdb's interface for just-in-time compilers takes an ELF file in memory, whose addresses must be the real
// ones. A kernel's file is linked at local-store address 0; the link keeps the relocations of its debug
// information (ld -q), so that a copy can be moved to where the local store is.  [gdb manual, JIT Compilation
// Interface]

#include <cstddef>
#include <memory>
#include <vector>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim::native {

/// True when somebody debugs this process, or means to attach later: a tracer is there, or the environment
/// has SOFTCELL_GDB. Looks at /proc: not for every job.
bool debugger_wanted();

/// The image's file with all its addresses moved up by `base`; empty when it has no debug information, or
/// lost the relocations that moving it takes.
/// @throws std::runtime_error  one sentence, when the file is damaged.
std::vector<std::byte> relocate_debug_file(const KernelImage& image, std::uint32_t base);

/// While it lives, gdb knows the image at `base`. Any thread.
class DebuggerSymbols {
 public:
  DebuggerSymbols(const KernelImage& image, const std::byte* base);
  ~DebuggerSymbols();
  DebuggerSymbols(const DebuggerSymbols&) = delete;
  DebuggerSymbols& operator=(const DebuggerSymbols&) = delete;

 private:
  struct Entry;
  std::unique_ptr<Entry> entry_;  ///< null when there is nothing to show, or the file is damaged
};

}  // namespace softcell::ls_sim::native
