// libFuzzer target: any bytes give a program that fits a local store, or one sentence of refusal; and whatever the
// program does, it stays within its local store.

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "interpreter/execute.h"
#include "softcell/ls_sim/image.h"

namespace {

using namespace softcell;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const ls_sim::KernelImage& image) {
  require(image.sizes.end <= dma::kLocalStoreBytes && image.sizes.total() <= dma::kLocalStoreBytes);
  require(image.begin + image.bytes.size() <= image.sizes.end);
  require(image.begin <= image.text_begin && image.text_begin <= image.text_end);
  require(image.entry >= image.begin && image.entry < image.sizes.end && image.entry % 4 == 0);
  require(image.text_end <= image.rodata_begin && image.rodata_begin <= image.rodata_end);
  require(image.rodata_end <= image.data_begin && image.data_begin <= image.data_end);
  require(image.data_end <= image.begin + image.bytes.size());
  for (const auto* objects : {&image.objects, &image.functions}) {
    for (const ls_sim::ImageObject& object : *objects) {
      require(object.begin.value >= image.begin && object.begin.value < image.sizes.end);
      require(object.bytes <= image.sizes.end - object.begin.value);
    }
  }
}

void run_a_while(const ls_sim::KernelImage& image) {
  constexpr int kMostInstructions = 2000;
  std::vector<std::byte> local_store(dma::kLocalStoreBytes);
  std::memcpy(local_store.data() + image.begin, image.bytes.data(), image.bytes.size());
  ls_sim::interpreter::SpuState state;
  state.pc = image.entry;
  for (int i = 0; i < kMostInstructions; ++i) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, local_store.data() + state.pc, sizeof bytes);
    const auto step = ls_sim::interpreter::execute(
        state, std::span<std::byte, dma::kLocalStoreBytes>(local_store), __builtin_bswap32(bytes));
    require((state.pc & ~ls_sim::interpreter::kInstructionMask) == 0);
    if (step.ending != ls_sim::interpreter::Ending::kNone) return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const auto image = ls_sim::load_spu_program("fuzz", {reinterpret_cast<const std::byte*>(data), size});
    check(image);
    run_a_while(image);
  } catch (const std::runtime_error& refused) {
    require(std::string(refused.what()).starts_with("SPU program fuzz: "));
  }
  return 0;
}
