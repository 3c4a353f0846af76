#pragma once
// As newlib for the SPU declares it.

#ifdef __cplusplus
extern "C" void __send_to_ppe(int signalcode, int opcode, void* data);
#else
void __send_to_ppe(int signalcode, int opcode, void* data);
#endif
