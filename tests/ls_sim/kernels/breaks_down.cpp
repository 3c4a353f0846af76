// A job loop that does not work. Without a chain it stops; of the first chain it takes a job and halts, so
// that nobody knows whose that job was; when there is none to take it ends, though nobody has told it to.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/atomic_line.h"
#include "job_chain.h"

static softcell::spu::JobBoard board;
static softcell::spu::ChainState chain;

int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  load_and_reserve(&board, argp);
  if (board.stop != 0) return 0;
  if (board.chains[0] == 0) spu_stop(0x77);
  do {
    load_and_reserve(&chain, board.chains[0]);
    if (chain.next == chain.stage_end) return 5;
    ++chain.next;
  } while (!store_conditional(&chain, board.chains[0]));
  spu_hcmpeq(1, 1);
  return 0;
}
