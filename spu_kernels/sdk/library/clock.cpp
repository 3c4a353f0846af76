// spu_timer.h: the decrementer, which counts down, as a clock of 64 bits.

#include <spu_mfcio.h>
#include <spu_timer.h>

static unsigned int starts;
static unsigned int last;  ///< the decrementer at the last reading
static uint64_t ticks;

extern "C" {

int spu_clock_start() {
  if (starts++ == 0) {
    spu_write_decrementer(0xFFFFFFFF);
    last = spu_read_decrementer();
    ticks = 0;
  }
  return 0;
}

uint64_t spu_clock_read() {
  if (starts == 0) return 0;
  const unsigned int now = spu_read_decrementer();
  ticks += last - now;
  last = now;
  return ticks;
}

int spu_clock_stop() {
  if (starts == 0) return -1;
  --starts;
  return 0;
}

}  // extern "C"
