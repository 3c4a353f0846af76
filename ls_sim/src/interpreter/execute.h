#pragma once
// One instruction alone, without engine or SPE: for tests, and for checks that try other operands.

#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/channels.h"
#include "spu_state.h"

namespace softcell::ls_sim::interpreter {

/// Changes the target of an instruction that computes it from registers and the immediate alone (Kind::kCompute, kFloat or
/// kEnhancedDouble). Called in the SPU's floating-point mode.
void compute(SpuState& state, const Operation& operation);

/// What one instruction did to the flow of control.
struct Step {
  Ending ending = Ending::kNone;
  std::uint32_t stop_code = 0;  ///< of Ending::kStop
};

/// Executes one instruction word as if it lay at state.pc; the local store need not hold it. Afterwards
/// state.pc is the next instruction's address, and, after kHalt, kInvalid and kChannelFault, still that of the
/// word. Registers are as spu_state.h says. Channels 13 to 15 are the state's own (machine status, SRR0); the
/// parameters of an MFC command are written to the port one by one.
/// The processor needs AVX2 and FMA. Any thread; the host's floating-point mode is as before afterwards.
/// @param word  as the SPU fetches it: the byte at the lowest address is the most significant.
/// @param channels  reached by rdch, rchcnt, wrch, bisled and sync; null: each count is 1, reads give 0.
Step execute(SpuState& state, std::span<std::byte, dma::kLocalStoreBytes> local_store, std::uint32_t word,
             ChannelPort* channels = nullptr);

}  // namespace softcell::ls_sim::interpreter
