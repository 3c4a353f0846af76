#include "run_in_thread.h"

extern spe_program_handle_t sums_its_store;

static unsigned int words[256] __attribute__((aligned(128)));
static unsigned int sums[4] __attribute__((aligned(128)));

int main(void) {
  spe_thread_t spe;
  unsigned int status = 0, message = 1, answer = 0, expected = 0, place = 0;
  int i;
  start_spe(&spe, &sums_its_store, SPE_EVENTS_ENABLE, NULL, NULL);
  while (spe_out_mbox_read(spe.context, &place, 1) == 0) {
  }
  for (i = 0; i < 256; ++i) expected += words[i] = (unsigned int)(i * 3);
  CHECK(spe_mfcio_get(spe.context, place, words, sizeof words, 5, 0, 0) == 0);
  CHECK(spe_mfcio_tag_status_read(spe.context, 1 << 5, SPE_TAG_ALL, &status) == 0);
  CHECK(status == 1 << 5);
  CHECK(spe_in_mbox_write(spe.context, &message, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  while (spe_out_mbox_read(spe.context, &answer, 1) == 0) {
  }
  CHECK(answer == expected);
  CHECK(spe_mfcio_put(spe.context, place + 1024, sums, sizeof sums, 6, 0, 0) == 0);
  CHECK(spe_mfcio_tag_status_read(spe.context, 0, SPE_TAG_ANY, &status) == 0);
  CHECK(status == 1 << 6);
  CHECK(sums[0] == expected && sums[3] == expected);
  /* The same through the local store as memory. */
  for (i = 0; i < 256; ++i) ((unsigned int*)((char*)spe_ls_area_get(spe.context) + place))[i] = 1;
  CHECK(spe_in_mbox_write(spe.context, &message, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  while (spe_out_mbox_read(spe.context, &answer, 1) == 0) {
  }
  CHECK(answer == 256);
  message = 0;
  CHECK(spe_in_mbox_write(spe.context, &message, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  CHECK(end_spe(&spe) == 0);
  puts("ok");
  return 0;
}
