#include <math.h>
#include <string.h>
#include "../spes.h"
#include "md5.h"

extern spe_program_handle_t md5_spu;

static uint32_t sines[64] __attribute__((aligned(128)));

int main(void) {
  static const char *texts[] = {"", "a", "abc", "message digest", "abcdefghijklmnopqrstuvwxyz",
                                "12345678901234567890123456789012345678901234567890123456789012345678901234567890"};
  /* RFC 1321, A.5: the first word of each digest */
  static const unsigned char first[6][4] = {{0xd4, 0x1d, 0x8c, 0xd9}, {0x0c, 0xc1, 0x75, 0xb9}, {0x90, 0x01, 0x50, 0x98},
                                            {0xf9, 0x6b, 0x69, 0x7d}, {0xc3, 0xfc, 0xd3, 0xd7}, {0x57, 0xed, 0xf4, 0xa2}};
  spe_t spe;
  int i, wrong = 0;
  unsigned int zero = 0;
  for (i = 0; i < 64; i++) sines[i] = (uint32_t)(fabs(sin(i + 1.0)) * 4294967296.0);
  start_spe(&spe, &md5_spu, sines, NULL);
  for (i = 0; i < 6; i++) {
    void *block;
    unsigned char *text;
    message_t *message;
    unsigned int words[2], done;
    if (posix_memalign(&block, 128, 256) != 0) return 1;
    message = block;
    text = (unsigned char *)block + 128;
    strcpy((char *)text, texts[i]);
    message->text = (unsigned long)text;
    message->bytes = strlen(texts[i]);
    words[0] = (unsigned int)(unsigned long)message;
    words[1] = (unsigned int)((unsigned long)message >> 32);
    spe_in_mbox_write(spe.ctx, words, 2, SPE_MBOX_ALL_BLOCKING);
    while (spe_out_mbox_status(spe.ctx) == 0) {
    }
    spe_out_mbox_read(spe.ctx, &done, 1);
    if (memcmp(message->digest, first[i], 4) != 0) wrong++;
    free(block);
  }
  spe_in_mbox_write(spe.ctx, &zero, 1, SPE_MBOX_ALL_BLOCKING);
  wrong += wait_spe(&spe) != 0;
  printf(wrong == 0 ? "ok\n" : "%d wrong\n", wrong);
  return wrong != 0;
}
