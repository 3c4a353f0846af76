#ifndef SOFTCELL_LIBSPE2_TYPES_H
#define SOFTCELL_LIBSPE2_TYPES_H
/* Types and constants of the SPE Runtime Management Library. Names, members and values are those of the library's
 * documentation, so that programs compile unchanged. [SPE Runtime Management Library 2.2] documented */
#if defined(__INCLUDE_LEVEL__) && __INCLUDE_LEVEL__ > 0
#pragma GCC system_header /* as on a Cell: no warnings of it, whatever standard the program asks for */
#endif

#include <limits.h>
#include <signal.h>

#include "cbea_map.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An SPE program in the memory of the PPU program: one that spe_image_open() has opened, or one that was embedded.
 * handle_size is the size of what there is of this structure. */
typedef struct spe_program_handle {
  unsigned int handle_size;
  void* elf_image;
  void* toe_shadow;
} spe_program_handle_t;

/* A context: one SPE as the program sees it. */
typedef struct spe_context* spe_context_ptr_t;

/* Contexts that belong together. */
typedef struct spe_gang_context* spe_gang_context_ptr_t;

/* Why a context has stopped: stop_reason is one of SPE_EXIT to SPE_ISOLATION_ERROR and says which member of
 * `result` holds. */
typedef struct spe_stop_info {
  unsigned int stop_reason;
  union {
    int spe_exit_code;
    int spe_signal_code;
    int spe_runtime_error;
    int spe_runtime_exception;
    int spe_runtime_fatal;
    int spe_callback_error;
    int spe_isolation_error;
    void* __reserved_ptr;
    unsigned long long __reserved_u64;
  } result;
  int spu_status;
} spe_stop_info_t;

/* What a program wants to get back with an event. */
typedef union spe_event_data {
  void* ptr;
  unsigned int u32;
  unsigned long long u64;
} spe_event_data_t;

/* Events of one context. */
typedef struct spe_event_unit {
  unsigned int events;
  spe_context_ptr_t spe;
  spe_event_data_t data;
} spe_event_unit_t;

typedef void* spe_event_handler_ptr_t;
typedef int spe_event_handler_t;

/* spe_ps_area_get() */
enum ps_area {
  SPE_MSSYNC_AREA,
  SPE_MFC_COMMAND_AREA,
  SPE_CONTROL_AREA,
  SPE_SIG_NOTIFY_1_AREA,
  SPE_SIG_NOTIFY_2_AREA
};

/* spe_context_create(): flags */
#define SPE_CFG_SIGNOTIFY1_OR 0x00000010 /* signal register 1 collects bits; else it keeps the last value */
#define SPE_CFG_SIGNOTIFY2_OR 0x00000020
#define SPE_MAP_PS 0x00000040          /* spe_ps_area_get() may be used */
#define SPE_ISOLATE 0x00000080         /* not here: ENODEV */
#define SPE_ISOLATE_EMULATE 0x00000100 /* not here: ENODEV */
#define SPE_EVENTS_ENABLE 0x00001000   /* events and spe_stop_info_read() may be used */
#define SPE_AFFINITY_MEMORY 0x00002000
#define SPE_NOSCHED 0x00004000

/* spe_stop_info_t: stop_reason */
#define SPE_EXIT 1              /* the program has ended; spe_exit_code is its status */
#define SPE_STOP_AND_SIGNAL 2   /* spe_signal_code is the code of the instruction */
#define SPE_RUNTIME_ERROR 3     /* spe_runtime_error is one of SPE_SPU_... */
#define SPE_RUNTIME_EXCEPTION 4 /* spe_runtime_exception is one of SPE_DMA_..., SPE_INVALID_DMA */
#define SPE_RUNTIME_FATAL 5     /* spe_runtime_fatal is a value of errno */
#define SPE_CALLBACK_ERROR 6    /* spe_callback_error is what the callback has returned */
#define SPE_ISOLATION_ERROR 7

#define SPE_SPU_STOPPED_BY_STOP 0x02
#define SPE_SPU_HALT 0x04
#define SPE_SPU_WAITING_ON_CHANNEL 0x08
#define SPE_SPU_SINGLE_STEP 0x10
#define SPE_SPU_INVALID_INSTR 0x20
#define SPE_SPU_INVALID_CHANNEL 0x40

#define SPE_DMA_ALIGNMENT 0x0008
#define SPE_DMA_SEGMENTATION 0x0020
#define SPE_DMA_STORAGE 0x0040
#define SPE_INVALID_DMA 0x0800

#define SIGSPE SIGURG

/* spe_event_unit_t: events */
#define SPE_EVENT_OUT_INTR_MBOX 0x00000001 /* there is something in the outbound interrupting mailbox */
#define SPE_EVENT_IN_MBOX 0x00000002       /* there is room in the inbound mailbox */
#define SPE_EVENT_TAG_GROUP 0x00000004     /* proxy commands are complete */
#define SPE_EVENT_SPE_STOPPED 0x00000008   /* the context has stopped */
#define SPE_EVENT_ALL_EVENTS \
  (SPE_EVENT_OUT_INTR_MBOX | SPE_EVENT_IN_MBOX | SPE_EVENT_TAG_GROUP | SPE_EVENT_SPE_STOPPED)

/* mailboxes: behavior */
#define SPE_MBOX_ALL_BLOCKING 1
#define SPE_MBOX_ANY_BLOCKING 2
#define SPE_MBOX_ANY_NONBLOCKING 3

/* spe_mfcio_tag_status_read(): behavior */
#define SPE_TAG_ALL 1
#define SPE_TAG_ANY 2
#define SPE_TAG_IMMEDIATE 3

/* spe_context_run(): entry and flags */
#define SPE_DEFAULT_ENTRY UINT_MAX
#define SPE_RUN_USER_REGS 0x00000001 /* argp points to three quadwords for registers 3 to 5 */
#define SPE_NO_CALLBACKS 0x00000002  /* calls of the PPU side are returned as stops */

/* spe_callback_handler_register(): mode */
#define SPE_CALLBACK_NEW 1
#define SPE_CALLBACK_UPDATE 2

/* spe_cpu_info_get() */
#define SPE_COUNT_PHYSICAL_CPU_NODES 1
#define SPE_COUNT_PHYSICAL_SPES 2
#define SPE_COUNT_USABLE_SPES 3

/* spe_signal_write(): signal_reg */
#define SPE_SIG_NOTIFY_REG_1 0x0001
#define SPE_SIG_NOTIFY_REG_2 0x0002

#ifdef __cplusplus
}
#endif

#endif
