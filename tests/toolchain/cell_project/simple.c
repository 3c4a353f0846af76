#include <libmisc.h>
#include <libspe2.h>
#include <libsync.h>
#include <stdio.h>
#include "shared.h"

extern spe_program_handle_t simple_spu, other_spu;
int more(void);

static int run(spe_program_handle_t* program, work_t* work) {
  spe_context_ptr_t spe = spe_context_create(0, NULL);
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_stop_info_t stop;
  if (spe == NULL || spe_program_load(spe, program) != 0 || spe_context_run(spe, &entry, 0, work, NULL, &stop) != 0) return -1;
  spe_context_destroy(spe);
  return stop.result.spe_exit_code;
}

int main(void) {
  work_t* work = malloc_align(sizeof *work, 7);
  int first, second;
  work->count = 10;
  work->factor = 3;
  calls = doubled(more());
  first = run(&simple_spu, work);
  second = run(&other_spu, work);
  printf("%d %d %u %d\n", first, second, work->sum, calls);
  free_align(work);
  return 0;
}
