/* Each SPE sorts a block with qsort() in memory of malloc(); the last to finish, told by an atomic counter, merges. */
#include <libsync.h>
#include <spu_mfcio.h>
#include <stdlib.h>
#include "sort.h"

static control_t control __attribute__((aligned(128)));

static int compare(const void *a, const void *b) {
  int x = *(const int *)a, y = *(const int *)b;
  return x < y ? -1 : x > y;
}

static void transfer(void *ls, unsigned long long ea, unsigned bytes, int put) {
  if (put)
    mfc_put(ls, ea, bytes, 0, 0, 0);
  else
    mfc_get(ls, ea, bytes, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
}

static void merge(void) {
  int *all = memalign(128, SPES * BLOCK * sizeof(int)), *out = memalign(128, SPES * BLOCK * sizeof(int));
  unsigned at[SPES] = {0}, i, s;
  if (all == NULL || out == NULL) exit(2);
  for (s = 0; s < SPES; s++) transfer(all + s * BLOCK, control.numbers + s * BLOCK * sizeof(int), BLOCK * sizeof(int), 0);
  for (i = 0; i < SPES * BLOCK; i++) {
    int best = -1;
    for (s = 0; s < SPES; s++)
      if (at[s] < BLOCK && (best < 0 || all[s * BLOCK + at[s]] < all[best * BLOCK + at[best]])) best = (int)s;
    out[i] = all[best * BLOCK + at[best]];
    at[best]++;
  }
  for (s = 0; s < SPES; s++) transfer(out + s * BLOCK, control.numbers + s * BLOCK * sizeof(int), BLOCK * sizeof(int), 1);
  free(out);
  free(all);
}

int main(unsigned long long id, unsigned long long argp, unsigned long long index) {
  int *block = memalign(128, BLOCK * sizeof(int));
  unsigned long long ea;
  (void)id;
  transfer(&control, argp, sizeof control, 0);
  ea = control.numbers + index * BLOCK * sizeof(int);
  transfer(block, ea, BLOCK * sizeof(int), 0);
  qsort(block, BLOCK, sizeof(int), compare);
  transfer(block, ea, BLOCK * sizeof(int), 1);
  free(block);
  if (atomic_inc_return(control.counter) == SPES - 1) merge();
  return 0;
}
