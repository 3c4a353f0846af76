#ifndef SOFTCELL_LIBSPE2_H
#define SOFTCELL_LIBSPE2_H
/* The SPE Runtime Management Library on a PC: SPE contexts for a program that was written for the Cell. Link it with
 * softcell::libspe2 (CMake) or `pkg-config --libs --static softcell-libspe2`.
 *
 * All functions may be called by any thread. Unless another result is given, a function returns 0 or a pointer, and
 * on an error -1 or NULL with errno set: ESRCH if the context, gang or handler does not exist (any more). Further values
 * of errno are in each function's comment. What a kernel does wrong, softcell also reports on standard error, with rule
 * and source line.
 * [SPE Runtime Management Library 2.2] documented */

#include <errno.h>
#include <stdio.h>

#include "libspe2-types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- contexts and gangs */

/* Makes a context. Each has its own local store and runs at the same time as all others, however many there are.
 * ENOMEM: 256 are in use, or the host has no memory. EINVAL: unknown flags. ENODEV: isolation is not supported.
 * EEXIST: a gang has one context with SPE_AFFINITY_MEMORY already. */
spe_context_ptr_t spe_context_create(unsigned int flags, spe_gang_context_ptr_t gang);

/* Like spe_context_create(). affinity_neighbor names a context of the same gang; its place has no effect on a PC.
 * EINVAL: no gang, or the neighbour belongs to another. EEXIST: the neighbour has two neighbours already. */
spe_context_ptr_t spe_context_create_affinity(unsigned int flags, spe_context_ptr_t affinity_neighbor,
                                              spe_gang_context_ptr_t gang);

/* EAGAIN: it runs. Threads that wait for its mailboxes return with ESRCH. */
int spe_context_destroy(spe_context_ptr_t spe);

/* flags: 0, else EINVAL. */
spe_gang_context_ptr_t spe_gang_context_create(unsigned int flags);

/* EAGAIN: it has contexts. */
int spe_gang_context_destroy(spe_gang_context_ptr_t gang);

/* ---- programs */

/* Opens an SPE program: an image that softcell_add_spu_kernel has made. errno is as open(2) sets
 * it, EFAULT for a null pointer, or ENOEXEC: the file is no such program; standard error says why. */
spe_program_handle_t* spe_image_open(const char* filename);

/* Contexts keep what they have loaded of it. EINVAL: it is not a handle of spe_image_open(). */
int spe_image_close(spe_program_handle_t* program);

/* Loads a program into the context's local store. EINVAL: the handle holds no program that can be loaded; the reason
 * is on standard error. EBUSY: the context runs. */
int spe_program_load(spe_context_ptr_t spe, spe_program_handle_t* program);

/* ---- running */

/* Runs the context until it stops, on a thread of softcell; the caller waits, and is the thread that callbacks run on.
 *
 * entry: in, SPE_DEFAULT_ENTRY to begin the program. Out, the address at which it would continue: pass it unchanged to
 * continue. argp, envp: the second and third argument of the program's main; the first is `spe`.
 *
 * Returns 0 when the program has ended, and the code of a stop-and-signal instruction when it has stopped. -1 with
 * errno EINVAL: a null entry, one where a program cannot begin, unknown flags, SPE_RUN_USER_REGS without argp. EBUSY:
 * the context runs. ENOEXEC: nothing was loaded. EIO: a command of the MFC broke a rule, which *stopinfo and standard
 * error say. EFAULT: the program halted, used an invalid instruction or channel, a callback failed or has no handler
 * (SPE_CALLBACK_ERROR, with -1), or softcell stopped the program at its deadline or for a broken rule. EAGAIN: the host
 * has no thread left. */
int spe_context_run(spe_context_ptr_t spe, unsigned int* entry, unsigned int runflags, void* argp, void* envp,
                    spe_stop_info_t* stopinfo);

/* Why the context stopped: the oldest stop that was not read yet; the last thousand are kept. ENOTSUP: the context was
 * made without SPE_EVENTS_ENABLE. EAGAIN: there is nothing to be read. EINVAL: a null pointer. */
int spe_stop_info_read(spe_context_ptr_t spe, spe_stop_info_t* stopinfo);

/* ---- events */

/* ENOMEM */
spe_event_handler_ptr_t spe_event_handler_create(void);

/* EAGAIN: a thread waits for its events. */
int spe_event_handler_destroy(spe_event_handler_ptr_t evhandler);

/* Events that are registered already get the new data. spe_event_wait() returns an event in each call as long as its
 * condition holds: until the mailbox was read or filled, the tag status or the stop information was read. EINVAL: a null
 * pointer, or no such context in it. ENOTSUP: unknown events, or a context made without SPE_EVENTS_ENABLE. */
int spe_event_handler_register(spe_event_handler_ptr_t evhandler, spe_event_unit_t* event);
int spe_event_handler_deregister(spe_event_handler_ptr_t evhandler, spe_event_unit_t* event);

/* Waits for events: one unit for each event of each context, max_events of them at most. timeout: milliseconds; -1 for
 * ever. Returns their number, 0 when the time is up. EINVAL: a null pointer, max_events below 1, timeout below -1. */
int spe_event_wait(spe_event_handler_ptr_t evhandler, spe_event_unit_t* events, int max_events, int timeout);

/* ---- the MFC's proxy commands: sizes and addresses as for the SPU's own commands; tag 0 to 31. EINVAL: a rule was
 * broken, which standard error says. */

int spe_mfcio_put(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                  unsigned int tid, unsigned int rid);
int spe_mfcio_putb(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid);
int spe_mfcio_putf(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid);
int spe_mfcio_get(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                  unsigned int tid, unsigned int rid);
int spe_mfcio_getb(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid);
int spe_mfcio_getf(spe_context_ptr_t spe, unsigned int ls, void* ea, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid);

/* The tags of `mask` without a command in flight. mask 0: all tags that have been used since the last call. behavior:
 * SPE_TAG_ALL and SPE_TAG_ANY wait, SPE_TAG_IMMEDIATE does not; else EINVAL, as for a null pointer. EIO: a command
 * could not move its bytes; standard error says why. */
int spe_mfcio_tag_status_read(spe_context_ptr_t spe, unsigned int mask, unsigned int behavior,
                              unsigned int* tag_status);

/* ---- mailboxes and signals: they return the number of values that were read or written. EINVAL: a null pointer, a
 * count below 1, an unknown behavior. */

int spe_out_mbox_read(spe_context_ptr_t spe, unsigned int* mbox_data, int count); /* does not wait */
int spe_out_mbox_status(spe_context_ptr_t spe); /* values to be read: 0, 1 */
int spe_in_mbox_write(spe_context_ptr_t spe, unsigned int* mbox_data, int count, unsigned int behavior);
int spe_in_mbox_status(spe_context_ptr_t spe); /* values that can be written: 0 to 4 */
int spe_out_intr_mbox_read(spe_context_ptr_t spe, unsigned int* mbox_data, int count, unsigned int behavior);
int spe_out_intr_mbox_status(spe_context_ptr_t spe); /* values to be read: 0, 1 */

/* Returns 0. EINVAL: signal_reg is neither SPE_SIG_NOTIFY_REG_1 nor SPE_SIG_NOTIFY_REG_2. */
int spe_signal_write(spe_context_ptr_t spe, unsigned int signal_reg, unsigned int data);

/* ---- multi-source synchronisation: commands of others into this local store count as complete as soon as their bytes
 * are there. The status is 0 when the last request is complete. */

int spe_mssync_start(spe_context_ptr_t spe);
int spe_mssync_status(spe_context_ptr_t spe);

/* ---- memory */

/* The local store, as a pointer that is also its effective address for other SPEs. */
void* spe_ls_area_get(spe_context_ptr_t spe);

/* 262144. */
int spe_ls_size_get(spe_context_ptr_t spe);

/* The registers of an area. EACCES: the context was made without SPE_MAP_PS. EINVAL: no such area. */
void* spe_ps_area_get(spe_context_ptr_t spe, enum ps_area area);

/* ---- calls of the PPU side by SPE programs: int handler(void* ls_base, unsigned int ls_address). At that
 * address of the local store is the word behind the stop: the operation in its upper 8 bits, and below them the local-store
 * address of the arguments. Any other result than 0 ends spe_context_run(). */

/* callnum: 4 to 255. EINVAL: it is above 255, the handler is null, the mode is unknown. EACCES: the number is below 4
 * (these belong to the C library and to softcell), or mode is SPE_CALLBACK_NEW and the number has a handler. ESRCH: mode
 * is SPE_CALLBACK_UPDATE and the number has no handler. */
int spe_callback_handler_register(void* handler, unsigned int callnum, unsigned int mode);

/* EINVAL: callnum is out of range. EACCES: it is below 4. ESRCH: it has no handler; spe_callback_handler_query() says so of
 * the numbers below 4, too, as no function of the PPU side stands behind them. */
int spe_callback_handler_deregister(unsigned int callnum);
void* spe_callback_handler_query(unsigned int callnum);

/* ---- the machine */

/* The number of what is asked for: SPE_COUNT_PHYSICAL_CPU_NODES 1, SPE_COUNT_PHYSICAL_SPES and SPE_COUNT_USABLE_SPES 6.
 * cpu_node: 0, or -1 for all. EINVAL: anything else. */
int spe_cpu_info_get(int info_requested, int cpu_node);

#ifdef __cplusplus
}
#endif

#endif
