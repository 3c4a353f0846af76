// transfers: moves the same memory again and again. `softcell bench` uses it to measure the MFC, and, with
// argp 0, at which it returns at once, to measure how long the dispatch of a job takes.
//
//   array   direction   element             count        alignment
//   job     in          TransfersJob        1            128
//   memory  in or out   bytes of a command  in_flight    128
//
//   issue in_flight commands, one behind the other in memory and in local store; wait; again
//
// Budget: 68 KB. Buffer 64 KB, under 1 KB of code, 1 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "transfers_job.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagJob = 0, kTagMemory = 1 };

// More would only wait at the queue. [CBEA, MFC SPU command queue] documented
constexpr uint32_t kQueueSlots = 16;

struct alignas(128) LocalStoreMap {
  TransfersJob job;
  alignas(128) char buffer[kTransfersBufferBytes];
};
LocalStoreMap ls;

void issue(uint32_t commands) {
  char* local = ls.buffer;
  uint64_t ea = ls.job.ea;
  for (; commands != 0; --commands) {
    if (ls.job.direction == kTransferGet) {
      mfc_get(local, ea, ls.job.bytes, kTagMemory, 0, 0);
    } else {
      mfc_put(local, ea, ls.job.bytes, kTagMemory, 0, 0);
    }
    local += ls.job.bytes;
    ea += ls.job.bytes;
  }
}

}  // namespace
}  // namespace softcell::spu

int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  if (argp == 0) return kTransfersDone;
  mfc_get(&ls.job, argp, sizeof ls.job, kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  const uint32_t in_flight = ls.job.in_flight;
  if (in_flight == 0 || in_flight > kQueueSlots || ls.job.bytes > kTransfersBufferBytes / in_flight) {
    return kTransfersTooManyInFlight;
  }
  for (uint32_t left = ls.job.count; left != 0;) {
    const uint32_t now = left < in_flight ? left : in_flight;
    issue(now);
    wait_for_tag(kTagMemory);
    left -= now;
  }
  return kTransfersDone;
}
