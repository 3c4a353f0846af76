// The host code that runs on a kernel's stack or the landing stack. Built without sanitizers: see
// kernel_context.h.

#include <xmmintrin.h>

#include "kernel_context.h"
#include "serialise.h"

namespace softcell::ls_sim::native {
namespace {

// Truncation, denormal results and operands to zero, all exceptions masked: the SPU's single precision inside
// the range that both formats share. [SPU ISA, single precision] documented
constexpr unsigned int kSpuArithmetic =
    _MM_MASK_MASK | _MM_ROUND_TOWARD_ZERO | _MM_FLUSH_ZERO_ON | 0x0040 /* DAZ */;

thread_local KernelContext* context_of_thread = nullptr;

/// Back to run(), for good: the kernel's frames are abandoned where they are.
[[noreturn]] void leave(KernelContext& context) {
  boost::context::detail::jump_fcontext(context.worker, &context);
  __builtin_trap();  // an ended run is never resumed
}

}  // namespace

// function(context) on another stack, as a plain call: a jump there and back by Boost.Context costs three
// times as much, for it exchanges registers that a call keeps, an x87 mode that nobody uses, and the
// processor predicts no return behind it. The unwinder finds its way from the worker's stack to the kernel's.
// How much Boost has saved on `stack` depends on its version, so this function aligns it. It also clears the direction flag: a kernel may
// have set it, and then copies that the host's code makes would go backwards.
extern "C" bool softcell_call_on_stack(ServeRequest* function, KernelContext* context, void* stack);
asm(R"(
        .text
        .p2align 4
        .type   softcell_call_on_stack, @function
softcell_call_on_stack:
        .cfi_startproc
        cld
        pushq   %rbp
        .cfi_def_cfa_offset 16
        .cfi_offset %rbp, -16
        movq    %rsp, %rbp
        .cfi_def_cfa_register %rbp
        movq    %rdx, %rsp
        andq    $-16, %rsp
        movq    %rdi, %rax
        movq    %rsi, %rdi
        callq   *%rax
        movq    %rbp, %rsp
        popq    %rbp
        .cfi_def_cfa %rsp, 8
        ret
        .cfi_endproc
        .size   softcell_call_on_stack, . - softcell_call_on_stack
)");

KernelContext*& current_context() { return context_of_thread; }

void kernel_start(boost::context::detail::transfer_t transfer) {
  auto& context = *static_cast<KernelContext*>(transfer.data);
  context.worker = transfer.fctx;
  context.worker_arithmetic = _mm_getcsr();
  _mm_setcsr(kSpuArithmetic);
  serialise();
  // Numbers and vectors come in registers of different kinds: a main finds those of its own parameters.
  using Main = int(std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, __m128i, __m128i, __m128i);
  const auto vector = [&](int i) {
    return _mm_load_si128(reinterpret_cast<const __m128i*>(context.vectors[i]));
  };
  const int status =
      reinterpret_cast<Main*>(context.entry)(context.arguments[0], context.arguments[1], context.arguments[2],
                                             context.arguments[3], vector(0), vector(1), vector(2));
  gate(request_of(Operation::kStop), 0x2000u | (static_cast<std::uint32_t>(status) & 0xFFu));
  __builtin_trap();  // an ended run is never resumed
}

std::uint32_t gate(std::uint32_t request, std::uint32_t value) {
  KernelContext& context = *context_of_thread;
  context.request = request;
  context.value = value;
  context.caller = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) - 1;
  context.stack_pointer = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  _mm_setcsr(context.worker_arithmetic);
  if (!softcell_call_on_stack(context.serve, &context, context.worker)) leave(context);
  _mm_setcsr(kSpuArithmetic);
  if (request == request_of(Operation::kSync)) serialise();
  return context.reply;
}

void land() {
  KernelContext& context = *current_context();
  context.request = request_of(Operation::kFault);
  context.caller = context.trap.instruction;
  leave(context);
}

}  // namespace softcell::ls_sim::native
