#pragma once
// Atomic words that threads of the PPU side share with SPEs: lwarx and stwcx., and the usual operations built
// on them.
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

/// Atomic accesses to words of 4 and 8 bytes in main storage. They are atomic with respect to each other, to
/// the line commands of SPEs (getllar, putllc, ...) and to gets and puts of up to one line. A reservation
/// covers a line of 128 bytes, as an SPE's does: give words that many threads change lines of their own.
///
/// A plain write through a buffer's span cancels no reservation. To read a word that others change, use
/// load() or a std::atomic_ref.
///
/// One thread uses one object. Every address must lie in a buffer and be a multiple of the word's size.
/// @throws std::invalid_argument  (all members) the address breaks this.
/// @source  [PowerPC, lwarx and stwcx.; CBEA, atomic commands] documented
class Atomics {
 public:
  /// @throws std::runtime_error  Reservations::kMaxHolders MFCs, job chains and Atomics use this address space already.
  explicit Atomics(AddressSpace& space);

  /// lwarx, ldarx: reads the word and reserves its line. An earlier reservation of this object ends.
  template <AtomicWord T>
  T load_and_reserve(EffectiveAddress ea) {
    T value;
    load_and_reserve(ea, &value, sizeof value);
    return value;
  }

  /// stwcx., stdcx.: stores if nobody has written to the line since this object reserved it. Ends the
  /// reservation.
  /// @return  true if it stored.
  template <AtomicWord T>
  bool store_conditional(EffectiveAddress ea, T value) {
    return store_conditional(ea, &value, sizeof value);
  }

  /// Reads the word in one access.
  template <AtomicWord T>
  T load(EffectiveAddress ea) {
    T value;
    load(ea, &value, sizeof value);
    return value;
  }

  /// Writes the word in one access, and cancels the reservations of its line.
  template <AtomicWord T>
  void store(EffectiveAddress ea, T value) {
    store(ea, &value, sizeof value);
  }

  /// Replaces the word by change(word). May call `change` several times. @return  the old word.
  template <AtomicWord T, std::invocable<T> Change>
  T update(EffectiveAddress ea, Change&& change) {
    for (;;) {
      const T before = load_and_reserve<T>(ea);
      if (store_conditional<T>(ea, change(before))) return before;
    }
  }

  /// Adds `addend`. @return  the old word. The sum wraps around.
  template <AtomicWord T>
  T fetch_add(EffectiveAddress ea, T addend) {
    using Unsigned = std::make_unsigned_t<T>;
    return update<T>(ea, [addend](T before) {
      return static_cast<T>(static_cast<Unsigned>(before) + static_cast<Unsigned>(addend));
    });
  }

  /// Stores `value`. @return  the old word.
  template <AtomicWord T>
  T exchange(EffectiveAddress ea, T value) {
    return update<T>(ea, [value](T) { return value; });
  }

  /// Stores `desired` if the word is `expected`.
  /// @return  the old word; equal to `expected` if it stored.
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
