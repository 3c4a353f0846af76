#include "run_in_thread.h"

extern spe_program_handle_t pipeline;

typedef struct {
  unsigned long long next_block, next_signal, previous_signal, source;
  unsigned int blocks, first, padding[2];
} stage_t;

#define STAGES 6
#define BLOCKS 8
#define WORDS 256

static unsigned int source[BLOCKS * WORDS] __attribute__((aligned(128)));
static unsigned int sink[BLOCKS * WORDS] __attribute__((aligned(128)));

/* The address of a signal register for another SPE's DMA. */
static unsigned long long signal_ea(spe_context_ptr_t spe, enum ps_area area) {
  char* base = (char*)spe_ps_area_get(spe, area);
  CHECK(base != NULL);
  return (unsigned long long)(uintptr_t)(base + 12);
}

/* What an SPE says first: where in its local store blocks are to come. */
static unsigned int place(spe_context_ptr_t spe) {
  unsigned int address = 0;
  while (spe_out_mbox_read(spe, &address, 1) == 0) {
  }
  return address;
}

int main(void) {
  static stage_t stages[STAGES] __attribute__((aligned(128)));
  spe_thread_t spes[STAGES];
  int i;
  for (i = 0; i < BLOCKS * WORDS; ++i) source[i] = (unsigned int)i;
  for (i = 0; i < STAGES; ++i) {
    spes[i].context = spe_context_create(SPE_MAP_PS, NULL);
    CHECK(spes[i].context != NULL);
    CHECK(spe_program_load(spes[i].context, &pipeline) == 0);
  }
  for (i = 0; i < STAGES; ++i) {
    spes[i].argp = &stages[i];
    spes[i].envp = NULL;
    CHECK(pthread_create(&spes[i].thread, NULL, run_context, &spes[i]) == 0);
  }
  for (i = 0; i < STAGES; ++i) {
    stages[i].blocks = BLOCKS;
    stages[i].first = i == 0;
    stages[i].source = (unsigned long long)(uintptr_t)source;
    if (i != 0) stages[i].previous_signal = signal_ea(spes[i - 1].context, SPE_SIG_NOTIFY_2_AREA);
    if (i + 1 < STAGES) {
      stages[i].next_block =
          (unsigned long long)(uintptr_t)spe_ls_area_get(spes[i + 1].context) + place(spes[i + 1].context);
      stages[i].next_signal = signal_ea(spes[i + 1].context, SPE_SIG_NOTIFY_1_AREA);
    } else {
      stages[i].next_block = (unsigned long long)(uintptr_t)sink;
    }
  }
  for (i = 0; i < STAGES; ++i) {
    unsigned int begin = 1;
    CHECK(spe_in_mbox_write(spes[i].context, &begin, 1, SPE_MBOX_ALL_BLOCKING) == 1);
  }
  for (i = 0; i < STAGES; ++i) CHECK(end_spe(&spes[i]) == 0);
  for (i = 0; i < BLOCKS * WORDS; ++i) CHECK(sink[i] == (unsigned int)i + STAGES);
  puts("ok");
  return 0;
}
