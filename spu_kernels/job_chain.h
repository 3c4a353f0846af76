#pragma once
// Job chains: plain data in main memory. The PPU side writes them and the kernel `job_loop` runs their jobs;
// both see the same bytes.
//
//   JobBoard (a line)      ChainState (a line)         JobDescriptor (a line each)
//   generation, asleep     next, stage_end, finished   [ stage 0 ......... | stage 1 ... | stage 2 ]
//   chains[] ----------->  descriptors_ea ------------> ^ next              ^ stage_end
//                          done_ea ------> ChainDone    jobs of one stage run in any order; the next stage
//   JobBell (a line each)                               begins when all of them have finished
//
// SPEs change the board and the state of a chain only by getllar and putllc, the PPU side by lwarx and
// stwcx.; so each of them is one line.
//
// An SPE that finds no work sets its bit in `asleep`, if the generation has not changed since it looked at
// the board, and sleeps with its bell reserved. To wake an SPE, clear its bit and ring its bell. A kick wakes
// one SPE; an SPE that takes a job and leaves others wakes the next. So no more SPEs wake than there are
// jobs, and the PPU wakes only one.

#include <stdint.h>

namespace softcell::spu {

/// Local-store address of job images, that of every image. The job loop lies at the top of the local store.
constexpr uint32_t kJobAreaBegin = 0x80;

/// One job. The main of its image is called with the SPE's number, argp and envp. The job has failed if main
/// returns a status other than 0.
struct alignas(128) JobDescriptor {
  uint64_t image_ea;  ///< the image's bytes from kJobAreaBegin on, in main memory; a multiple of 128
  uint64_t argp;
  uint64_t envp;
  uint32_t image_bytes;  ///< text, rodata and data; a multiple of 16
  uint32_t entry;        ///< local-store address of main
  /// Local-store address of the initialised data, which are copied in before every run; a multiple of 16.
  uint32_t data_begin;
  uint32_t data_bytes;  ///< a multiple of 16; 0: none
  /// Number of jobs up to the end of the next stage; 0: this stage is the last.
  uint32_t next_stage_end;
  uint32_t pad[21];
};
static_assert(sizeof(JobDescriptor) == 128, "one line");

/// The progress of a chain. The PPU side writes it for each kick. Its line outlives the chain, because SPEs
/// may have read the board before the chain was removed.
struct alignas(128) ChainState {
  uint64_t descriptors_ea;  ///< of the first JobDescriptor
  uint64_t done_ea;         ///< of the ChainDone
  uint32_t kick;            ///< number of this kick, copied to the ChainDone
  uint32_t next;            ///< first job that no SPE has taken
  uint32_t stage_end;       ///< jobs below this may be taken; equal to `next`: none
  uint32_t finished;        ///< jobs that have ended and whose transfers are complete
  uint32_t failed;          ///< of these, jobs with a status other than 0
  uint32_t failed_job;      ///< the lowest such job
  uint32_t failed_status;   ///< what its main returned
  uint32_t pad[21];
};
static_assert(sizeof(ChainState) == 128, "one line");

/// Written once, as a whole line, when a chain has ended: after its last stage, or after a stage in which a
/// job has failed.
struct alignas(128) ChainDone {
  uint32_t kick;
  uint32_t pad[31];
};
static_assert(sizeof(ChainDone) == 128, "one line");

/// The board on which SPEs look for work. They search chains in order: an earlier one is more urgent.
constexpr uint32_t kMaxChains = 15;
struct alignas(128) JobBoard {
  uint32_t generation;          ///< incremented when there may be new work
  uint16_t stop;                ///< not 0: the job loops end
  uint16_t asleep;              ///< bit s: SPE s sleeps until its bell is rung
  uint64_t chains[kMaxChains];  ///< of a ChainState each; 0: none
};
static_assert(sizeof(JobBoard) == 128, "one line");

/// The bell at which an SPE sleeps, one for each SPE. The SPE clears it before it sets its bit in `asleep`.
struct alignas(128) JobBell {
  uint32_t rung;  ///< not 0: wake up
  uint32_t pad[31];
};
static_assert(sizeof(JobBell) == 128, "one line");

}  // namespace softcell::spu
