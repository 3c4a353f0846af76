#include "../spes.h"

extern spe_program_handle_t wordcount_spu;
static char text[1024] __attribute__((aligned(128))) =
    "The cat saw the dog. The dog saw the cat, and the cat ran; a dog ran too. And then? The end.";

int main(void) {
  spe_t spe;
  unsigned long which;
  int wrong = 0;
  for (which = 0; which < 2; which++) {
    fflush(stdout);
    start_spe(&spe, &wordcount_spu, text, (void *)which);
    wrong += wait_spe(&spe) != 10;
  }
  printf(wrong == 0 ? "ok\n" : "wrong\n");
  return wrong != 0;
}
