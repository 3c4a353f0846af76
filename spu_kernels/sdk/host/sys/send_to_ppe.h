#pragma once
// Calls of the PPU side: the program stops, a function that the PPU side has registered under a number
// (spe_callback_handler_register of libspe2) reads its arguments in the local store and writes the results over
// them, and the program goes on. For C and C++. [libspe2, newlib] documented
//
//   void __send_to_ppe(int signalcode, int opcode, void* data)
//     signalcode  0x2100 + number, 0x2100 to 0x21FF
//     opcode      0 to 255: what the function is to do
//     data        arguments in the local store, a multiple of 16; the results replace them

#ifdef __cplusplus
#include "../softcell_environment.h"

__attribute__((always_inline)) inline void __send_to_ppe(int signalcode, int opcode, void* data) {
  softcell_sdk::call_gate(softcell_sdk::kAssist, static_cast<uint32_t>(signalcode) & 0xFFu,
                          static_cast<uint32_t>(opcode) << 24 | softcell_sdk::local_store_address(data));
}
#else
#include "../../c/softcell_c_environment.h"

SC_C_INLINE void __send_to_ppe(int signalcode, int opcode, void* data) {
  softcell_call_gate(softcell_assist, (uint32_t)signalcode & 0xFFu,
                     (uint32_t)opcode << 24 | softcell_lsa(data));
}
#endif
