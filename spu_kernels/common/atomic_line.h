#pragma once
// Atomic changes of one 128-byte line of main storage.
//
//   do {
//     load_and_reserve(&line, ea);
//     line.count += 1;
//   } while (!store_conditional(&line, ea));  // somebody else has changed the line: try again with its new content

#include <spu_mfcio.h>
#include <stdint.h>

namespace softcell::spu {

/// getllar: fetches the line at `ea` (a multiple of 128, as is the address of `line`) and reserves it for
/// this SPE until anybody writes to it.
inline void load_and_reserve(void* line, uint64_t ea) {
  mfc_getllar(line, ea, 0, 0);
  mfc_read_atomic_status();
}

/// putllc: stores the line if the reservation still exists. @return  whether it has stored the line
inline bool store_conditional(void* line, uint64_t ea) {
  mfc_putllc(line, ea, 0, 0);
  return (mfc_read_atomic_status() & MFC_PUTLLC_STATUS) == 0;
}

/// putlluc: stores the line unconditionally. Reservations of the line end.
inline void store_line(void* line, uint64_t ea) {
  mfc_putlluc(line, ea, 0, 0);
  mfc_read_atomic_status();
}

}  // namespace softcell::spu
