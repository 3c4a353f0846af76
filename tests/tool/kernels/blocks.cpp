// Fetches blocks of 4 KB one after the other into one buffer or two. Its arguments: address, blocks, buffers.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

namespace {

constexpr unsigned int kBlockBytes = 4096;

alignas(128) unsigned char buffer[2][kBlockBytes];
alignas(16) uint64_t arguments[4];

void wait(unsigned int tag) {
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
}

void fetch(uint64_t block, unsigned int tag) {
  mfc_get(buffer[tag], arguments[0] + block * kBlockBytes, kBlockBytes, tag, 0, 0);
}

}  // namespace

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(arguments, argp, sizeof arguments, 2, 0, 0);
  wait(2);
  const uint64_t blocks = arguments[1];
  const bool is_double = arguments[2] == 2;
  if (is_double) fetch(0, 0);
  for (uint64_t block = 0; block < blocks; ++block) {
    const unsigned int tag = is_double ? static_cast<unsigned int>(block & 1) : 0;
    if (!is_double) fetch(block, tag);
    if (is_double && block + 1 < blocks) fetch(block + 1, tag ^ 1);
    wait(tag);
  }
  return 0;
}
