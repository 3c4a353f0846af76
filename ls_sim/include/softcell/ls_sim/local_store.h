#pragma once
// The 256 KB arena of one SPE on the host.

#include <cstddef>
#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// Loading an image sets all bytes of the local store that are not the image's to this value.
inline constexpr std::byte kFiller{0xA5};

/// 256 KB of readable, writable and executable memory, below 4 GB, so that a kernel's pointers have 32 bits as on an SPU. It is aligned to
/// 256 KB, so that the low 18 bits of a pointer into it are the local-store address. On both sides lie 256 KB of inaccessible pages, so
/// that a kernel that leaves the local store faults. Not copyable, not movable. Any thread may create one; its bytes belong to the SPE that
/// runs.
class LocalStore {
 public:
  static constexpr std::uint32_t kGuardBytes = dma::kLocalStoreBytes;

  /// @throws std::runtime_error  the host refuses such memory, or has no room for it below 4 GB.
  LocalStore() : LocalStore(nullptr) {}

  /// @param place  its address, in a range that the caller reserves for it and for the pages on both sides;
  ///               null: anywhere.
  explicit LocalStore(std::byte* place);
  ~LocalStore();
  LocalStore(const LocalStore&) = delete;
  LocalStore& operator=(const LocalStore&) = delete;

  std::span<std::byte> bytes() { return {base_, dma::kLocalStoreBytes}; }
  std::byte* base() { return base_; }

 private:
  void make_accessible();

  void* mapping_ = nullptr;  ///< null: the caller has reserved the addresses of `base_`
  std::byte* base_ = nullptr;
};

}  // namespace softcell::ls_sim
