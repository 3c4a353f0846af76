// job_loop: the resident kernel of every SPE. It takes jobs from the chains of a board in main memory,
// fetches their images if needed, calls them, and sleeps when there is no work. The PPU takes no part.
//
//   array       direction   element                     count    alignment   DMA
//   board       in, out     JobBoard                    1        128         getllar, putllc
//   bell        in, out     JobBell                     1        128         getllar, putlluc
//   chain       in, out     ChainState                  1        128         getllar, putllc
//   done        out         ChainDone                   1        128         putlluc
//   job         in          JobDescriptor               1        128         one get
//   image       in          bytes from kJobAreaBegin    any      128         gets; none if resident
//
//   look at the board -> for each chain: take a job -> image -> call -> count it finished -> take the next
//   ...                                 `-> others are left: wake an SPE
//         ^                                                                                     | none left
//         +---- its bell was rung ---- enter the board as asleep, sleep with the bell reserved <+
//
// argp: effective address of the JobBoard; envp: of the JobBells, one for each SPE. Budget: 4864 bytes. The kernel
// lies at the top of the local store with its stack below it, so a job has all the rest, as if it were
// alone.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/atomic_line.h"
#include "common/dma.h"
#include "common/job_mark.h"
#include "job_chain.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagImage = 0 };
constexpr uint32_t kAllTags = 0xFFFFFFFFu;
constexpr uintptr_t kLocalStoreMask = 0x3FFFF;

struct alignas(128) LocalStoreMap {
  JobBoard board;
  JobBell bell;
  ChainState chain;
  ChainDone done;
  JobDescriptor job;
};
LocalStoreMap ls;

/// Effective address of the image that lies in the job area; 0: there is none.
uint64_t resident_image = 0;

/// The number of this SPE, and the addresses of the board and the bells.
struct Post {
  uint64_t spe_id;
  uint64_t board_ea;
  uint64_t bells_ea;

  uint16_t bit() const { return static_cast<uint16_t>(1u << spe_id); }
  uint64_t bell_ea(uint64_t spe) const { return bells_ea + spe * sizeof(JobBell); }
};

/// The pointer to a local-store address. On an SPU a pointer is that address; on a host the local store begins at another address than 0.
char* local_store(uint32_t address) {
  return reinterpret_cast<char*>((reinterpret_cast<uintptr_t>(&ls) & ~kLocalStoreMask) | address);
}

/// Announces that there may be new work: SPEs that found none and are about to sleep look again.
void announce_work(const Post& post) {
  do {
    load_and_reserve(&ls.board, post.board_ea);
    ++ls.board.generation;
  } while (!store_conditional(&ls.board, post.board_ea));
}

void set_bell(const Post& post, uint64_t spe, uint32_t rung) {
  ls.bell.rung = rung;
  store_line(&ls.bell, post.bell_ea(spe));
}

/// Wakes one of the sleeping SPEs, if there is one.
void wake_one(const Post& post) {
  uint64_t sleeper = 0;
  do {
    load_and_reserve(&ls.board, post.board_ea);
    if (ls.board.asleep == 0) return;
    for (sleeper = 0; (ls.board.asleep >> sleeper & 1) == 0;) ++sleeper;
    ls.board.asleep = static_cast<uint16_t>(ls.board.asleep & ~(1u << sleeper));
  } while (!store_conditional(&ls.board, post.board_ea));
  set_bell(post, sleeper, 1);
}

/// Takes a job of the chain that may begin now. @return  false when there is none.
bool take(uint64_t chain_ea, uint32_t& job) {
  do {
    load_and_reserve(&ls.chain, chain_ea);
    if (ls.chain.next == ls.chain.stage_end) return false;
    job = ls.chain.next++;
  } while (!store_conditional(&ls.chain, chain_ea));
  return true;
}

/// Fetches the job's image. If it is resident, fetches only its initialised data, which begin each run with their linked values.
void fetch_image() {
  const JobDescriptor& job = ls.job;
  if (resident_image == job.image_ea) {
    get_large(local_store(job.data_begin), job.image_ea + (job.data_begin - kJobAreaBegin), job.data_bytes,
              kTagImage);
  } else {
    get_large(local_store(kJobAreaBegin), job.image_ea, job.image_bytes, kTagImage);
    resident_image = job.image_ea;
  }
  wait_for_tag(kTagImage);
  spu_sync_c();  // so that the SPU executes the instructions that were just written
}

/// Runs one job and waits for all its transfers. @return  the status of its main
uint32_t run(uint64_t spe_id, uint64_t descriptor_ea) {
  mfc_get(&ls.job, descriptor_ea, sizeof ls.job, kTagImage, 0, 0);
  wait_for_tag(kTagImage);
  fetch_image();
  using JobMain = int(uint64_t, uint64_t, uint64_t);
  JobMain* const job_main = reinterpret_cast<JobMain*>(local_store(ls.job.entry));
  mfc_write_tag_mask(0);  // as when a program starts
  mark_job_begin(ls.job.image_ea, descriptor_ea);
  const int status = job_main(spe_id, ls.job.argp, ls.job.envp);
  mark_job_end();
  wait_for_tags(kAllTags);
  return static_cast<uint32_t>(status) & 0xFF;
}

/// Counts a job as finished. The last one of a stage opens the next, or ends the chain.
void finish(const Post& post, uint64_t chain_ea, uint32_t job, uint32_t status) {
  bool stage_finished = false, chain_ended = false;
  do {
    load_and_reserve(&ls.chain, chain_ea);
    ChainState& chain = ls.chain;
    ++chain.finished;
    if (status != 0) {
      if (chain.failed == 0 || job < chain.failed_job) {
        chain.failed_job = job;
        chain.failed_status = status;
      }
      ++chain.failed;
    }
    stage_finished = chain.finished == chain.stage_end;
    chain_ended = stage_finished && (ls.job.next_stage_end == 0 || chain.failed != 0);
    if (stage_finished && !chain_ended) chain.stage_end = ls.job.next_stage_end;
  } while (!store_conditional(&ls.chain, chain_ea));
  if (chain_ended) {
    ls.done.kick = ls.chain.kick;
    store_line(&ls.done, ls.chain.done_ea);
  } else if (stage_finished) {
    announce_work(post);
  }
}

/// Takes and runs one job of the most urgent chain that has one. @return  false: there was none
bool work(const Post& post) {
  for (uint32_t c = 0; c < kMaxChains; ++c) {
    const uint64_t chain_ea = ls.board.chains[c];
    uint32_t job = 0;
    if (chain_ea == 0 || !take(chain_ea, job)) continue;
    const uint64_t descriptor_ea = ls.chain.descriptors_ea + uint64_t{job} * sizeof(JobDescriptor);
    // An SPE that has set its bit in `asleep` after this SPE read the board has read the chains after that, too: it needs no waking.
    if (ls.chain.next != ls.chain.stage_end && ls.board.asleep != 0) wake_one(post);
    const uint32_t status = run(post.spe_id, descriptor_ea);
    finish(post, chain_ea, job, status);
    return true;
  }
  return false;
}

/// Sets the bit of this SPE in `asleep`. @return  false: there may be new work, and the bit is not set
bool enter(const Post& post, uint32_t generation) {
  do {
    load_and_reserve(&ls.board, post.board_ea);
    if (ls.board.generation != generation || ls.board.stop != 0) return false;
    ls.board.asleep = static_cast<uint16_t>(ls.board.asleep | post.bit());
  } while (!store_conditional(&ls.board, post.board_ea));
  return true;
}

/// Sleeps until somebody rings the bell. No ring is missed: a ring before the reservation of the bell's line shows in the line, and a ring
/// after it ends the reservation.
void sleep_at_bell(const Post& post) {
  spu_write_event_mask(MFC_LLR_LOST_EVENT);
  for (;;) {
    spu_write_event_ack(MFC_LLR_LOST_EVENT);
    load_and_reserve(&ls.bell, post.bell_ea(post.spe_id));
    if (ls.bell.rung != 0) break;
    spu_read_event_status();
  }
  spu_write_event_ack(MFC_LLR_LOST_EVENT);
  spu_write_event_mask(0);  // as when a program starts
}

/// Sleeps, unless the board's generation is no longer the one at which this SPE found no work.
void rest(const Post& post, uint32_t generation) {
  set_bell(post, post.spe_id, 0);
  if (enter(post, generation)) sleep_at_bell(post);
}

}  // namespace
}  // namespace softcell::spu

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  using namespace softcell::spu;
  const Post post = {spe_id, argp, envp};
  resident_image = 0;
  for (;;) {
    load_and_reserve(&ls.board, post.board_ea);
    if (ls.board.stop != 0) return 0;
    const uint32_t generation = ls.board.generation;
    if (!work(post)) rest(post, generation);
  }
}
