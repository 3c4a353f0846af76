#include "local_store_map.h"

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

std::vector<LocalStoreSection> local_store_map(const KernelImage& image) {
  const std::uint32_t end = image.sizes.end;
  const std::uint32_t stack_begin = image.stack_top - image.sizes.stack;
  SC_ASSERT(image.sizes.stack <= image.stack_top && image.stack_top <= dma::kLocalStoreBytes,
            "{} has a stack of {} bytes below {}", image.name, image.sizes.stack, image.stack_top);
  SC_ASSERT(end <= dma::kLocalStoreBytes && image.sizes.bss <= end, "{} ends at {} with {} bytes of bss",
            image.name, end, image.sizes.bss);
  SC_ASSERT(image.text_begin <= image.text_end && image.rodata_begin <= image.rodata_end &&
                image.data_begin <= image.data_end,
            "{} has text from {} to {}, constants from {} to {}, data from {} to {}", image.name,
            image.text_begin, image.text_end, image.rodata_begin, image.rodata_end, image.data_begin,
            image.data_end);
  const bool has_environment = image.machine == Machine::kHost;
  const bool is_at_bottom = !has_environment || image.begin == kEnvironmentBytes;
  // In a program for the SPU, bss follows the bytes of the file. In other images ls.ld begins bss at a line, and `end` lies at
  // most one alignment behind it.
  const std::uint32_t bss_begin = image.machine == Machine::kSpu
                                      ? image.begin + static_cast<std::uint32_t>(image.bytes.size())
                                      : (end - image.sizes.bss) / dma::kLineBytes * dma::kLineBytes;

  std::vector<LocalStoreSection> map;
  const auto add = [&](std::string_view kind, std::uint32_t begin, std::uint32_t bytes) {
    if (bytes != 0) map.push_back({kind, begin, bytes});
  };
  const auto add_stack = [&](std::uint32_t free_from) {
    add("free", free_from, stack_begin - free_from);
    add("stack", stack_begin, image.sizes.stack);
  };
  add(has_environment ? "environment" : "free", 0, has_environment ? kEnvironmentBytes : image.begin);
  if (!is_at_bottom) add_stack(kEnvironmentBytes);
  add("text", image.text_begin, image.text_end - image.text_begin);
  add("rodata", image.rodata_begin, image.rodata_end - image.rodata_begin);
  add("data", image.data_begin, image.data_end - image.data_begin);
  add("bss", bss_begin, image.sizes.bss);
  if (is_at_bottom) {
    add_stack(end);
  } else {
    add("free", end, dma::kLocalStoreBytes - end);
  }
  return map;
}

}  // namespace softcell::ls_sim
