#pragma once
// A signal notification register: a word that others write and the SPU reads once.

#include <cstdint>
#include <optional>
#include <utility>

#include "softcell/ls_sim/spe_group.h"

namespace softcell::ls_sim {

/// Not thread safe: guarded by the SPEs' monitor. [CBEA, signal notification] documented
class SignalRegister {
 public:
  void set_mode(SignalMode mode) { mode_ = mode; }

  /// The reads that would not wait: 1 when something was written since the last read, even 0.
  std::uint32_t count() const { return is_set_ ? 1 : 0; }

  /// A value that was not read yet is kept in OR mode, combined with the new one, and lost in overwrite mode.
  void write(std::uint32_t value) {
    value_ = mode_ == SignalMode::kOr && is_set_ ? value_ | value : value;
    is_set_ = true;
  }

  /// The value, which is cleared; nothing when there is none.
  std::optional<std::uint32_t> read() {
    if (!std::exchange(is_set_, false)) return std::nullopt;
    return value_;
  }

 private:
  SignalMode mode_ = SignalMode::kOverwrite;
  bool is_set_ = false;
  std::uint32_t value_ = 0;
};

}  // namespace softcell::ls_sim
