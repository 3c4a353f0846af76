#pragma once
// Channels, halts, stops and barriers. [LEXT, channel control and control intrinsics] documented

#include "softcell_environment.h"
#include "softcell_float.h"

inline unsigned int spu_readch(unsigned int channel) { return softcell_sdk::call_gate(softcell_sdk::kRead, channel, 0); }
inline unsigned int spu_readchcnt(unsigned int channel) { return softcell_sdk::call_gate(softcell_sdk::kCount, channel, 0); }
inline void spu_writech(unsigned int channel, unsigned int value) { softcell_sdk::write_channel(channel, value); }
inline qword spu_readchqw(unsigned int channel) { return qword(vec_uint4(spu_readch(channel), 0u, 0u, 0u)); }
template <class V, class = decltype(V::kLanes)>
inline void spu_writechqw(unsigned int channel, const V& value) {
  spu_writech(channel, vec_uint4(value).raw[0]);
}

/// Ends the program with a 14-bit code. Unlike on the hardware it does not come back: no host here restarts a stopped SPU.
inline void spu_stop(unsigned int code) { softcell_sdk::call_gate(softcell_sdk::kStop, 0, code); }

/// Halt the SPU when the condition holds.
inline void spu_hcmpeq(int a, int b) {
  if (a == b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
inline void spu_hcmpeq(unsigned int a, unsigned int b) {
  if (a == b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
inline void spu_hcmpgt(int a, int b) {
  if (a > b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}
inline void spu_hcmpgt(unsigned int a, unsigned int b) {
  if (a > b) softcell_sdk::call_gate(softcell_sdk::kHalt, 0, 0);
}

// Order of loads, stores and instruction fetch: the host's compiler must not move memory accesses across; the rest is in order anyway.
inline void spu_sync() { asm volatile("" ::: "memory"); }
inline void spu_sync_c() { asm volatile("" ::: "memory"); }
inline void spu_dsync() { asm volatile("" ::: "memory"); }

// Interrupts do not exist in a job; asking to have them off changes nothing.
inline void spu_idisable() {}
