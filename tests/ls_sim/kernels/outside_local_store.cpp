// Writes envp bytes past its own buffer, which is far enough to leave the local store.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

static char buffer[16];

int main(uint64_t, uint64_t, uint64_t envp) {
  volatile char* p = buffer;
  p[static_cast<int64_t>(envp)] = 1;
  return 0;
}
