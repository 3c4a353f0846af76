#include <string.h>
#include "../spes.h"
#include "life.h"

extern spe_program_handle_t life_spu;
#define HEIGHT (BANDS * ROWS)
static unsigned char cells[HEIGHT][COLUMNS] __attribute__((aligned(128)));

int main(void) {
  static band_t bands[BANDS] __attribute__((aligned(128)));
  static unsigned char a[HEIGHT][COLUMNS], b[HEIGHT][COLUMNS];
  spe_t spes[BANDS];
  unsigned long long store[BANDS];
  unsigned int i, offset = 0, go = 1;
  int step, x, y, wrong = 0;
  for (y = 0; y < HEIGHT; y++)
    for (x = 0; x < COLUMNS; x++) a[y][x] = cells[y][x] = (x * 7 + y * 13 + x * y) % 5 < 2;
  for (i = 0; i < BANDS; i++) {
    bands[i].cells = (unsigned long)cells[i * ROWS];
    spes[i].argp = &bands[i];
    spes[i].envp = NULL;
    spes[i].ctx = spe_context_create(SPE_MAP_PS | SPE_CFG_SIGNOTIFY1_OR | SPE_CFG_SIGNOTIFY2_OR, NULL);
    if (spes[i].ctx == NULL || spe_program_load(spes[i].ctx, &life_spu)) return 1;
    store[i] = (unsigned long)spe_ls_area_get(spes[i].ctx);
  }
  for (i = 0; i < BANDS; i++) pthread_create(&spes[i].thread, NULL, spe_main, &spes[i]);
  for (i = 0; i < BANDS; i++) {
    while (spe_out_mbox_read(spes[i].ctx, &offset, 1) == 0) {
    }
    offset &= 0x3FFFF; /* a pointer of the SPE; the address in its local store counts */
  }
  for (i = 0; i < BANDS; i++) {
    unsigned int up = (i + BANDS - 1) % BANDS, down = (i + 1) % BANDS;
    bands[i].above = store[up] + offset;
    bands[i].below = store[down] + offset;
    /* the upper neighbour hears of its lower edge by signal 2, the lower one of its upper edge by signal 1 */
    bands[i].above_signal = (unsigned long)spe_ps_area_get(spes[up].ctx, SPE_SIG_NOTIFY_2_AREA) + 12;
    bands[i].below_signal = (unsigned long)spe_ps_area_get(spes[down].ctx, SPE_SIG_NOTIFY_1_AREA) + 12;
  }
  for (i = 0; i < BANDS; i++) spe_in_mbox_write(spes[i].ctx, &go, 1, SPE_MBOX_ALL_BLOCKING);
  for (i = 0; i < BANDS; i++) wrong += wait_spe(&spes[i]) != 0;
  for (step = 0; step < STEPS; step++) {
    for (y = 0; y < HEIGHT; y++) {
      for (x = 0; x < COLUMNS; x++) {
        int n = 0, dx, dy;
        for (dy = -1; dy <= 1; dy++)
          for (dx = -1; dx <= 1; dx++)
            if (dx || dy) n += a[(y + dy + HEIGHT) % HEIGHT][(x + dx + COLUMNS) % COLUMNS];
        b[y][x] = n == 3 || (n == 2 && a[y][x]);
      }
    }
    memcpy(a, b, sizeof a);
  }
  for (y = 0; y < HEIGHT; y++)
    for (x = 0; x < COLUMNS; x++) wrong += a[y][x] != cells[y][x];
  printf(wrong == 0 ? "ok\n" : "%d wrong\n", wrong);
  return wrong != 0;
}
