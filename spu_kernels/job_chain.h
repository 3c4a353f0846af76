#pragma once
// Job chains: plain data in main memory, the same bytes for the PPU side that writes them and for the kernel
// `job_loop` that works them off.
//
//   JobBoard (a line)      ChainState (a line)         JobDescriptor (a line each)
//   generation, asleep     next, stage_end, finished   [ stage 0 ......... | stage 1 ... | stage 2 ]
//   chains[] ----------->  descriptors_ea ------------> ^ next              ^ stage_end
//                          done_ea ------> ChainDone    jobs of one stage run in any order; the next stage
//   JobBell (a line each)                               begins when all of them have finished
//
// Everybody changes the board and a chain's state by getllar and putllc only (the PPU side by its
// equivalent), so each is one line.
//
// An SPE that finds nothing to do enters itself in `asleep`, provided that the generation is still the one at
// which it has looked, and sleeps with its own bell reserved. To wake it, one takes its bit away and rings
// its bell. A kick wakes one SPE; whoever takes a job and leaves others wakes the next. So never more are
// woken than there are jobs, and the PPU pays for one.

#include <stdint.h>

namespace softcell::spu {

/// Job images lie where every image does; the job loop itself lies at the top of the local store.
constexpr uint32_t kJobAreaBegin = 0x80;

/// One job. Its image's main gets the SPE's number, argp and envp; a status other than 0 means that it
/// failed.
struct alignas(128) JobDescriptor {
  uint64_t image_ea;  ///< the image's bytes from kJobAreaBegin on, in main memory; a multiple of 128
  uint64_t argp;
  uint64_t envp;
  uint32_t image_bytes;  ///< text, rodata and data; a multiple of 16
  uint32_t entry;        ///< local-store address of main
  uint32_t data_begin;   ///< local-store address of the initialised data, which every run begins with anew; a
                         ///< multiple of 16
  uint32_t data_bytes;   ///< a multiple of 16; 0: none
  uint32_t
      next_stage_end;  ///< jobs of the chain up to the end of the following stage; 0: this stage is the last
  uint32_t pad[21];
};
static_assert(sizeof(JobDescriptor) == 128, "one line");

/// How far a chain has come. The PPU side writes it anew for each kick. Its line outlives the chain, for SPEs
/// that have read the board before the chain went.
struct alignas(128) ChainState {
  uint64_t descriptors_ea;  ///< of the first JobDescriptor
  uint64_t done_ea;         ///< of the ChainDone
  uint32_t kick;            ///< number of this kick, copied to the ChainDone
  uint32_t next;            ///< first job that nobody has taken
  uint32_t stage_end;       ///< jobs before this one may be taken; equal to `next`: none
  uint32_t finished;        ///< jobs that have ended, their transfers with them
  uint32_t failed;          ///< of these, with another status than 0
  uint32_t failed_job;      ///< the lowest such job
  uint32_t failed_status;   ///< what its main returned
  uint32_t pad[21];
};
static_assert(sizeof(ChainState) == 128, "one line");

/// Written once, as a whole, when a chain has ended: after its last stage, or after the stage of a job that
/// failed.
struct alignas(128) ChainDone {
  uint32_t kick;
  uint32_t pad[31];
};
static_assert(sizeof(ChainDone) == 128, "one line");

/// Where SPEs look for work, from the first chain to the last: an earlier one is more urgent.
constexpr uint32_t kMaxChains = 15;
struct alignas(128) JobBoard {
  uint32_t generation;          ///< changes when there may be new work
  uint16_t stop;                ///< not 0: the job loops are to end
  uint16_t asleep;              ///< bit s: SPE s sleeps until its bell is rung
  uint64_t chains[kMaxChains];  ///< of a ChainState each; 0: none
};
static_assert(sizeof(JobBoard) == 128, "one line");

/// What an SPE sleeps at, one for each. It takes the ring back itself before it enters itself as asleep.
struct alignas(128) JobBell {
  uint32_t rung;  ///< not 0: wake up
  uint32_t pad[31];
};
static_assert(sizeof(JobBell) == 128, "one line");

}  // namespace softcell::spu
