#pragma once
// What the hardware reports of a broken rule. libspe2 and lv2 have codes of their own for it.

#include <cstdint>

#include "softcell/dma/fault.h"

namespace softcell::libspe2 {

enum class Cause : std::uint8_t {
  kDmaAlignment,
  kDmaCommand,
  kSegment,
  kStorage,
  kHalt,
  kInstruction,
  kChannel,
  kOnlySoftcell,  ///< none: only softcell notices
};

/// Without a default, so that the compiler finds a new rule that is not here.
constexpr Cause cause_of(dma::Rule rule) {
  using dma::Rule;
  switch (rule) {
    case Rule::kLsaAlignment:
    case Rule::kEaAlignment:
    case Rule::kLowBitsDiffer:
    case Rule::kListAddress:
    case Rule::kListElementAlignment:
    case Rule::kListElementSize:
    case Rule::kAtomicAlignment:
    case Rule::kSizeNotLegal:
      return Cause::kDmaAlignment;
    case Rule::kUnknownCommand:
    case Rule::kProxyFormOnly:
    case Rule::kNotOnProxyQueue:
    case Rule::kTagOutOfRange:
    case Rule::kSizeZero:
    case Rule::kLsaOutOfRange:
    case Rule::kListSize:
    case Rule::kSignalCommand:
      return Cause::kDmaCommand;
    case Rule::kEaNotMapped:
      return Cause::kSegment;
    case Rule::kEaNotReadable:
    case Rule::kEaNotWritable:
    case Rule::kEaOutsideAllocation:
    case Rule::kRegisterAccess:
      return Cause::kStorage;
    case Rule::kKernelHalt:
      return Cause::kHalt;
    case Rule::kIllegalInstruction:
      return Cause::kInstruction;
    case Rule::kIllegalChannel:
      return Cause::kChannel;
    case Rule::kListElementReservedBits:
    case Rule::kListCrosses4Gb:
    case Rule::kListStallAckTag:
    case Rule::kListStalledForEver:
    case Rule::kListStallNotExpected:
    case Rule::kAtomicStatusNotExpected:
    case Rule::kEaCrossesBuffer:
    case Rule::kVideoMemoryWrite:
    case Rule::kTagUpdateCondition:
    case Rule::kTagUpdatePending:
    case Rule::kTagStatusNotRequested:
    case Rule::kTagMaskEmpty:
    case Rule::kDeadlock:
    case Rule::kLoadInFlight:
    case Rule::kStoreInFlight:
    case Rule::kTransfersOverlap:
    case Rule::kListInFlight:
    case Rule::kLoadNeverWritten:
    case Rule::kPutNeverWritten:
    case Rule::kOutsideObjects:
    case Rule::kWriteToCode:
    case Rule::kCodeWithoutSync:
    case Rule::kCommandsOutstanding:
    case Rule::kTagWithoutCommand:
    case Rule::kAtomicStatusNotRead:
    case Rule::kReservationNotUsed:
    case Rule::kPutllcWithoutReservation:
    case Rule::kStackOverflow:
    case Rule::kEffectiveAddressAsPointer:
    case Rule::kOutsideLocalStore:
    case Rule::kStopZero:
    case Rule::kJumpOutsideCode:
    case Rule::kUninitialisedAddress:
    case Rule::kUninitialisedValue:
    case Rule::kStaleInstructions:
    case Rule::kDeadlineExceeded:
    case Rule::kImageNotLoadable:
    case Rule::kHostFailure:
      return Cause::kOnlySoftcell;
  }
  return Cause::kOnlySoftcell;
}

}  // namespace softcell::libspe2
