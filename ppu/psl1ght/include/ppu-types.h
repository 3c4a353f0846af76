#ifndef SOFTCELL_PSL1GHT_PPU_TYPES_H
#define SOFTCELL_PSL1GHT_PPU_TYPES_H
/* The numbers and names of lv2's objects as PSL1GHT programs write them. [PSL1GHT, ppu-types.h] documented */

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/types.h>

typedef uint8_t u8;
typedef uint16_t u16;
typedef uint32_t u32;
typedef uint64_t u64;
typedef int8_t s8;
typedef int16_t s16;
typedef int32_t s32;
typedef int64_t s64;
typedef float f32;
typedef double f64;
typedef volatile u8 vu8;
typedef volatile u16 vu16;
typedef volatile u32 vu32;
typedef volatile u64 vu64;
typedef volatile s8 vs8;
typedef volatile s16 vs16;
typedef volatile s32 vs32;
typedef volatile s64 vs64;
typedef volatile f32 vf32;
typedef volatile f64 vf64;

typedef u32 sys_pid_t;
typedef u32 sys_mem_container_t;
typedef u32 sys_raw_spu_t;
typedef u32 sys_spu_group_t;
typedef u32 sys_spu_thread_t;
typedef u64 sys_ppu_thread_t;
typedef u32 sys_interrupt_tag_t;
typedef u32 sys_event_queue_t;
typedef u32 sys_event_port_t;
typedef u64 sys_ipc_key_t;
typedef s64 system_time_t;

#ifndef TRUE
#define TRUE 1
#endif
#ifndef FALSE
#define FALSE 0
#endif

/* On the console pointers in structures of lv2 have 32 bits; here they are the PC's. */
#define ATTRIBUTE_PRXPTR

#define SPU_ALIGNMENT 128
#define SPU_ALIGNSIZE(x) (((x) + 127) & ~127)

#endif
