#include "execute.h"

#include "channel_access.h"
#include "core.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim::interpreter {
namespace {

/// Not inlined: the mode of arithmetic changes around it.
[[gnu::noinline]] Flow perform_alone(Core& core, const Operation& operation) {
  NoObserver observer;
  std::uint32_t pc = core.state.pc;
  const Flow flow = perform(core, operation, pc, observer);
  core.state.pc = flow == Flow::kNext ? detail::next_of(pc) : pc;
  return flow;
}

}  // namespace

void compute(SpuState& state, const Operation& operation) {
  ChannelAccess nothing(state, nullptr);
  Core core{.state = state, .local_store = nullptr, .surroundings = nothing};
  perform_alone(core, operation);
}

Step execute(SpuState& state, std::span<std::byte, dma::kLocalStoreBytes> local_store, std::uint32_t word,
             ChannelPort* channels) {
  SC_ASSERT((state.pc & ~kInstructionMask) == 0, "the program counter is {}", state.pc);
  ChannelAccess access(state, channels);
  Core core{.state = state, .local_store = local_store.data(), .surroundings = access};
  const SpuArithmetic arithmetic;
  perform_alone(core, decode(word));
  return {core.ending, core.stop_code};
}

}  // namespace softcell::ls_sim::interpreter
