#include <libspe2.h>
#include <stdio.h>
extern spe_program_handle_t scale_spu;
static float numbers[64] __attribute__((aligned(128)));
int main(void) {
  unsigned int entry = SPE_DEFAULT_ENTRY;
  spe_context_ptr_t spe = spe_context_create(0, NULL);
  int i;
  for (i = 0; i < 64; i++) numbers[i] = (float)i;
  if (spe_program_load(spe, &scale_spu) || spe_context_run(spe, &entry, 0, numbers, NULL, NULL) < 0) return 1;
  spe_context_destroy(spe);
  printf("the PPU says: %g\n", numbers[63]);
  return 0;
}
