#pragma once
// Channels, stop, barriers, and what a host kernel cannot have.  [LEXT, channel control and control
// intrinsics] documented
//
// Channel numbers are constants in the instruction: these are macros, as in a real SPU compiler's headers.

#include "../shared/softcell_channels.h"
#include "softcell_environment.h"
#include "softcell_lanes.h"

namespace softcell_sdk {

constexpr bool is_channel(long long number) { return number >= 0 && number <= 127; }

template <int Channel>
SC_SDK_INLINE unsigned int read_channel() {
  static_assert(is_channel(Channel), "channels are numbered 0 to 127");
  return call_gate(kRead, Channel, 0);
}
template <int Channel>
SC_SDK_INLINE unsigned int read_channel_count() {
  static_assert(is_channel(Channel), "channels are numbered 0 to 127");
  return call_gate(kCount, Channel, 0);
}
/// The five parameters of a DMA command and the tag mask wait in the environment for the command and the tag
/// update; all else is a call.
template <int Channel>
SC_SDK_INLINE void write_channel(unsigned int value) {
  static_assert(is_channel(Channel), "channels are numbered 0 to 127");
  if constexpr (Channel == MFC_LSA) {
    environment().mfc_lsa = value;
  } else if constexpr (Channel == MFC_EAH) {
    environment().mfc_eah = value;
  } else if constexpr (Channel == MFC_EAL) {
    environment().mfc_eal = value;
  } else if constexpr (Channel == MFC_Size) {
    environment().mfc_size = value;
  } else if constexpr (Channel == MFC_TagID) {
    environment().mfc_tag = value;
  } else if constexpr (Channel == MFC_WrTagMask) {
    environment().mfc_tag_mask = value;
  } else {
    call_gate(kWrite, Channel, value);
  }
}

/// A write to MFC_WrTagUpdate and a read of MFC_RdTagStat.
SC_SDK_INLINE unsigned int tag_status(unsigned int condition) { return call_gate(kTagStatus, 0, condition); }

template <int Code>
SC_SDK_INLINE void stop() {
  static_assert(Code >= 0 && Code <= 0x3FFF, "a stop code has 14 bits");
  call_gate(kStop, 0, Code);
}

/// Order of memory accesses and channels: the compiler must not move one across. The emulator does the rest
/// in order anyway.
SC_SDK_INLINE void barrier() { asm volatile("" ::: "memory"); }

/// What the kernel has written or fetched so far is what it executes from here on.
SC_SDK_INLINE void sync() { call_gate(kSync, 0, 0); }

// What compiles on an SPU and has no meaning for a job on the host is refused where it is used, with the
// reason.

template <class>
inline constexpr bool kNever = false;

template <class T_ = void>
SC_SDK_INLINE vec_uint4 no_fpscr() {
  static_assert(
      kNever<T_>,
      "FPSCR is not modelled on the host: spu_* of doubles round to nearest, and there are no sticky flags");
  return {};
}
template <class T_ = void>
SC_SDK_INLINE unsigned int no_special_register() {
  static_assert(kNever<T_>, "special purpose registers are not modelled on the host");
  return 0;
}
template <class T_ = void>
SC_SDK_INLINE void no_interrupts() {
  static_assert(kNever<T_>, "interrupts are not modelled on the host: wait on SPU_RdEventStat instead");
}

}  // namespace softcell_sdk

/// Reads a channel; blocks until there is something to read.
#define spu_readch(channel) (softcell_sdk::read_channel<(channel)>())
#define spu_readchqw(channel) (vec_uint4(softcell_sdk::read_channel<(channel)>(), 0))
/// How many reads or writes go without blocking.
#define spu_readchcnt(channel) (softcell_sdk::read_channel_count<(channel)>())
#define spu_writech(channel, value) (softcell_sdk::write_channel<(channel)>(value))
#define spu_writechqw(channel, value) (softcell_sdk::write_channel<(channel)>(vec_uint4(value).raw[0]))

/// Stops the SPU with a constant code of 14 bits: 0x2000 + status ends the program. On the host it is never
/// started again.
#define spu_stop(code) (softcell_sdk::stop<(code)>())

#define spu_sync() (softcell_sdk::sync())
#define spu_sync_c() (softcell_sdk::sync())
#define spu_dsync() (softcell_sdk::barrier())

/// No interrupt ever reaches a job on the host: off is what they are.
#define spu_idisable() (softcell_sdk::barrier())
#define spu_ienable() (softcell_sdk::no_interrupts<>())

#define spu_mffpscr() (softcell_sdk::no_fpscr<>())
#define spu_mtfpscr(value) (static_cast<void>(value), softcell_sdk::no_fpscr<>())
#define spu_mfspr(number) (softcell_sdk::no_special_register<>())
#define spu_mtspr(number, value) (static_cast<void>(value), softcell_sdk::no_special_register<>())

/// Promises that the pointer less `offset` is a multiple of `base` bytes. Nothing comes of it here.
#define __align_hint(pointer, base, offset) (static_cast<void>(pointer))
