#pragma once
// How a thread of the PPU side shares words with SPEs: lwarx and stwcx., and what is usually built of them.
//
//   Atomics atomics(space);
//   const std::uint32_t ticket = atomics.fetch_add<std::uint32_t>(tickets.ea(), 1);

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "softcell/dma/address_space.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

template <class T>
concept AtomicWord = std::integral<T> &&(sizeof(T) == 4 || sizeof(T) == 8);

/// Atomic accesses to words of 4 and 8 bytes in main storage, indivisible to each other, to SPEs' line
/// commands and to their small gets and puts. The reservation is that of a line of 128 bytes, as an SPE's, so
/// that words which are fought for belong in lines of their own.
///
/// Plain accesses of the host, through a buffer's span, are seen by nobody: they lose no reservation. To read
/// a word that others change, use load(), or a std::atomic_ref.
///
/// One thread uses one object. Every address must be a multiple of the word's size within a buffer.
/// @throws std::invalid_argument  (all members) it is not.
/// @source  [PowerPC, lwarx and stwcx.; CBEA, atomic commands] documented
class Atomics {
 public:
  /// @throws std::runtime_error  the address space has no room for another holder of a reservation.
  explicit Atomics(AddressSpace& space);

  /// lwarx, ldarx: the word, and a reservation of its line in place of an earlier one.
  template <AtomicWord T>
  T load_and_reserve(EffectiveAddress ea) {
    T value;
    load_and_reserve(ea, &value, sizeof value);
    return value;
  }

  /// stwcx., stdcx.: stores if nobody has written to the line since it was reserved. The reservation is gone.
  /// @return  whether it stored.
  template <AtomicWord T>
  bool store_conditional(EffectiveAddress ea, T value) {
    return store_conditional(ea, &value, sizeof value);
  }

  template <AtomicWord T>
  T load(EffectiveAddress ea) {
    T value;
    load(ea, &value, sizeof value);
    return value;
  }

  template <AtomicWord T>
  void store(EffectiveAddress ea, T value) {
    store(ea, &value, sizeof value);
  }

  /// Replaces the word by change(word), which may be called several times. @return  the word before.
  template <AtomicWord T, std::invocable<T> Change>
  T update(EffectiveAddress ea, Change&& change) {
    for (;;) {
      const T before = load_and_reserve<T>(ea);
      if (store_conditional<T>(ea, change(before))) return before;
    }
  }

  /// @return  the word before. Wraps around.
  template <AtomicWord T>
  T fetch_add(EffectiveAddress ea, T addend) {
    using Unsigned = std::make_unsigned_t<T>;
    return update<T>(ea, [addend](T before) {
      return static_cast<T>(static_cast<Unsigned>(before) + static_cast<Unsigned>(addend));
    });
  }

  /// @return  the word before.
  template <AtomicWord T>
  T exchange(EffectiveAddress ea, T value) {
    return update<T>(ea, [value](T) { return value; });
  }

  /// Stores `desired` if the word is `expected`.
  /// @return  the word before: `expected` when it stored.
  template <AtomicWord T>
  T compare_and_swap(EffectiveAddress ea, T expected, T desired) {
    for (;;) {
      const T before = load_and_reserve<T>(ea);
      if (before != expected || store_conditional<T>(ea, desired)) return before;
    }
  }

 private:
  void load_and_reserve(EffectiveAddress ea, void* to, std::uint32_t bytes);
  bool store_conditional(EffectiveAddress ea, const void* from, std::uint32_t bytes);
  void load(EffectiveAddress ea, void* to, std::uint32_t bytes);
  void store(EffectiveAddress ea, const void* from, std::uint32_t bytes);

  std::byte* host_of(EffectiveAddress ea, std::uint32_t bytes);

  Reservations& reservations_;
  TranslationCache translation_;
  ReservationHolder holder_;
};

}  // namespace softcell::dma
