// The host code that runs on a kernel's stack or the landing stack. Built without sanitizers: see
// kernel_context.h.

#include <xmmintrin.h>

#include "kernel_context.h"

namespace softcell::ls_sim::native {
namespace {

// Truncation, denormal results and operands to zero, all exceptions masked: the SPU's single precision inside
// the range that both formats share. [SPU ISA, single precision] documented
constexpr unsigned int kSpuArithmetic =
    _MM_MASK_MASK | _MM_ROUND_TOWARD_ZERO | _MM_FLUSH_ZERO_ON | 0x0040 /* DAZ */;

thread_local KernelContext* context_of_thread = nullptr;

/// Waits for the worker. fcontext saves the arithmetic mode of the side that leaves and restores that of the
/// side it enters.
void ask(KernelContext& context) {
  const auto back = boost::context::detail::jump_fcontext(context.worker, &context);
  context.worker = back.fctx;
}

}  // namespace

KernelContext*& current_context() { return context_of_thread; }

void kernel_start(boost::context::detail::transfer_t transfer) {
  auto& context = *static_cast<KernelContext*>(transfer.data);
  context.worker = transfer.fctx;
  _mm_setcsr(kSpuArithmetic);
  using Main = int(std::uint64_t, std::uint64_t, std::uint64_t);
  const int status = reinterpret_cast<Main*>(context.entry)(context.arguments[0], context.arguments[1],
                                                            context.arguments[2]);
  context.operation = Operation::kStop;
  context.value = 0x2000u | (static_cast<std::uint32_t>(status) & 0xFFu);
  ask(context);
  __builtin_trap();  // an ended run is never resumed
}

std::uint32_t gate(std::uint32_t operation, std::uint32_t value) {
  KernelContext& context = *context_of_thread;
  context.operation = static_cast<Operation>(operation >> 8);
  context.channel = operation & 0xFFu;
  context.value = value;
  context.caller = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) - 1;
  ask(context);
  return context.reply;
}

void land() {
  KernelContext& context = *current_context();
  context.operation = Operation::kFault;
  context.caller = context.trap.instruction;
  ask(context);
  __builtin_trap();
}

}  // namespace softcell::ls_sim::native
