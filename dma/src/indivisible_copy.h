#pragma once
// Copies whose units arrive whole for every observer: a kernel that polls its local store, a PPU thread with a
// std::atomic_ref, another SPE's DMA.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "softcell/base/sanitizers.h"
#include "softcell/dma/local_store_bytes.h"

namespace softcell::dma {

#if SC_THREAD_SANITIZER
// The sanitizer's own accesses of 16 bytes: as builtins, the compilers know atomic ones of up to 8.
__extension__ typedef unsigned __int128 TsanQuadword;
extern "C" TsanQuadword __tsan_atomic128_load(const volatile void* from, int order);
extern "C" void __tsan_atomic128_store(volatile void* to, TsanQuadword value, int order);
extern "C" int __tsan_atomic128_compare_exchange_strong(volatile void* to, void* expected, TsanQuadword value,
                                                        int success, int failure);
#endif

template <class Unit>
void copy_unit(std::byte* to, const std::byte* from) {
  using Aliased [[gnu::may_alias]] = Unit;
  const Unit value = __atomic_load_n(reinterpret_cast<const Aliased*>(from), __ATOMIC_ACQUIRE);
  __atomic_store_n(reinterpret_cast<Aliased*>(to), value, __ATOMIC_RELEASE);
}

/// An aligned access of 16 bytes is indivisible on every x86 with AVX, and ordered as all others. The
/// volatile keeps the compiler from cutting it or making a memcpy of a loop.
inline void copy_quadword(std::byte* to, const std::byte* from) {
#if SC_THREAD_SANITIZER
  __tsan_atomic128_store(to, __tsan_atomic128_load(from, __ATOMIC_ACQUIRE), __ATOMIC_RELEASE);
#else
  typedef long long Quadword __attribute__((vector_size(16), may_alias));
  *reinterpret_cast<volatile Quadword*>(to) = *reinterpret_cast<const volatile Quadword*>(from);
#endif
}

/// Stores the quadword `value` at `to` if `expected` is there, in one access. All are multiples of 16.
/// @return  whether it did.
inline bool exchange_quadword(std::byte* to, const std::byte* expected, const std::byte* value) {
#if SC_THREAD_SANITIZER
  TsanQuadword old_value = 0, new_value = 0;
  std::memcpy(&old_value, expected, sizeof old_value);
  std::memcpy(&new_value, value, sizeof new_value);
  return __tsan_atomic128_compare_exchange_strong(to, &old_value, new_value, __ATOMIC_ACQ_REL,
                                                  __ATOMIC_ACQUIRE) != 0;
#else
  // The compilers' builtin needs an option for the whole file, or a library.
  std::uint64_t old_value[2], new_value[2];
  std::memcpy(old_value, expected, sizeof old_value);
  std::memcpy(new_value, value, sizeof new_value);
  bool done;
  asm volatile("lock cmpxchg16b %[to]"
               : [to] "+m"(*reinterpret_cast<volatile std::byte(*)[16]>(to)), "+a"(old_value[0]),
                 "+d"(old_value[1]), "=@ccz"(done)
               : "b"(new_value[0]), "c"(new_value[1])
               : "memory");
  return done;
#endif
}

/// Copies 1, 2, 4 or 8 bytes in one access, multiples of 16 by quadwords, each when both addresses are
/// multiples of the unit, as every legal DMA command's are; anything else byte by byte as far as anybody can
/// tell. The ranges may overlap; then what arrives is not specified.
inline void copy_indivisibly(std::byte* to, const std::byte* from, std::uint32_t bytes) {
  const auto addresses = reinterpret_cast<std::uintptr_t>(to) | reinterpret_cast<std::uintptr_t>(from);
  if ((addresses | bytes) % 16 == 0) {
    for (std::uint32_t at = 0; at < bytes; at += 16) copy_quadword(to + at, from + at);
    return;
  }
  const bool aligned = (addresses & (bytes - 1)) == 0;
  if (bytes == 4 && aligned) return copy_unit<std::uint32_t>(to, from);
  if (bytes == 8 && aligned) return copy_unit<std::uint64_t>(to, from);
  if (bytes == 2 && aligned) return copy_unit<std::uint16_t>(to, from);
  if (bytes == 1) return copy_unit<std::uint8_t>(to, from);
  copy_to_local_store(to, from, bytes);
}

}  // namespace softcell::dma
