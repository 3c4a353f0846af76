#include "function_names.h"

#include <cxxabi.h>

#include <algorithm>
#include <cstdlib>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ls_sim {

std::string demangled(std::string_view symbol) {
  constexpr std::size_t kLongestName = 1024;  // a longer one stays as it is
  std::string name(symbol);
  // The function also reads names of types: to it a function `f` of C is "float". [Itanium C++ ABI, mangling] documented
  if (!symbol.starts_with("_Z") || name.size() > kLongestName) return name;
  int status = 0;
  char* const text = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  SC_ASSERT(status != 0 || text != nullptr, "a name of {} characters is demangled to nothing", name.size());
  if (status == 0) name = text;
  std::free(text);
  return name;
}

const ImageObject* function_of(const KernelImage& image, dma::LocalStoreAddress address) {
  if (address.value < image.text_begin || address.value >= image.text_end) return nullptr;
  const auto behind = std::upper_bound(
      image.functions.begin(), image.functions.end(), address,
      [](dma::LocalStoreAddress at, const ImageObject& function) { return at < function.begin; });
  return behind == image.functions.begin() ? nullptr : &*(behind - 1);
}

std::string function_at(const KernelImage& image, dma::LocalStoreAddress address) {
  const ImageObject* const function = function_of(image, address);
  if (function == nullptr) return {};
  const std::uint32_t offset = address.value - function->begin.value;
  if (offset == 0) return function->name;
  return function->name + " + " + base::hex(offset);
}

}  // namespace softcell::ls_sim
