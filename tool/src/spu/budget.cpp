// softcell spu budget: what each kernel takes of its 256 KB.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "kernel_file.h"
#include "softcell/base/whole_file.h"
#include "softcell/dma/addresses.h"
#include "spu_verbs.h"
#include "verb/verb_files.h"

namespace softcell::tool {

int run_budget(const BudgetOptions& options, std::span<const KernelSample> samples) {
  auto document = nlohmann::ordered_json::array();
  std::string over;
  fmt::print("{:<10} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>6} {:>8}\n", "kernel", "text", "rodata",
             "data", "bss", "stack", "stack used", "total", "share", "budget");
  for (const ls_sim::KernelImage& kernel : load_kernels()) {
    const ls_sim::ImageSizes& s = kernel.sizes;
    const std::optional<std::uint32_t> used = measure_stack(kernel, samples);
    fmt::print("{:<10} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>5.1f}% {:>8}\n", kernel.name, s.text,
               s.rodata, s.data, s.bss, s.stack, used ? std::to_string(*used) : "-", s.total(),
               100.0 * s.total() / dma::kLocalStoreBytes, s.budget);
    document.push_back({{"kernel", kernel.name},
                        {"text", s.text},
                        {"rodata", s.rodata},
                        {"data", s.data},
                        {"bss", s.bss},
                        {"stack", s.stack},
                        {"stack_used", used ? nlohmann::ordered_json(*used) : nlohmann::ordered_json()},
                        {"total", s.total()},
                        {"budget", s.budget}});
    if (s.total() > s.budget) {
      over += fmt::format("{}kernel {} is {} bytes over its budget", over.empty() ? "" : "; ", kernel.name,
                          s.total() - s.budget);
    }
  }
  if (options.json) {
    base::WholeFile file(*options.json);
    write_json(file, document);
    file.commit();
  }
  if (!over.empty()) throw std::runtime_error(over);
  return 0;
}

}  // namespace softcell::tool
