#include "run_in_thread.h"

extern spe_program_handle_t reverses;

#define COUNT 64

typedef struct {
  unsigned char bytes[32];
} record_t;

int main(void) {
  static unsigned char memory[COUNT * 160] __attribute__((aligned(128)));
  static unsigned long long table[COUNT] __attribute__((aligned(128)));
  static struct {
    unsigned long long table;
    unsigned int count, padding;
  } job __attribute__((aligned(16)));
  spe_thread_t spe;
  int i;
  for (i = 0; i < COUNT; ++i) {
    unsigned char* record = memory + ((i * 37) % COUNT) * 160 + 16;
    memset(record, i, sizeof(record_t));
    table[i] = (unsigned long long)(uintptr_t)record;
  }
  job.table = (unsigned long long)(uintptr_t)table;
  job.count = COUNT;
  start_spe(&spe, &reverses, 0, &job, NULL);
  CHECK(end_spe(&spe) == COUNT);
  for (i = 0; i < COUNT; ++i) {
    const record_t* record = (const record_t*)(uintptr_t)table[i];
    CHECK(record->bytes[0] == COUNT - 1 - i && record->bytes[31] == COUNT - 1 - i);
  }
  puts("ok");
  return 0;
}
