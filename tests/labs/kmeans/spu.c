/* k-means: the SPE adds up the points nearest to each centre; the PPU side moves the centres. Signals tell of rounds. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include "kmeans.h"

#define CHUNK 256
static problem_t problem __attribute__((aligned(16)));
static centres_t centres __attribute__((aligned(128)));
static part_t part __attribute__((aligned(128)));
static float xs[CHUNK] __attribute__((aligned(128))), ys[CHUNK] __attribute__((aligned(128)));

static inline void complete(unsigned tag) {
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
}

int main(unsigned long long id, unsigned long long argp, unsigned long long rank) {
  (void)id;
  mfc_get(&problem, argp, sizeof problem, 0, 0, 0);
  complete(0);
  mfc_get(xs, problem.xs + rank * sizeof xs, sizeof xs, 1, 0, 0);
  mfc_get(ys, problem.ys + rank * sizeof ys, sizeof ys, 1, 0, 0);
  complete(1);
  while (spu_read_signal2() == 1) {
    unsigned i, c;
    part = (part_t){.count = {0}};
    mfc_get(&centres, problem.centres, sizeof centres, 2, 0, 0);
    complete(2);
    for (i = 0; i < CHUNK; i += 4) {
      vector float x = *(vector float *)&xs[i], y = *(vector float *)&ys[i];
      vector float best = spu_splats(1e30f);
      vector signed int which = spu_splats(0);
      int lane;
      for (c = 0; c < CLUSTERS; c++) {
        vector float dx = x - spu_splats(centres.x[c]), dy = y - spu_splats(centres.y[c]);
        vector float d = spu_madd(dx, dx, spu_mul(dy, dy));
        vector unsigned int nearer = spu_cmpgt(best, d);
        best = spu_sel(best, d, nearer);
        which = spu_sel(which, spu_splats((int)c), nearer);
      }
      for (lane = 0; lane < 4; lane++) {
        int w = spu_extract(which, lane);
        part.sum_x[w] += xs[i + lane];
        part.sum_y[w] += ys[i + lane];
        part.count[w]++;
      }
    }
    mfc_put(&part, problem.parts + rank * sizeof part, sizeof part, 3, 0, 0);
    complete(3);
    spu_write_out_intr_mbox((unsigned)rank);
  }
  return 0;
}
