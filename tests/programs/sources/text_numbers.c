/* Reads numbers from texts in main memory: `argp` is where they lie and `envp` how many there are. How far each was read stands in the place of
   its first character. */
#include <spu_mfcio.h>
#include <stdint.h>
#include <stdlib.h>

struct number {
  char text[120];
  double value;
};
static struct number numbers[64] __attribute__((aligned(128)));

static void wait_for_all(void) {
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
}

int main(uint64_t id, uint64_t argp, uint64_t envp) {
  const uint32_t count = (uint32_t)envp;
  uint32_t done, i;
  (void)id;
  for (done = 0; done < count; done += 64) {
    const uint32_t here = count - done < 64 ? count - done : 64;
    mfc_get(numbers, argp + done * sizeof numbers[0], here * sizeof numbers[0], 0, 0, 0);
    wait_for_all();
    for (i = 0; i < here; ++i) {
      char* end;
      numbers[i].value = strtod(numbers[i].text, &end);
      numbers[i].text[0] = (char)(end - numbers[i].text);
    }
    mfc_put(numbers, argp + done * sizeof numbers[0], here * sizeof numbers[0], 0, 0, 0);
    wait_for_all();
  }
  return 0;
}
