#pragma once
// What a job must leave as it was: the code, the variables and the stack of the kernel that called it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "softcell/dma/fault.h"
#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// While a job runs, nobody but the job can change these bytes of its caller. A caller whose bytes it has changed would fail later, and in
/// any way at all.
class JobCaller {
 public:
  /// Copies the variables and the stack of the kernel that calls a job now. The arguments must be valid until forget().
  /// @param linked        the image's bytes as they are in this local store
  /// @param local_store   its first byte
  /// @param frames_begin  local-store address: the part of the caller's stack from here on does not change before the job returns
  void remember(const KernelImage& image, std::span<const std::byte> linked, const std::byte* local_store,
                std::uint32_t frames_begin);
  void forget();

  /// Compares with what the local store holds now.
  /// @param checks_code  false with a debugger, which writes breakpoints into the code
  /// @return  the fault of a job that has changed something   @pre remember() was called, and since then not forget()
  std::optional<dma::Fault> damage(bool checks_code) const;

 private:
  std::span<const std::byte> variables() const;
  std::span<const std::byte> frames() const;

  const KernelImage* image_ = nullptr;  // null: no job is known to run
  std::span<const std::byte> linked_;
  const std::byte* local_store_ = nullptr;
  std::uint32_t frames_begin_ = 0;
  std::vector<std::byte> variables_before_, frames_before_;
};

}  // namespace softcell::ls_sim
