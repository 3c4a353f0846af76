// Writes every member of a structure with padding inside and behind, and puts and copies all of it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct alignas(128) Result {
  uint8_t kind;
  struct {
    uint32_t word;
    uint8_t flag;
  } pairs[4];
  uint32_t low : 3, high : 29;
  vec_float4 lanes;
};
static Result result, copy;

int main(uint64_t, uint64_t argp, uint64_t) {
  result.kind = 1;
  for (uint32_t i = 0; i < 4; ++i) {
    result.pairs[i].word = i;
    result.pairs[i].flag = static_cast<uint8_t>(i);
  }
  result.low = 2;
  result.high = 3;
  result.lanes = spu_splats(1.0f);
  copy = result;
  mfc_put(&copy, argp, sizeof copy, 0, 0, 0);
  mfc_put(&result, argp + 128, sizeof result, 0, 0, 0);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return 0;
}
