#pragma once
// Who wants to know when commands come and go.

#include <cstdint>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// Called by the thread that runs the MFC. Must not call the MFC.
class MfcObserver {
 public:
  virtual ~MfcObserver() = default;

  /// A legal command has come, immediate ones too.
  /// @param number  of this MFC's commands, from 1 up.
  /// @param bytes   that it moves, of a list the sum of its elements.
  virtual void on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) = 0;

  /// All its bytes have moved.
  virtual void on_complete(std::uint64_t number) = 0;

  /// In place of `on_complete`: a putllc that found its reservation lost. Nothing has moved.
  virtual void on_reservation_lost(std::uint64_t number) = 0;
};

}  // namespace softcell::dma
