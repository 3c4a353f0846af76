#pragma once
// The bytes of a local store that have been written: a flag for each, and of some the bits.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// Used by the thread that runs the SPE, except for mark_external().
class WrittenBytes {
 public:
  /// Marks all bytes as not written, including those from outside.
  void clear() { set_all(0); }

  /// A new program begins: of these bytes, only what others wrote before its start counts as written.
  void forget_the_last_program(std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t lsa = begin; lsa < end; ++lsa)
      flags_[lsa].store(flags_[lsa].load(kRelaxed) & kFromOutside, kRelaxed);
  }

  void mark(std::uint32_t lsa, std::uint32_t bytes) { add(lsa, bytes, kByProgram); }

  /// The program has stored a byte. @param undefined  its bits that come from nowhere (interpreter/undefined_values.h)
  void mark_but(std::uint32_t lsa, std::uint8_t undefined) {
    if (undefined == 0) return mark(lsa, 1);
    const bool is_part = undefined != 0xFF;
    if (is_part) undefined_[lsa] = undefined;
    flags_[lsa].store(is_part ? kByProgram | kInPart : 0, kRelaxed);
  }
  /// The undefined bits of a byte.
  std::uint8_t undefined(std::uint32_t lsa) const {
    const std::uint8_t flags = flags_[lsa].load(kRelaxed);
    return flags == 0 ? 0xFF : (flags & kInPart) != 0 ? undefined_[lsa] : 0;
  }

  /// Any thread.
  void mark_external(std::uint32_t lsa, std::uint32_t bytes) { add(lsa, bytes, kFromOutside); }

  /// False when not one byte of the range was written.
  bool any(std::uint32_t lsa, std::uint32_t bytes) const {
    const auto [begin, end] = clip(lsa, bytes);
    for (std::uint32_t i = begin; i < end; ++i) {
      if (flags_[i].load(kRelaxed) != 0) return true;
    }
    return false;
  }

 private:
  static constexpr std::uint8_t kByProgram = 1, kFromOutside = 2, kInPart = 4;
  static constexpr auto kRelaxed = std::memory_order_relaxed;

  static std::pair<std::uint32_t, std::uint32_t> clip(std::uint32_t lsa, std::uint32_t bytes) {
    const std::uint32_t begin = std::min(lsa, dma::kLocalStoreBytes);
    return {begin, begin + std::min(bytes, dma::kLocalStoreBytes - begin)};
  }
  void set_all(std::uint8_t value) {
    for (auto& flags : flags_) flags.store(value, kRelaxed);
  }
  void add(std::uint32_t lsa, std::uint32_t bytes, std::uint8_t flag) {
    const auto [begin, end] = clip(lsa, bytes);
    for (std::uint32_t i = begin; i < end; ++i) {
      // Once set it stays, so that most of the time nothing has to be written.
      const std::uint8_t flags = flags_[i].load(kRelaxed);
      if ((flags & kInPart) != 0) flags_[i].fetch_and(static_cast<std::uint8_t>(~kInPart), kRelaxed);
      if ((flags & flag) == 0) flags_[i].fetch_or(flag, kRelaxed);
    }
  }

  std::array<std::atomic<std::uint8_t>, dma::kLocalStoreBytes> flags_{};
  std::array<std::uint8_t, dma::kLocalStoreBytes> undefined_{};  ///< of those that were written in part
};

}  // namespace softcell::ls_sim
