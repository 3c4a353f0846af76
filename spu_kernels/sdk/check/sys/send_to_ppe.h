#pragma once
// As newlib for the SPU declares it.

extern "C" void __send_to_ppe(int signalcode, int opcode, void* data);
