#include "run_in_thread.h"

extern spe_program_handle_t reads_what_the_ppu_wrote;

int main(void) {
  spe_thread_t spe;
  start_spe(&spe, &reads_what_the_ppu_wrote, 0, NULL, NULL);
  CHECK(end_spe(&spe) == 0);
  puts("ok");
  return 0;
}
