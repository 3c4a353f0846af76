// Tells of argp jobs that begin and end, as a job loop does, and then of envp ends that no job has.
#include <spu_intrinsics.h>

#include "common/job_mark.h"

static volatile char bulk[12 * 1024];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  using namespace softcell::spu;
  bulk[0] = 1;  // it has this much that a job must leave alone
  for (uint64_t job = 0; job < argp; ++job) {
    mark_job_begin(0, job);
    mark_job_end();
  }
  for (uint64_t i = 0; i < envp; ++i) mark_job_end();
  return 0;
}
