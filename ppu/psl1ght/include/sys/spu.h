#ifndef SOFTCELL_PSL1GHT_SYS_SPU_H
#define SOFTCELL_PSL1GHT_SYS_SPU_H
/* SPU thread groups and raw SPUs as PSL1GHT programs use them. Link with softcell::psl1ght (CMake) or
 * `pkg-config --cflags --libs softcell-psl1ght`. [PSL1GHT, sys/spu.h] documented
 *
 * All functions return 0, or an error of lv2 (0x8001....): ESRCH for what there is not, EFAULT for a null pointer,
 * ENOSYS with a sentence on standard error for what softcell does not have, and what their comments say. Any thread
 * may call them. Names are as PSL1GHT spells them.
 *
 * A thread that breaks a rule is reported on standard error with kernel, line and rule. If an event queue is connected
 * to SPU_THREAD_GROUP_EVENT_EXCEPTION its group ends and the queue gets an event; else the program ends with status 1,
 * as lv2 ends it. */

#include <lv2/spu.h>
#include <ppu-asm.h>
#include <ppu-lv2.h>
#include <sys/event_queue.h>

/* Registers of problem state, from SPU_PROBLEM_OFFSET on. */
#define MFC_LSA 0x3004
#define MFC_EAH 0x3008
#define MFC_EAL 0x300C
#define MFC_Size 0x3010
#define MFC_Class_CMD 0x3014
#define MFC_CMD_Status 0x3014
#define MFC_QStatus 0x3104
#define Prxy_QueryType 0x3204
#define Prxy_QueryMask 0x321C
#define Prxy_TagStatus 0x322C
#define SPU_Out_MBox 0x4004
#define SPU_In_MBox 0x400C
#define SPU_MBox_Status 0x4014
#define SPU_RunCtrl 0x401C
#define SPU_Status 0x4024
#define SPU_NextPC 0x4034
#define SPU_Sig_Notify_1 0x1400C
#define SPU_Sig_Notify_2 0x1C00C

#define SPU_THREAD_GROUP_TYPE_NORMAL 0x0
#define SPU_THREAD_GROUP_TYPE_SEQUENTIAL 0x1
#define SPU_THREAD_GROUP_TYPE_SYSTEM 0x2
#define SPU_THREAD_GROUP_TYPE_MEMORY_FROM_CONTAINER 0x4

#define SPU_THREAD_GROUP_JOIN_GROUP_EXIT 0x0001
#define SPU_THREAD_GROUP_JOIN_ALL_THREADS_EXIT 0x0002
#define SPU_THREAD_GROUP_JOIN_TERMINATED 0x0004

#define SPU_THREAD_GROUP_EVENT_RUN 0x1
#define SPU_THREAD_GROUP_EVENT_RUN_KEY 0xFFFFFFFF53505500ULL
#define SPU_THREAD_GROUP_EVENT_EXCEPTION 0x2
#define SPU_THREAD_GROUP_EVENT_EXCEPTION_KEY 0xFFFFFFFF53505503ULL

#define SPU_THREAD_ATTR_NONE 0x00
#define SPU_THREAD_ATTR_ASYNC_INT_ENABLE 0x01
#define SPU_THREAD_ATTR_DEC_SYNC_TB_ENABLE 0x02

#define SPU_THREAD_EVENT_USER 0x01
#define SPU_THREAD_EVENT_DMA 0x02
#define SPU_THREAD_EVENT_USER_KEY 0xFFFFFFFF53505501ULL
#define SPU_THREAD_EVENT_DMA_KEY 0xFFFFFFFF53505502ULL

#define SPU_SIGNAL1_OVERWRITE 0x00
#define SPU_SIGNAL1_OR 0x01
#define SPU_SIGNAL2_OVERWRITE 0x00
#define SPU_SIGNAL2_OR 0x02

#define SPU_EXCEPTION_DMA_ALIGNMENT 0x0001U
#define SPU_EXCEPTION_DMA_COMMAND 0x0002U
#define SPU_EXCEPTION_SPU_ERROR 0x0004U
#define SPU_EXCEPTION_MFC_FIR 0x0008U
#define SPU_EXCEPTION_MFC_SEGMENT 0x0010U
#define SPU_EXCEPTION_MFC_STORAGE 0x0020U
#define SPU_EXCEPTION_STOP_CALL 0x0100U
#define SPU_EXCEPTION_STOP_BREAK 0x0200U
#define SPU_EXCEPTION_HALT 0x0400U
#define SPU_EXCEPTION_UNKNOWN_SIGNAL 0x0800U
#define SPU_EXCEPTION_NO_VALUE 0x0U

#define SPU_THREAD_BASE 0xF0000000ULL
#define SPU_THREAD_OFFSET 0x00100000ULL
#define SPU_RAW_BASE 0xE0000000ULL
#define SPU_RAW_OFFSET 0x00100000ULL
#define SPU_LOCAL_OFFSET 0x00000000ULL
#define SPU_PROBLEM_OFFSET 0x00040000ULL

#define SPU_RAW_GET_BASE_OFFSET(spu) (SPU_RAW_BASE + (SPU_RAW_OFFSET * (spu)))
#define SPU_RAW_GET_LOCAL_STORAGE(spu, reg) (SPU_RAW_GET_BASE_OFFSET(spu) + SPU_LOCAL_OFFSET + (reg))
#define SPU_RAW_GET_PROBLEM_STORAGE(spu, reg) (SPU_RAW_GET_BASE_OFFSET(spu) + SPU_PROBLEM_OFFSET + (reg))
#define SPU_THREAD_GET_BASE_OFFSET(spu) (SPU_THREAD_BASE + (SPU_THREAD_OFFSET * (spu)))
#define SPU_THREAD_GET_LOCAL_STORAGE(spu, reg) (SPU_THREAD_GET_BASE_OFFSET(spu) + SPU_LOCAL_OFFSET + (reg))
#define SPU_THREAD_GET_PROBLEM_STORAGE(spu, reg) \
  (SPU_THREAD_GET_BASE_OFFSET(spu) + SPU_PROBLEM_OFFSET + (reg))

#ifdef __cplusplus
extern "C" {
#endif

typedef struct _sys_spu_thread_arg {
  u64 arg0;
  u64 arg1;
  u64 arg2;
  u64 arg3;
} sysSpuThreadArgument;

typedef struct _sys_spu_thread_attr {
  const char* name;
  u32 nsize; /* of the name with its zero */
  u32 option;
} sysSpuThreadAttribute;

typedef struct _sys_spu_thread_group_attr {
  u32 nsize; /* of the name with its zero */
  const char* name;
  u32 type;
  union {
    sys_mem_container_t ct;
  } option;
} sysSpuThreadGroupAttribute;

#define SOFTCELL_SET_NAME(x, s)                                                \
  do {                                                                         \
    const char* const softcell_name = (s);                                     \
    (x).name = softcell_name;                                                  \
    (x).nsize = 0;                                                             \
    if (softcell_name != NULL) {                                               \
      while ((x).nsize < 127 && softcell_name[(x).nsize] != '\0') ++(x).nsize; \
      ++(x).nsize;                                                             \
    }                                                                          \
  } while (0)
#define sysSpuThreadAttributeInitialize(x) \
  ((void)((x).name = NULL, (x).nsize = 0, (x).option = SPU_THREAD_ATTR_NONE))
#define sysSpuThreadAttributeName(x, s) SOFTCELL_SET_NAME(x, s)
#define sysSpuThreadAttributeOption(x, f) ((void)((x).option = (f)))
#define sysSpuThreadArgumentInitialize(x) ((void)((x).arg0 = (x).arg1 = (x).arg2 = (x).arg3 = 0))
#define sysSpuThreadGroupAttributeInitialize(x) \
  ((void)((x).name = NULL, (x).nsize = 0, (x).type = SPU_THREAD_GROUP_TYPE_NORMAL))
#define sysSpuThreadGroupAttributeName(x, s) SOFTCELL_SET_NAME(x, s)
#define sysSpuThreadGroupAttributeType(x, t) ((void)((x).type = (t)))
#define sysSpuThreadGroupAttributeMemoryContainer(x, container) \
  ((void)((x).type |= SPU_THREAD_GROUP_TYPE_MEMORY_FROM_CONTAINER, (x).option.ct = (container)))

/* spus: 0 to 6 in all; rawspus: how many of them may be raw. EINVAL: more than there are. */
s32 sysSpuInitialize(u32 spus, u32 rawspus);

/* As sysSpuImageImport(), from a file. ENOENT: there is none. */
s32 sysSpuImageOpen(sysSpuImage* image, const char* path);
s32 sysSpuImageOpenFd(sysSpuImage* image, s32 fd, u64 offset);

/* ---- thread groups: made, filled with threads, started, joined, started again or destroyed */

/* EINVAL: not 1 to 6 threads, or a priority outside 16 to 255. */
s32 sysSpuThreadGroupCreate(sys_spu_group_t* group, u32 num, u32 prio, sysSpuThreadGroupAttribute* attr);
/* EBUSY: it runs. */
s32 sysSpuThreadGroupDestroy(sys_spu_group_t group);
/* Loads all threads and starts them together: it returns when each has come to its first operation of a
 * channel, or has computed for a second. ESTAT: it runs already, or a thread was not initialized. EAGAIN: the host has no room. */
s32 sysSpuThreadGroupStart(sys_spu_group_t group);
/* Waits for its end. *cause: SPU_THREAD_GROUP_JOIN_...; *status: of spu_thread_group_exit() or
 * sysSpuThreadGroupTerminate(), else 0. Both may be null. ESTAT: it was not started since the last join. EBUSY:
 * another thread waits for it. */
s32 sysSpuThreadGroupJoin(sys_spu_group_t group, u32* cause, u32* status);
/* Ends all its threads. ESTAT: it does not run. */
s32 sysSpuThreadGroupTerminate(sys_spu_group_t group, u32 value);
/* Gives way to groups of the same priority: all groups of a PC run at the same time. ESTAT: it does not run. */
s32 sysSpuThreadGroupYield(sys_spu_group_t group);
/* ENOSYS: an SPE of softcell is not stopped between its instructions. */
s32 sysSpuThreadGroupSuspend(sys_spu_group_t group);
s32 sysSpuThreadGroupResume(sys_spu_group_t group);
/* EINVAL: outside 16 to 255. It has no effect on a PC. */
s32 sysSpuThreadGroupSetPriority(sys_spu_group_t group, u32 prio);
s32 sysSpuThreadGroupGetPriority(sys_spu_group_t group, u32* prio);
/* eventType: SPU_THREAD_GROUP_EVENT_RUN or _EXCEPTION, else EINVAL. EISCONN, ENOTCONN. */
s32 sysSpuThreadGroupConnectEvent(sys_spu_group_t group, sys_event_queue_t eventQ, u32 eventType);
s32 sysSpuThreadGroupDisconnectEvent(sys_spu_group_t group, u32 eventType);
/* Connects the lowest port of the mask `req` that is free in all threads; *spup is its number. EISCONN: none is. */
s32 sysSpuThreadGroupConnectEventAllThreads(sys_spu_group_t group, sys_event_queue_t eventQ, u64 req,
                                            u8* spup);
s32 sysSpuThreadGroupDisonnectEventAllThreads(sys_spu_group_t group, u8 spup);

/* ---- threads */

/* spu: its number in the group, by which the others reach it at SPU_THREAD_BASE. EINVAL: not below the group's number
 * of threads. EBUSY: it is initialized already, or the group runs. */
s32 sysSpuThreadInitialize(sys_spu_thread_t* thread, sys_spu_group_t group, u32 spu, sysSpuImage* image,
                           sysSpuThreadAttribute* attributes, sysSpuThreadArgument* arguments);
s32 sysSpuThreadSetArguments(sys_spu_thread_t thread, sysSpuThreadArgument* arguments);
/* ESTAT: it has not ended by spu_thread_exit(). */
s32 sysSpuThreadGetExitStatus(sys_spu_thread_t thread, s32* status);
/* type: SPU_THREAD_EVENT_USER, else EINVAL; spup: 0 to 63. EISCONN, ENOTCONN. */
s32 sysSpuThreadConnectEvent(sys_spu_thread_t thread, sys_event_queue_t queue, u32 type, u8 spup);
s32 sysSpuThreadDisconnectEvent(sys_spu_thread_t thread, u32 type, u8 spup);
/* The queue that spu_thread_receive_event(spuq_num) receives from. EBUSY: the number is bound already. */
s32 sysSpuThreadBindQueue(sys_spu_thread_t thread, sys_event_queue_t queue, u32 spuq_num);
s32 sysSpuThreadUnbindQueue(sys_spu_thread_t thread, u32 spuq_num);
/* type: 1, 2, 4 or 8 bytes at a multiple of that, else EINVAL. ESTAT: the group does not run. */
s32 sysSpuThreadWriteLocalStorage(sys_spu_thread_t thread, u32 address, u64 value, u32 type);
s32 sysSpuThreadReadLocalStorage(sys_spu_thread_t thread, u32 address, u64* value, u32 type);
/* signal: 0 for the first register, 1 for the second, else EINVAL. ESTAT: the group does not run. */
s32 sysSpuThreadWriteSignal(sys_spu_thread_t thread, u32 signal, u32 value);
/* value: SPU_SIGNAL1_OR and SPU_SIGNAL2_OR or neither. EINVAL: other bits. */
s32 sysSpuThreadSetConfiguration(sys_spu_thread_t thread, u64 value);
s32 sysSpuThreadGetConfiguration(sys_spu_thread_t thread, u64* value);
/* The inbound mailbox; a fifth value replaces the fourth. ESTAT: the group does not run. */
s32 sysSpuThreadWriteMb(sys_spu_thread_t thread, u32 value);
/* ENOSYS: a fault ends the thread. */
s32 sysSpuThreadRecoverPageFault(sys_spu_thread_t thread);

/* ---- raw SPUs */

/* attributes: not looked at. EAGAIN: sysSpuInitialize() has made room for no more. */
s32 sysSpuRawCreate(sys_raw_spu_t* spu, u32* attributes);
/* Ends what runs on it. */
s32 sysSpuRawDestroy(sys_raw_spu_t spu);
/* ENOSYS: a PC program has no interrupt handlers for SPUs; read the status and the mailboxes. */
s32 sysSpuRawCreateInterrupTag(sys_raw_spu_t spu, u32 classid, u32 hardwarethread, u32* tag);
/* classid: 0 to 2, else EINVAL. The mask is kept; no interrupt is raised. */
s32 sysSpuRawSetIntMask(sys_raw_spu_t spu, u32 classid, u64 mask);
s32 sysSpuRawGetIntMask(sys_raw_spu_t spu, u32 classid, u64* mask);
/* Of class 2: 1, the interrupt mailbox holds a value; 2, the SPU has stopped. Setting clears nothing that lasts. */
s32 sysSpuRawSetIntStat(sys_raw_spu_t spu, u32 classid, u64 stat);
s32 sysSpuRawGetIntStat(sys_raw_spu_t spu, u32 classid, u64* stat);
/* The interrupt mailbox. EBUSY: it is empty. */
s32 sysSpuRawReadPuintMb(sys_raw_spu_t spu, u32* value);
s32 sysSpuRawSetConfiguration(sys_raw_spu_t spu, u32 value);
s32 sysSpuRawGetConfirugation(sys_raw_spu_t spu, u32* value);
/* ENOSYS: a fault ends the program. */
s32 sysSpuRawRecoverPageFault(sys_raw_spu_t spu);

/* Registers and local store of a raw SPU by their offsets. Writing 1 to SPU_RunCtrl starts it, 0 stops it. */
void sysSpuRawWriteProblemStorage(sys_raw_spu_t spu, u32 reg, u32 value);
u32 sysSpuRawReadProblemStorage(sys_raw_spu_t spu, u32 reg);
void sysSpuRawWriteLocalStorage(sys_raw_spu_t spu, u32 reg, u32 value);
u32 sysSpuRawReadLocalStorage(sys_raw_spu_t spu, u32 reg);

#ifdef __cplusplus
}
#endif

#endif
