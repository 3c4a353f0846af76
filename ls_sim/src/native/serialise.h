#pragma once
// Makes a processor forget what it has fetched ahead of the instructions that it executes.
//
// A kernel's code arrives by DMA: this thread, another SPE's or the PPU's has written it. Both manuals ask
// for a serialising instruction between the arrival of code that another processor has written and its
// execution: "Execute serializing instruction; Execute new code" [Intel SDM 3, handling self- and
// cross-modifying code]; for code that the same processor wrote they ask for none. The engine executes one in
// both cases, where the SPU has its `sync`: at spu_sync, spu_sync_c, and at the start of a run.

namespace softcell::ls_sim::native {

/// Any thread, any stack; needs 48 bytes of it. Some 40 ns. Executes SERIALIZE where the processor has it,
/// and elsewhere an IRET to the next instruction: CPUID, the third choice of both manuals, leaves a virtual
/// machine for its host, which takes 4 microseconds (measured: 42 and 4,300 ns).
void serialise();

}  // namespace softcell::ls_sim::native
