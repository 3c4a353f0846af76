#pragma once
// Events of a PSL1GHT thread group to a queue of the PPU side.  [PSL1GHT, sys/spu_event.h] documented

#include <stdint.h>
#include <sys/cdefs.h>

#define EVENT_DATA0_MASK 0x00FFFFFF
#define EVENT_PORT_SHIFT 24
#define EVENT_PORT_MAX_NUM 63
#define EVENT_PRINTF_PORT 1U

__BEGIN_DECLS
/// Sends 24 bits and 32 bits to a port 0..63 and waits for the answer. @return  the answer, 0 for success.
int spu_thread_send_event(uint8_t port, uint32_t data0, uint32_t data1);
/// Likewise, without waiting for an answer.
int spu_thread_throw_event(uint8_t port, uint32_t data0, uint32_t data1);
/// Waits for an event of the queue that the PPU side has bound to the thread under this number, and gives the low 32
/// bits of its three data. @return  0, or an error of lv2: nothing is bound there, or the inbound mailbox holds values.
int spu_thread_receive_event(uint32_t spuq, uint32_t* data0, uint32_t* data1, uint32_t* data2);
/// Likewise without waiting. @return  also an error when there is no event.
int spu_thread_tryreceive_event(uint32_t spuq, uint32_t* data0, uint32_t* data1, uint32_t* data2);
__END_DECLS
