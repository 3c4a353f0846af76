#pragma once
// The interface of an observer of an MFC's commands.

#include <cstdint>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// Called by the thread that runs the MFC. Must not call the MFC.
class MfcObserver {
 public:
  virtual ~MfcObserver() = default;

  /// The MFC has accepted a command.
  /// @param number  counts the commands of this MFC, from 1.
  /// @param bytes   bytes that the command moves; for a list, the sum over its elements.
  virtual void on_issue(std::uint64_t number, const MfcCommand& command, std::uint64_t bytes) = 0;

  /// All bytes of the command have moved.
  virtual void on_complete(std::uint64_t number) = 0;

  /// Called instead of `on_complete` for a putllc whose reservation was lost. Nothing has moved.
  virtual void on_reservation_lost(std::uint64_t number) = 0;
};

}  // namespace softcell::dma
