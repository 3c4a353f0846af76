// Never ends; with envp 1 it calls its channels all the while, with envp 0 it never does.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t, uint64_t envp) {
  volatile int forever = 1;
  while (forever) {
    if (envp) mfc_write_tag_mask(1);
  }
  return 0;
}
