#pragma once
// The 256 KB arena of one SPE on the host.

#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// 256 KB of readable, writable and executable memory. It is aligned to 256 KB, so that the low 18 bits of a
/// pointer into it are the local-store address. On both sides lie 256 KB of inaccessible pages, so that a
/// kernel that leaves the local store faults. Not copyable, not movable. Any thread may create one; its bytes
/// belong to the SPE that runs.
class LocalStore {
 public:
  static constexpr std::uint32_t kGuardBytes = dma::kLocalStoreBytes;

  /// @throws std::runtime_error  the host refuses such memory.
  LocalStore();
  ~LocalStore();
  LocalStore(const LocalStore&) = delete;
  LocalStore& operator=(const LocalStore&) = delete;

  std::span<std::byte> bytes() { return {base_, dma::kLocalStoreBytes}; }
  std::byte* base() { return base_; }

 private:
  void* mapping_ = nullptr;
  std::byte* base_ = nullptr;
};

}  // namespace softcell::ls_sim
