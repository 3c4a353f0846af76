#pragma once
// The blocks of a program's heap, as its C library reports them.

#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// Used by the thread that runs the SPE.
class HeapBlocks {
 public:
  void clear() { blocks_.clear(); }

  /// The program has got a block, which takes whole quadwords.
  void add(std::uint32_t lsa, std::uint32_t bytes) {
    const auto whole = static_cast<std::uint32_t>(dma::round_up_to_quadword(bytes));
    SC_ASSERT(whole != 0, "a block of the heap at {} has no bytes", lsa);
    // Forgets freed blocks in whose place it lies.
    auto at = blocks_.lower_bound(lsa);
    if (at != blocks_.begin() && end_of(*std::prev(at)) > lsa) --at;
    while (at != blocks_.end() && at->first < lsa + whole) at = blocks_.erase(at);
    blocks_.emplace(lsa, Block{bytes, whole, true});
  }

  /// The bytes of the block in use that begins there; 0: none does.
  std::uint32_t bytes_at(std::uint32_t lsa) const {
    const auto found = blocks_.find(lsa);
    return found == blocks_.end() || !found->second.is_live ? 0 : found->second.bytes;
  }

  /// The program frees the block that begins at an address. @return  a sentence that says what is wrong with that; empty: nothing
  std::string end(std::uint32_t lsa) {
    const auto found = blocks_.find(lsa);
    if (found == blocks_.end()) return "no block of the heap begins there";
    if (!found->second.is_live) return "the block was freed before";
    found->second.is_live = false;
    return {};
  }

  /// Empty if the range lies in one block; else a sentence that says what is wrong. A program without blocks has a heap of its own.
  std::string trespass(std::uint32_t lsa, std::uint32_t bytes) const {
    if (blocks_.empty()) return {};
    const auto above = blocks_.upper_bound(lsa);
    if (above == blocks_.begin()) return "it lies before the blocks of the heap";
    const auto& [begin, block] = *std::prev(above);
    const std::string size = std::to_string(block.bytes) + " bytes";
    if (lsa < begin + block.whole && !block.is_live)
      return "it lies in a block of " + size + " that was freed";
    if (lsa + bytes <= begin + block.whole) return {};
    return lsa < begin + block.whole ? "it passes the end of a block of " + size
                                     : "it lies behind a block of " + size;
  }

 private:
  struct Block {
    std::uint32_t bytes = 0, whole = 0;
    bool is_live = false;
  };
  static std::uint32_t end_of(const std::pair<const std::uint32_t, Block>& block) {
    return block.first + block.second.whole;
  }

  /// Blocks by address. Those that were freed stay until others take their place.
  std::map<std::uint32_t, Block> blocks_;
};

}  // namespace softcell::ls_sim
