/* Its SPE reads a buffer before the transfer has been waited for, so that what it prints depends on luck.
 * Ends with a status, by main's return (forgets_to_wait STATUS) or without its exit handlers (forgets_to_wait STATUS _exit, quick_exit, abort); with
 * `keeps` main returns and leaves the context, with `wrong_entry` it first asks for a run that cannot begin. */
#include <unistd.h>

#include "run_in_thread.h"

extern spe_program_handle_t breaks_rules;

static unsigned int words[64] __attribute__((aligned(128))) = {42};

int main(int argc, char** argv) {
  const int status = argc > 1 ? atoi(argv[1]) : 0;
  const char* const way = argc > 2 ? argv[2] : "return";
  spe_thread_t spe;
  if (strcmp(way, "wrong_entry") == 0) {
    spe_context_ptr_t context = spe_context_create(0, NULL);
    unsigned int entry = 64;
    CHECK(spe_program_load(context, &breaks_rules) == 0);
    CHECK(spe_context_run(context, &entry, 0, NULL, NULL, NULL) == -1 && errno == EINVAL);
    entry = SPE_DEFAULT_ENTRY;
    CHECK(spe_context_run(context, &entry, 0, NULL, NULL, NULL) == 0);
    return status;
  }
  start_spe(&spe, &breaks_rules, 0, (void*)7, words);
  if (strcmp(way, "keeps") == 0) {
    CHECK(pthread_join(spe.thread, NULL) == 0);
    return status;
  }
  printf("%d\n", end_spe(&spe));
  if (strcmp(way, "_exit") == 0) _exit(status);
  if (strcmp(way, "quick_exit") == 0) quick_exit(status);
  if (strcmp(way, "abort") == 0) abort();
  return status;
}
