// libFuzzer target: any bytes give an image that fits a local store, or one sentence of refusal.

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "softcell/ls_sim/image.h"

namespace {

using namespace softcell;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const ls_sim::KernelImage& image) {
  require(image.sizes.end <= dma::kLocalStoreBytes && image.sizes.total() <= dma::kLocalStoreBytes);
  require(image.begin >= ls_sim::kEnvironmentBytes);
  require(image.begin + image.bytes.size() <= image.sizes.end);
  require(image.begin <= image.text_begin && image.text_begin <= image.entry);
  require(image.entry < image.text_end && image.text_end <= image.rodata_begin);
  require(image.rodata_begin <= image.rodata_end && image.rodata_end <= image.data_begin);
  require(image.data_begin <= image.data_end);
  require(image.data_end <= image.begin + image.bytes.size());
  for (const ls_sim::ImageObject& object : image.objects) {
    require(object.begin.value >= image.begin && object.begin.value < image.sizes.end);
    require(object.bytes <= image.sizes.end - object.begin.value);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    check(ls_sim::load_image("fuzz", {reinterpret_cast<const std::byte*>(data), size}));
  } catch (const std::runtime_error& refused) {
    require(std::string(refused.what()).starts_with("kernel image fuzz: "));
  }
  return 0;
}
