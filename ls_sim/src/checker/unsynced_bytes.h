#pragma once
// The bytes of a local store that were written after the last `sync`, and the instructions that wrote them.
// The SPU may still execute the old values of these bytes.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// A bit for each byte and a writer for each quadword. mark() may be called by any thread, the rest by the
/// thread that runs the SPE.
class UnsyncedBytes {
 public:
  /// The writer is not an instruction of this SPE.
  static constexpr std::uint32_t kOutside = ~0u;

  /// @param writer  local-store address of the store or of the command's issue, or kOutside.
  void mark(std::uint32_t lsa, std::uint32_t bytes, std::uint32_t writer) {
    const std::uint32_t begin = std::min(lsa, dma::kLocalStoreBytes);
    const std::uint32_t end = begin + std::min(bytes, dma::kLocalStoreBytes - begin);
    for (std::uint32_t at = begin; at < end; at = (at / dma::kQuadwordBytes + 1) * dma::kQuadwordBytes) {
      const std::uint32_t offset = at % dma::kQuadwordBytes;
      const std::uint32_t count = std::min(end - at, dma::kQuadwordBytes - offset);
      Quadword& quadword = quadwords_[at / dma::kQuadwordBytes];
      quadword.writer.store(writer, kRelaxed);
      quadword.bytes.fetch_or(static_cast<std::uint16_t>(((1u << count) - 1) << offset), kRelaxed);
    }
  }

  bool contains(std::uint32_t lsa) const {
    return (quadword_at(lsa).bytes.load(kRelaxed) >> lsa % dma::kQuadwordBytes & 1) != 0;
  }

  /// The first unsynced byte in [begin, end), or `end`.
  std::uint32_t first_in(std::uint32_t begin, std::uint32_t end) const {
    SC_ASSERT(end <= dma::kLocalStoreBytes, "bytes {} to {} of a local store", begin, end);
    while (begin < end && !contains(begin)) ++begin;
    return begin;
  }

  /// The instruction that wrote last to the quadword of `lsa`. @pre contains(lsa)
  std::uint32_t writer_of(std::uint32_t lsa) const {
    SC_ASSERT(contains(lsa), "byte {} is in no unsynced range", lsa);
    return quadword_at(lsa).writer.load(kRelaxed);
  }

  /// A sync: the SPU executes the new values of all bytes from now on.
  void clear() {
    for (Quadword& quadword : quadwords_) quadword.bytes.store(0, kRelaxed);
  }

 private:
  static constexpr auto kRelaxed = std::memory_order_relaxed;

  struct Quadword {
    std::atomic<std::uint16_t> bytes{0};  ///< bit b: byte b
    std::atomic<std::uint32_t> writer{0};
  };
  const Quadword& quadword_at(std::uint32_t lsa) const {
    SC_ASSERT(lsa < dma::kLocalStoreBytes, "byte {} of a local store", lsa);
    return quadwords_[lsa / dma::kQuadwordBytes];
  }

  std::array<Quadword, dma::kLocalStoreBytes / dma::kQuadwordBytes> quadwords_{};
};

}  // namespace softcell::ls_sim
