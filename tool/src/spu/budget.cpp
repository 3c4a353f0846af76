// softcell spu budget: what each kernel takes of its 256 KB.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel_file.h"
#include "softcell/dma/addresses.h"
#include "spu_verbs.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

struct BudgetRow {
  ls_sim::KernelImage kernel;
  std::optional<std::uint32_t> stack_used;  ///< bytes; none: it was not measured
};

/// Only work that softcell has for a kernel of its own can measure its stack; another kernel may have the
/// same name.
BudgetRow budget_row(const std::string& kernel, bool checked, std::span<const KernelSample> samples) {
  BudgetRow row{load_kernel_file(kernel, checked), {}};
  if (!find_kernel_file(kernel, checked) && !row.kernel.checked)
    row.stack_used = measure_stack(row.kernel, samples);
  return row;
}

std::vector<BudgetRow> budget_rows(const BudgetOptions& options, std::span<const KernelSample> samples) {
  const std::vector<std::string> kernels =
      options.kernels.empty() ? built_in_kernels(options.checked) : options.kernels;
  std::vector<BudgetRow> rows;
  for (const std::string& kernel : kernels) rows.push_back(budget_row(kernel, options.checked, samples));
  return rows;
}

void print_table(const std::vector<BudgetRow>& rows) {
  std::size_t width = 10;
  for (const BudgetRow& row : rows) width = std::max(width, row.kernel.name.size());
  fmt::print("{:<{}} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>6} {:>8}\n", "kernel", width, "text",
             "rodata", "data", "bss", "stack", "stack used", "total", "share", "budget");
  bool any_checked = false;
  for (const auto& [kernel, used] : rows) {
    const ls_sim::ImageSizes& s = kernel.sizes;
    fmt::print("{:<{}} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>5.1f}% {:>8}\n", kernel.name, width,
               s.text, s.rodata, s.data, s.bss, s.stack, used ? std::to_string(*used) : "-", s.total(),
               100.0 * s.total() / dma::kLocalStoreBytes, s.budget);
    any_checked = any_checked || kernel.checked;
  }
  if (any_checked)
    fmt::print(
        "\nThe stack of an instrumented flavour is {} bytes larger than the kernel declares, for the checks; "
        "its budget is the whole local store.\n",
        kCheckStackBytes);
}

nlohmann::ordered_json to_json(const BudgetRow& row) {
  const ls_sim::ImageSizes& s = row.kernel.sizes;
  return {{"kernel", row.kernel.name},
          {"checked", row.kernel.checked},
          {"text", s.text},
          {"rodata", s.rodata},
          {"data", s.data},
          {"bss", s.bss},
          {"stack", s.stack},
          {"stack_for_checks", stack_for_checks(row.kernel)},
          {"stack_used", row.stack_used ? nlohmann::ordered_json(*row.stack_used) : nlohmann::ordered_json()},
          {"total", s.total()},
          {"budget", s.budget}};
}

/// A sentence for each kernel that passes its budget; empty: none does.
std::string over_budget(const std::vector<BudgetRow>& rows) {
  std::string sentences;
  for (const BudgetRow& row : rows) {
    const ls_sim::ImageSizes& s = row.kernel.sizes;
    if (s.total() <= s.budget) continue;
    sentences += fmt::format("{}kernel {} is {} bytes over its budget", sentences.empty() ? "" : "; ",
                             row.kernel.name, s.total() - s.budget);
  }
  return sentences;
}

}  // namespace

int run_budget(const BudgetOptions& options, std::span<const KernelSample> samples) {
  std::vector<NamedFile> read;
  for (const std::string& kernel : options.kernels)
    read.push_back({kernel, find_kernel_file(kernel, options.checked)});
  check_kept(read, {{"--json", options.json}});
  OutputFiles files({{"--json", options.json}});
  const std::vector<BudgetRow> rows = budget_rows(options, samples);
  print_table(rows);
  if (options.json) {
    auto document = nlohmann::ordered_json::array();
    for (const BudgetRow& row : rows) document.push_back(to_json(row));
    write_json(files.open(*options.json), document);
    files.commit();
  }
  if (const std::string sentences = over_budget(rows); !sentences.empty())
    throw std::runtime_error(sentences);
  return 0;
}

}  // namespace softcell::tool
