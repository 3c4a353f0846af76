#include "function_names.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace softcell::ls_sim {

std::string function_at(const KernelImage& image, dma::LocalStoreAddress address) {
  if (address.value < image.text_begin || address.value >= image.text_end) return {};
  const auto behind = std::upper_bound(
      image.functions.begin(), image.functions.end(), address,
      [](dma::LocalStoreAddress at, const ImageObject& function) { return at < function.begin; });
  if (behind == image.functions.begin()) return {};
  const ImageObject& function = *(behind - 1);
  const std::uint32_t offset = address.value - function.begin.value;
  if (offset == 0) return function.name;
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), " + 0x%X", offset);
  return function.name + text.data();
}

}  // namespace softcell::ls_sim
