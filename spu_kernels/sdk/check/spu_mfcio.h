#pragma once
// What a real SPU toolchain knows as <spu_mfcio.h>: declarations only. [LEXT, MFC input and output]
// documented
//
// A local store address is any pointer to what is not const, an effective address any number or pointer.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "../shared/softcell_mfc_constants.h"

/// One element of a list command; eight bytes, in local store, aligned to eight.
typedef struct mfc_list_element {
  uint64_t notify : 1;  ///< stall behind this element until it is acknowledged
  uint64_t reserved : 16;
  uint64_t size : 15;  ///< bytes, up to 16384
  uint64_t eal : 32;   ///< low half of the effective address
} mfc_list_element_t;

// clang-format off

namespace softcell_check {

void transfer(volatile void* ls, unsigned long long ea, unsigned int size, unsigned int tag, unsigned int tid, unsigned int rid);
void list_transfer(volatile void* ls, unsigned long long ea, unsigned int list, unsigned int size, unsigned int tag,
                   unsigned int tid, unsigned int rid);
void line(volatile void* ls, unsigned long long ea, unsigned int tid, unsigned int rid);
void queued_line(volatile void* ls, unsigned long long ea, unsigned int tag, unsigned int tid, unsigned int rid);
void signal(volatile void* ls, unsigned long long ea, unsigned int tag, unsigned int tid, unsigned int rid);
void storage_control(unsigned long long ea, unsigned int size, unsigned int tag, unsigned int tid, unsigned int rid);
void order(unsigned int tag);
void order(unsigned int tag, unsigned int tid, unsigned int rid);
unsigned int read();
unsigned int count();
void write(unsigned int);
unsigned int ea_half(unsigned long long);
unsigned long long ea_of_halves(unsigned int high, unsigned int low);
unsigned int tag_reserve();
unsigned int tag_release(unsigned int tag);
unsigned int multi_tag_reserve(unsigned int count);
unsigned int multi_tag_release(unsigned int first, unsigned int count);

}  // namespace softcell_check

// Effective addresses
#define SC_EA(ea)       ((unsigned long long)(ea))
#define mfc_ea2h(ea)    ::softcell_check::ea_half(SC_EA(ea))
#define mfc_ea2l(ea)    ::softcell_check::ea_half(SC_EA(ea))
#define mfc_hl2ea(h, l) ::softcell_check::ea_of_halves(h, l)

// Transfers
#define SC_TRANSFER(ls, ea, size, tag, tid, rid)  ::softcell_check::transfer(ls, SC_EA(ea), size, tag, tid, rid)
#define mfc_get(ls, ea, size, tag, tid, rid)      SC_TRANSFER(ls, ea, size, tag, tid, rid)
#define mfc_getf(ls, ea, size, tag, tid, rid)     SC_TRANSFER(ls, ea, size, tag, tid, rid)
#define mfc_getb(ls, ea, size, tag, tid, rid)     SC_TRANSFER(ls, ea, size, tag, tid, rid)
#define mfc_put(ls, ea, size, tag, tid, rid)      SC_TRANSFER(ls, ea, size, tag, tid, rid)
#define mfc_putf(ls, ea, size, tag, tid, rid)     SC_TRANSFER(ls, ea, size, tag, tid, rid)
#define mfc_putb(ls, ea, size, tag, tid, rid)     SC_TRANSFER(ls, ea, size, tag, tid, rid)

#define SC_LIST(ls, ea, list, size, tag, tid, rid) \
  ::softcell_check::list_transfer(ls, SC_EA(ea), (unsigned int)(uintptr_t)(list), size, tag, tid, rid)
#define mfc_getl(ls, ea, list, size, tag, tid, rid)   SC_LIST(ls, ea, list, size, tag, tid, rid)
#define mfc_getlf(ls, ea, list, size, tag, tid, rid)  SC_LIST(ls, ea, list, size, tag, tid, rid)
#define mfc_getlb(ls, ea, list, size, tag, tid, rid)  SC_LIST(ls, ea, list, size, tag, tid, rid)
#define mfc_putl(ls, ea, list, size, tag, tid, rid)   SC_LIST(ls, ea, list, size, tag, tid, rid)
#define mfc_putlf(ls, ea, list, size, tag, tid, rid)  SC_LIST(ls, ea, list, size, tag, tid, rid)
#define mfc_putlb(ls, ea, list, size, tag, tid, rid)  SC_LIST(ls, ea, list, size, tag, tid, rid)

// Atomic lines, signals, order, caches
#define mfc_getllar(ls, ea, tid, rid)            ::softcell_check::line(ls, SC_EA(ea), tid, rid)
#define mfc_putllc(ls, ea, tid, rid)             ::softcell_check::line(ls, SC_EA(ea), tid, rid)
#define mfc_putlluc(ls, ea, tid, rid)            ::softcell_check::line(ls, SC_EA(ea), tid, rid)
#define mfc_putqlluc(ls, ea, tag, tid, rid)      ::softcell_check::queued_line(ls, SC_EA(ea), tag, tid, rid)
#define mfc_sndsig(ls, ea, tag, tid, rid)        ::softcell_check::signal(ls, SC_EA(ea), tag, tid, rid)
#define mfc_sndsigf(ls, ea, tag, tid, rid)       ::softcell_check::signal(ls, SC_EA(ea), tag, tid, rid)
#define mfc_sndsigb(ls, ea, tag, tid, rid)       ::softcell_check::signal(ls, SC_EA(ea), tag, tid, rid)
#define mfc_barrier(tag)                         ::softcell_check::order(tag)
#define mfc_sync(tag)                            ::softcell_check::order(tag)
#define mfc_eieio(tag, tid, rid)                 ::softcell_check::order(tag, tid, rid)
#define mfc_sdcrt(ea, size, tag, tid, rid)       ::softcell_check::storage_control(SC_EA(ea), size, tag, tid, rid)
#define mfc_sdcrtst(ea, size, tag, tid, rid)     ::softcell_check::storage_control(SC_EA(ea), size, tag, tid, rid)
#define mfc_sdcrz(ea, size, tag, tid, rid)       ::softcell_check::storage_control(SC_EA(ea), size, tag, tid, rid)
#define mfc_sdcrst(ea, size, tag, tid, rid)      ::softcell_check::storage_control(SC_EA(ea), size, tag, tid, rid)
#define mfc_sdcrf(ea, size, tag, tid, rid)       ::softcell_check::storage_control(SC_EA(ea), size, tag, tid, rid)

// Tags, lists, atomics: status
#define mfc_stat_cmd_queue()                 ::softcell_check::count()
#define mfc_write_tag_mask(mask)             ::softcell_check::write(mask)
#define mfc_read_tag_mask()                  ::softcell_check::read()
#define mfc_write_tag_update(condition)      ::softcell_check::write(condition)
#define mfc_write_tag_update_immediate()     ::softcell_check::write(MFC_TAG_UPDATE_IMMEDIATE)
#define mfc_write_tag_update_any()           ::softcell_check::write(MFC_TAG_UPDATE_ANY)
#define mfc_write_tag_update_all()           ::softcell_check::write(MFC_TAG_UPDATE_ALL)
#define mfc_stat_tag_update()                ::softcell_check::count()
#define mfc_read_tag_status()                ::softcell_check::read()
#define mfc_read_tag_status_immediate()      ::softcell_check::read()
#define mfc_read_tag_status_any()            ::softcell_check::read()
#define mfc_read_tag_status_all()            ::softcell_check::read()
#define mfc_stat_tag_status()                ::softcell_check::count()
#define mfc_read_list_stall_status()         ::softcell_check::read()
#define mfc_stat_list_stall_status()         ::softcell_check::count()
#define mfc_write_list_stall_ack(tag)        ::softcell_check::write(tag)
#define mfc_read_atomic_status()             ::softcell_check::read()
#define mfc_stat_atomic_status()             ::softcell_check::count()
#define mfc_write_multi_src_sync_request()   ::softcell_check::write(0)
#define mfc_stat_multi_src_sync_request()    ::softcell_check::count()

// Signals, mailboxes, decrementer, events, machine state
#define spu_read_signal1()            ::softcell_check::read()
#define spu_stat_signal1()            ::softcell_check::count()
#define spu_read_signal2()            ::softcell_check::read()
#define spu_stat_signal2()            ::softcell_check::count()
#define spu_read_in_mbox()            ::softcell_check::read()
#define spu_stat_in_mbox()            ::softcell_check::count()
#define spu_write_out_mbox(a)         ::softcell_check::write(a)
#define spu_stat_out_mbox()           ::softcell_check::count()
#define spu_write_out_intr_mbox(a)    ::softcell_check::write(a)
#define spu_stat_out_intr_mbox()      ::softcell_check::count()
#define spu_read_decrementer()        ::softcell_check::read()
#define spu_write_decrementer(count)  ::softcell_check::write(count)
#define spu_read_event_status()       ::softcell_check::read()
#define spu_stat_event_status()       ::softcell_check::count()
#define spu_write_event_mask(mask)    ::softcell_check::write(mask)
#define spu_write_event_ack(mask)     ::softcell_check::write(mask)
#define spu_read_event_mask()         ::softcell_check::read()
#define spu_read_machine_status()     ::softcell_check::read()
#define spu_write_srr0(address)       ::softcell_check::write(address)
#define spu_read_srr0()               ::softcell_check::read()

// Critical sections are functions on a real toolchain as well.
unsigned int mfc_begin_critical_section();
void mfc_end_critical_section(unsigned int status);

// Tag manager
#define mfc_tag_reserve()                    ::softcell_check::tag_reserve()
#define mfc_tag_release(tag)                 ::softcell_check::tag_release(tag)
#define mfc_multi_tag_reserve(count)         ::softcell_check::multi_tag_reserve(count)
#define mfc_multi_tag_release(first, count)  ::softcell_check::multi_tag_release(first, count)
// clang-format on
