#include "signals.h"

#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <mutex>
#include <string_view>

#include "kernel_context.h"
#include "serialise.h"
#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/debugger.h"

namespace softcell::ls_sim::native {
namespace {

constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP, kInterruptSignal};
std::array<struct sigaction, NSIG> previous_actions;

// Bits of the page-fault error code. [AMD64 manual, volume 2, page fault] documented
constexpr std::uint64_t kPageFaultWrite = 2, kPageFaultFetch = 16;

bool in_arena(const KernelContext& context, std::uintptr_t address) {
  return address - context.arena < dma::kLocalStoreBytes;
}

/// Does what would have happened without us.
void pass_on(int signal, siginfo_t* info, void* machine) {
  const struct sigaction& previous = previous_actions[static_cast<std::size_t>(signal)];
  if ((previous.sa_flags & SA_SIGINFO) != 0) {
    previous.sa_sigaction(signal, info, machine);
  } else if (previous.sa_handler == SIG_DFL) {
    sigaction(signal, &previous, nullptr);  // the instruction runs again and ends the process
    if (info->si_code <= 0) raise(signal);
  } else if (previous.sa_handler != SIG_IGN) {
    previous.sa_handler(signal);
  }
}

/// A kernel that is executed from the middle of an instruction can destroy what its thread needs to come back from it.
void say_that_no_return_is_possible() {
  constexpr std::string_view kSentence =
      "softcell: a kernel has destroyed the stack of the host's thread that runs it; this process ends\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kSentence.data(), kSentence.size());
}

constexpr greg_t kDirectionFlag = 0x400, kTrapFlag = 0x100;

/// Leaves the kernel where it is: when the handler returns, the thread continues in land() on the landing
/// stack.
void redirect_to_landing(KernelContext& context, mcontext_t& machine) {
  context.landing = 1;
  machine.gregs[REG_RIP] = reinterpret_cast<greg_t>(&land);
  // As if called: 8 below a multiple of 16.
  machine.gregs[REG_RSP] = static_cast<greg_t>(context.landing_stack_top - 8);
  machine.gregs[REG_EFL] &= ~(kDirectionFlag | kTrapFlag);  // direction flag clear, as the ABI asks
}

/// An instruction that fails by itself, not by a breakpoint.
bool is_failure(int signal) { return signal != SIGTRAP && signal != kInterruptSignal; }

/// A processor that ran stale code fails where the code in the local store does not: so the instruction is
/// executed once more, alone, on a serialised processor. It fails again, or the trap flag raises SIGTRAP
/// behind it.
/// @return  whether the thread is to go on as the signal has found it.
bool executes_once_more(KernelContext& context, int signal, mcontext_t& machine, std::uintptr_t instruction) {
  if (context.stepping != 0) {
    context.stepping = 0;
    machine.gregs[REG_EFL] &= ~kTrapFlag;
    context.trap.stale = signal == SIGTRAP;
    return false;
  }
  if (!context.repeat_what_failed || !is_failure(signal) || !in_arena(context, instruction)) return false;
  context.stepping = 1;
  machine.gregs[REG_EFL] |= kTrapFlag;
  serialise();
  return true;
}

/// How the processor stopped the kernel.
void record_trap(KernelContext& context, int signal, const siginfo_t& info, const mcontext_t& machine) {
  const auto error = static_cast<std::uint64_t>(machine.gregs[REG_ERR]);
  context.trap = {.signal = signal,
                  .general_protection = signal == SIGSEGV && info.si_code == SI_KERNEL,
                  .instruction_fetch = (error & kPageFaultFetch) != 0,
                  .write = (error & kPageFaultWrite) != 0,
                  .address = reinterpret_cast<std::uintptr_t>(info.si_addr),
                  .instruction = static_cast<std::uintptr_t>(machine.gregs[REG_RIP]),
                  .stack = static_cast<std::uintptr_t>(machine.gregs[REG_RSP])};
}

/// The trap flag has stopped the thread before its next instruction, and goes on being set.
bool is_step(KernelContext& context, int signal, const siginfo_t& info, const mcontext_t& machine) {
  if (context.stepper == nullptr || signal != SIGTRAP || info.si_code != TRAP_TRACE) return false;
  const auto instruction = static_cast<std::uintptr_t>(machine.gregs[REG_RIP]);
  if (in_arena(context, instruction))
    context.stepper->on_instruction(context.spe, {static_cast<std::uint32_t>(instruction - context.arena)});
  return true;
}

void handle(int signal, siginfo_t* info, void* machine_context) {
  KernelContext* context = current_context();
  if (context != nullptr &&
      is_step(*context, signal, *info, static_cast<ucontext_t*>(machine_context)->uc_mcontext))
    return;
  if (signal == kInterruptSignal && info->si_code == SI_TKILL) {
    // Late, or between kernel and worker: the flag is read at the next channel operation.
    if (context == nullptr) return;
    context->interrupted = 1;
  } else if (context == nullptr || context->in_kernel == 0) {
    pass_on(signal, info, machine_context);
    return;
  } else if (context->landing != 0) {
    say_that_no_return_is_possible();
    pass_on(signal, info, machine_context);
    return;
  }
  auto& machine = static_cast<ucontext_t*>(machine_context)->uc_mcontext;
  const auto instruction = static_cast<std::uintptr_t>(machine.gregs[REG_RIP]);
  if (signal == kInterruptSignal && info->si_code == SI_TKILL &&
      (context->in_kernel == 0 || !in_arena(*context, instruction))) {
    return;
  }
  if (executes_once_more(*context, signal, machine, instruction)) {
    record_trap(*context, signal, *info, machine);
    return;
  }
  if (!context->trap.stale) record_trap(*context, signal, *info, machine);
  redirect_to_landing(*context, machine);
}

}  // namespace

void install_signal_handlers() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};
    action.sa_sigaction = handle;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    for (const int signal : kSignals)
      sigaction(signal, &action, &previous_actions[static_cast<std::size_t>(signal)]);
  });
}

SignalStack::SignalStack() : memory_(std::make_unique<std::byte[]>(kBytes)) {
  stack_t stack{};
  stack.ss_sp = memory_.get();
  stack.ss_size = kBytes;
  sigaltstack(&stack, &previous_);
}

SignalStack::~SignalStack() { sigaltstack(&previous_, nullptr); }

}  // namespace softcell::ls_sim::native
