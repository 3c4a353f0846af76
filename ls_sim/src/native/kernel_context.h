#pragma once
// The state that the three stacks of a native run share: the worker's own, the kernel's (in local store), and
// the landing stack on which a kernel that faulted is left.
//
//   kernel   main() ... gate() --call--> worker's stack: serve(), as a function of run() --return--> gate()
//                       gate() --jump--> run(), when serve() says that the run is at its end
//   on a fault: the signal handler (on the signal stack) rewrites the interrupted context to land() on the
//   landing stack, which jumps to run(); the kernel's frames are abandoned where they are.
//
// Only code without sanitizer instrumentation runs on the kernel's and the landing stack (kernel_side.cpp,
// serialise.cpp), so that sanitizers see one stack per thread.

#include <boost/context/detail/fcontext.hpp>
#include <csignal>
#include <cstdint>

namespace softcell::ls_sim {
class Debugger;
}

namespace softcell::ls_sim::native {

/// First quadwords of the local store, as spu_kernels/sdk/host/softcell_environment.h declares them. tests/ls_sim/kernel_contract.cpp
/// compares the two.
struct Environment {
  std::uint64_t gate = 0;
  std::uint32_t mfc_lsa = 0, mfc_eah = 0, mfc_eal = 0, mfc_size = 0, mfc_tag = 0, mfc_tag_mask = 0;
  std::uint32_t access_bytes = 0, access_instruction = 0, access_stack_pointer = 0;
  std::uint32_t padding = 0;
  std::uint64_t job_image_ea = 0, job_ea = 0;
  std::uint32_t assist = 0;
  std::uint32_t reserved[15] = {};
};
static_assert(sizeof(Environment) == 128);

/// What the kernel asks of the worker. Only land() sets kFault, never a kernel.
enum class Operation : std::uint32_t {
  kRead = 0,
  kWrite = 1,
  kCount = 2,
  kStop = 3,
  kHalt = 4,
  kTagStatus = 5,
  kAccess = 6,
  kJob = 7,
  kSync = 8,
  kAssist = 9,
  kFault = 0xFF'FFFF
};

/// What Operation::kAccess reports, by the numbers of spu_kernels/sdk/checked/report.h.
enum class Told : std::uint32_t {
  kLoad = 0,
  kStore = 1,
  kHeapBlock = 2,
  kFreedBlock = 3,
  kLoadElsewhere = 4,
  kStoreElsewhere = 5
};

constexpr std::uint32_t request_of(Operation operation, std::uint32_t channel = 0) {
  return static_cast<std::uint32_t>(operation) << 8 | channel;
}

/// How the processor stopped the kernel.
struct Trap {
  int signal = 0;
  bool general_protection = false;  ///< the processor gave no address: it was not that of an aligned vector
  bool instruction_fetch = false;
  bool write = false;
  /// Executed once more, the instruction did not fail: the processor had executed stale bytes.
  bool stale = false;
  std::uintptr_t address = 0;
  std::uintptr_t instruction = 0;
  std::uintptr_t stack = 0;
};

struct KernelContext;

/// Answers the request in the context. @return  whether the kernel goes on; otherwise its run has ended.
using ServeRequest = bool(KernelContext* context) noexcept;

struct KernelContext {
  /// Where run() waits; its value is the worker's stack pointer.
  boost::context::detail::fcontext_t worker = nullptr;
  unsigned int worker_arithmetic = 0;  ///< MXCSR
  ServeRequest* serve = nullptr;
  void* engine = nullptr;  ///< for serve()

  // The request of the kernel and the worker's answer.
  /// An Operation, and below it in 8 bits a channel: one word, which can be read as it was stored.
  std::uint32_t request = request_of(Operation::kStop);
  std::uint32_t value = 0;
  std::uint32_t reply = 0;
  std::uintptr_t caller = 0;         ///< in the kernel's call of the gate: its last byte
  std::uintptr_t stack_pointer = 0;  ///< the kernel's, in the gate
  Trap trap;

  // What main is called with.
  std::uintptr_t entry = 0;
  std::uint64_t arguments[4] = {};
  alignas(16) std::uint32_t vectors[3][4] = {};  ///< the first three, for a main that takes vectors

  Operation operation() const { return static_cast<Operation>(request >> 8); }
  std::uint32_t channel() const { return request & 0xFFu; }

  // For the signal handler.
  std::uintptr_t arena = 0;
  std::uintptr_t landing_stack_top = 0;
  volatile std::sig_atomic_t in_kernel = 0;
  volatile std::sig_atomic_t interrupted = 0;
  /// The kernel has been left, and run_kernel() not yet come back to.
  volatile std::sig_atomic_t landing = 0;
  volatile std::sig_atomic_t stepping = 0;  ///< the instruction that failed is being executed once more
  bool repeat_what_failed = true;           ///< false under a debugger, which steps through kernels itself
  Debugger* stepper = nullptr;              ///< sees each instruction; null: nobody does
  int spe = 0;
};

/// With a stepper: from now on a SIGTRAP follows each instruction of this thread, or, if not `on`, none.
/// [AMD64 manual, volume 2, single-step trap] documented
inline void step(const KernelContext& context, bool on) {
  if (context.stepper == nullptr) return;
  // Beyond the 128 bytes below the stack pointer, which the compiler may use.
  if (on)
    asm volatile("lea -128(%%rsp), %%rsp\n pushfq\n orq $0x100, (%%rsp)\n popfq\n lea 128(%%rsp), %%rsp" ::
                     : "memory", "cc");
  else
    asm volatile("lea -128(%%rsp), %%rsp\n pushfq\n andq $-0x101, (%%rsp)\n popfq\n lea 128(%%rsp), %%rsp" ::
                     : "memory", "cc");
}

/// The context that this thread runs, or null. Set for the time of a run.
KernelContext*& current_context();

/// First function on the kernel's stack: sets the SPU's arithmetic, calls main, asks for the stop.
void kernel_start(boost::context::detail::transfer_t transfer);

/// Called by kernels through the environment.
/// @param request  as KernelContext's
std::uint32_t gate(std::uint32_t request, std::uint32_t value);

/// Where kernels call the gate: an address below 4 GB, which their pointers can hold. The same for all
/// threads and as long as the process.
/// @throws std::runtime_error  the host has no room for it below 4 GB, or forbids executable memory.
std::uint32_t gate_below_4_gb();

/// First function on the landing stack.
void land();

}  // namespace softcell::ls_sim::native
