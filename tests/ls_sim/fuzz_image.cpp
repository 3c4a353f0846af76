// libFuzzer target: any bytes are loaded as an image that fits a local store, or are refused with one sentence.

#include <stdexcept>
#include <string>

#include "ls_sim/image_invariants.h"
#include "softcell/ls_sim/image.h"

namespace {

using namespace softcell;

using ls_sim::require;

void check(const ls_sim::KernelImage& image) {
  ls_sim::require_sound(image);
  require(image.begin >= ls_sim::kEnvironmentBytes);
  require(image.text_begin <= image.entry && image.entry < image.text_end);
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
