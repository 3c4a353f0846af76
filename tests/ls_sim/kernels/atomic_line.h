#pragma once
// A line of main storage that several processors share, by reservations.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(128) AtomicLine {
  volatile uint32_t words[32];

  void reserve(uint64_t ea) {
    mfc_getllar(words, ea, 0, 0);
    mfc_read_atomic_status();
  }

  /// Stores the line if nobody has written to it since reserve().
  bool store(uint64_t ea) {
    mfc_putllc(words, ea, 0, 0);
    return (mfc_read_atomic_status() & MFC_PUTLLC_STATUS) == 0;
  }
};
