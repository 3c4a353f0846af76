#pragma once
// The bytes of a local store that were written after the last `sync`, and the instructions that wrote them.
// The SPU may still execute the old values of these bytes.

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
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
      quadword.bytes.fetch_or(static_cast<std::uint16_t>(((1u << count) - 1) << offset));
      // After its bytes: a clear() in between finds the block at the next sync.
      const std::uint32_t block = at / kBlockBytes;
      const std::uint64_t bit = std::uint64_t{1} << block % kBits;
      std::atomic<std::uint64_t>& marked = marked_blocks_[block / kBits];
      if ((marked.load() & bit) == 0) marked.fetch_or(bit);
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
    for (std::uint32_t i = 0; i < marked_blocks_.size(); ++i) {
      if (marked_blocks_[i].load(kRelaxed) == 0) continue;
      std::uint64_t marked = marked_blocks_[i].exchange(0);
      for (; marked != 0; marked &= marked - 1) clear_block(i * kBits + std::countr_zero(marked));
    }
  }

 private:
  static constexpr auto kRelaxed = std::memory_order_relaxed;
  /// A program that syncs often has written to few blocks since the last sync.
  static constexpr std::uint32_t kBlockBytes = 1024, kBits = 64;

  void clear_block(std::uint32_t block) {
    constexpr std::uint32_t kQuadwords = kBlockBytes / dma::kQuadwordBytes;
    for (std::uint32_t i = 0; i < kQuadwords; ++i)
      quadwords_[block * kQuadwords + i].bytes.store(0, kRelaxed);
  }

  struct Quadword {
    std::atomic<std::uint16_t> bytes{0};  ///< bit b: byte b
    std::atomic<std::uint32_t> writer{0};
  };
  const Quadword& quadword_at(std::uint32_t lsa) const {
    SC_ASSERT(lsa < dma::kLocalStoreBytes, "byte {} of a local store", lsa);
    return quadwords_[lsa / dma::kQuadwordBytes];
  }

  std::array<Quadword, dma::kLocalStoreBytes / dma::kQuadwordBytes> quadwords_{};
  std::array<std::atomic<std::uint64_t>, dma::kLocalStoreBytes / kBlockBytes / kBits> marked_blocks_{};
};

}  // namespace softcell::ls_sim
