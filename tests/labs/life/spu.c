/* Conway's Life in bands: each SPE keeps its rows in its local store and hands edges to its neighbours' local stores. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include "life.h"

static band_t band __attribute__((aligned(128)));
/* row 0 and ROWS + 1 belong to the neighbours */
static unsigned char cells[2][ROWS + 2][COLUMNS] __attribute__((aligned(128)));
static unsigned int one[4] __attribute__((aligned(16))) = {1, 1, 1, 1};

static int alive(int now, int y, int x) { return cells[now][y][(x + COLUMNS) % COLUMNS]; }

int main(unsigned long long id, unsigned long long argp) {
  int step, now = 0, x, y, i;
  unsigned int seen[2] = {0, 0};
  (void)id;
  mfc_get(&band, argp, sizeof band, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  mfc_get(cells[0][1], band.cells, ROWS * COLUMNS, 0, 0, 0);
  mfc_read_tag_status_all();
  /* the PPU side tells us the addresses when all have started */
  spu_write_out_mbox((unsigned int)&cells[0][0][0]);
  spu_read_in_mbox();
  mfc_get(&band, argp, sizeof band, 0, 0, 0);
  mfc_read_tag_status_all();
  for (step = 0; step < STEPS; step++) {
    /* my first row is the upper neighbour's last, my last row the lower neighbour's first */
    unsigned long long half = (unsigned long long)now * sizeof cells[0];
    mfc_put(cells[now][1], band.above + half + (ROWS + 1) * COLUMNS, COLUMNS, 1, 0, 0);
    mfc_put(cells[now][ROWS], band.below + half, COLUMNS, 2, 0, 0);
    /* "it is there", behind the rows. A neighbour may be a step ahead, so that even and odd steps have bits of their own. */
    unsigned int bit = 1u << (step & 1);
    one[band.above_signal >> 2 & 3] = bit;
    one[band.below_signal >> 2 & 3] = bit;
    mfc_sndsigf(&one[band.above_signal >> 2 & 3], band.above_signal, 1, 0, 0);
    mfc_sndsigf(&one[band.below_signal >> 2 & 3], band.below_signal, 2, 0, 0);
    mfc_write_tag_mask(6);
    mfc_read_tag_status_all();
    for (i = 0; i < 2; i++) {
      while (!(seen[i] & bit)) seen[i] |= i == 0 ? spu_read_signal1() : spu_read_signal2();
      seen[i] &= ~bit;
    }
    for (y = 1; y <= ROWS; y++) {
      for (x = 0; x < COLUMNS; x++) {
        int n = alive(now, y - 1, x - 1) + alive(now, y - 1, x) + alive(now, y - 1, x + 1) + alive(now, y, x - 1) +
                alive(now, y, x + 1) + alive(now, y + 1, x - 1) + alive(now, y + 1, x) + alive(now, y + 1, x + 1);
        cells[!now][y][x] = n == 3 || (n == 2 && cells[now][y][x]);
      }
    }
    now = !now;
  }
  mfc_put(cells[now][1], band.cells, ROWS * COLUMNS, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return seen[0] | seen[1];
}
