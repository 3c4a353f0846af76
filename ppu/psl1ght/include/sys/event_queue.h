#ifndef SOFTCELL_PSL1GHT_SYS_EVENT_QUEUE_H
#define SOFTCELL_PSL1GHT_SYS_EVENT_QUEUE_H
/* Event queues and the ports that lead to them. [PSL1GHT, sys/event_queue.h] documented
 *
 * All functions return 0, or an error of lv2 (0x8001....): ESRCH for a queue or port that there is not, EFAULT for a
 * null pointer, and what their comments say. Any thread may call them. */

#include <ppu-lv2.h>

#define SYS_EVENT_QUEUE_PPU 0x01
#define SYS_EVENT_QUEUE_SPU 0x02
#define SYS_EVENT_QUEUE_FIFO 0x01
#define SYS_EVENT_QUEUE_PRIO 0x02
#define SYS_EVENT_QUEUE_PRIO_INHERIT 0x03
#define SYS_EVENT_PORT_LOCAL 0x01
#define SYS_EVENT_PORT_NO_NAME 0x00
#define SYS_EVENT_QUEUE_KEY_LOCAL 0x00
#define SYS_EVENT_QUEUE_FORCE_DESTROY 0x01

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sys_event_queue_attr {
  u32 attr_protocol; /* SYS_EVENT_QUEUE_FIFO, _PRIO or _PRIO_INHERIT; threads of a PC are served in any order */
  s32 type;          /* who receives: SYS_EVENT_QUEUE_PPU or SYS_EVENT_QUEUE_SPU */
  char name[8];
} sys_event_queue_attr_t;

typedef struct sys_event {
  u64 source;
  u64 data_1;
  u64 data_2;
  u64 data_3;
} sys_event_t;

/* size: how many events it holds, 1 to 127. EINVAL: another size, type or protocol. EEXIST: the key is in use. */
s32 sysEventQueueCreate(sys_event_queue_t* eventQ, sys_event_queue_attr_t* attrib, sys_ipc_key_t key,
                        s32 size);
/* mode 0: EBUSY while somebody waits for it; SYS_EVENT_QUEUE_FORCE_DESTROY: they return with ECANCELED. */
s32 sysEventQueueDestroy(sys_event_queue_t eventQ, s32 mode);
/* Waits for an event. timeout_usec: microseconds, 0 for ever. ETIMEDOUT; ECANCELED: the queue was destroyed.
 * EINVAL: SPU threads receive from this queue. */
s32 sysEventQueueReceive(sys_event_queue_t eventQ, sys_event_t* event, u64 timeout_usec);
/* Removes all events. */
s32 sysEventQueueDrain(sys_event_queue_t eventQ);

/* name: `source` of its events; SYS_EVENT_PORT_NO_NAME: the number of the port. EINVAL: not SYS_EVENT_PORT_LOCAL. */
s32 sysEventPortCreate(sys_event_port_t* portId, int portType, u64 name);
/* EISCONN: it is connected. */
s32 sysEventPortDestroy(sys_event_port_t portId);
/* EISCONN: it is connected already. */
s32 sysEventPortConnectLocal(sys_event_port_t portId, sys_event_queue_t eventQ);
/* ENOTCONN */
s32 sysEventPortDisconnect(sys_event_port_t portId);
/* ENOTCONN; EBUSY: the queue is full. */
s32 sysEventPortSend(sys_event_port_t portId, u64 data0, u64 data1, u64 data2);

#ifdef __cplusplus
}
#endif

#endif
