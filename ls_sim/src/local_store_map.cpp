#include "local_store_map.h"

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

std::vector<LocalStoreSection> local_store_map(const KernelImage& image) {
  const std::uint32_t end = image.sizes.end;
  const std::uint32_t stack_begin = dma::kLocalStoreBytes - image.sizes.stack;
  // ls.ld begins bss at a line and puts `end` at most one alignment behind it.
  const std::uint32_t bss_begin = (end - image.sizes.bss) / dma::kLineBytes * dma::kLineBytes;

  std::vector<LocalStoreSection> map;
  const auto add = [&](std::string_view kind, std::uint32_t begin, std::uint32_t bytes) {
    if (bytes != 0) map.push_back({kind, begin, bytes});
  };
  add("environment", 0, kEnvironmentBytes);
  add("text", image.text_begin, image.text_end - image.text_begin);
  add("rodata", image.rodata_begin, image.rodata_end - image.rodata_begin);
  add("data", image.data_begin, image.data_end - image.data_begin);
  add("bss", bss_begin, image.sizes.bss);
  add("free", end, stack_begin - end);
  add("stack", stack_begin, image.sizes.stack);
  return map;
}

}  // namespace softcell::ls_sim
