#pragma once
// The contract of the kernel `transfers`.

#include <stdint.h>

namespace softcell::spu {

enum TransferDirection : uint32_t { kTransferGet = 0, kTransferPut = 1 };

/// The job's descriptor, one line in main memory.
struct alignas(128) TransfersJob {
  uint64_t ea;         ///< of the memory to move, 128-byte aligned; `bytes` for each of `in_flight` commands
  uint32_t bytes;      ///< of one command: a legal size of 16..16384
  uint32_t count;      ///< commands in all
  uint32_t in_flight;  ///< commands between two waits, 1..16, with at most kTransfersBufferBytes in all
  uint32_t direction;  ///< a TransferDirection
  uint32_t pad[26];
};
static_assert(sizeof(TransfersJob) == 128, "one line");

constexpr uint32_t kTransfersBufferBytes = 64 * 1024;

/// What the kernel's main returns.
enum TransfersStatus : uint32_t { kTransfersDone = 0, kTransfersTooManyInFlight = 1 };

}  // namespace softcell::spu
