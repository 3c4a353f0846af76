// softcell spu budget: shows how much each kernel takes of its 256 KB.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel_runs/kernel_file.h"
#include "kernel_runs/kernel_timing.h"
#include "softcell/dma/addresses.h"
#include "spu_verbs.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

/// A kernel as one of the compilers has built it.
struct Build {
  ls_sim::KernelImage kernel;
  std::optional<SampleNeeds> needs;  ///< none: they were not measured
};

struct BudgetRow {
  Build build;
  std::optional<Build> on_spu;  ///< the same kernel built for the SPU, for softcell's own kernels
};

/// The stack is only measured for softcell's own kernels, for which there is work; a kernel from a file may have the same name.
BudgetRow budget_row(const std::string& kernel, bool checked, std::span<const KernelSample> samples) {
  BudgetRow row{{load_kernel_file(kernel, checked), {}}, {}};
  if (find_kernel_file(kernel, checked) || row.build.kernel.checked) return row;
  row.build.needs = measure(row.build.kernel, samples);
  if (!is_built_for_spu(kernel)) return row;
  row.on_spu = Build{load_kernel_file(kernel, false, ls_sim::Machine::kSpu), {}};
  row.on_spu->needs = measure(row.on_spu->kernel, samples);
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
  for (const BudgetRow& row : rows) width = std::max(width, row.build.kernel.name.size());
  const bool any_on_spu =
      std::ranges::any_of(rows, [](const BudgetRow& row) { return row.on_spu.has_value(); });
  fmt::print("{:<{}} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>6} {:>8}{}\n", "kernel", width, "text",
             "rodata", "data", "bss", "stack", "stack used", "total", "share", "budget",
             any_on_spu ? " | SPU: text  stack used   total  share  cycles" : "");
  bool any_stack_for_checks = false;
  const auto stack = [](const std::optional<SampleNeeds>& needs) {
    return needs ? std::to_string(needs->stack) : "-";
  };
  for (const auto& [build, on_spu] : rows) {
    const auto& [kernel, needs] = build;
    const ls_sim::ImageSizes& s = kernel.sizes;
    fmt::print("{:<{}} {:>7} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>5.1f}% {:>8}", kernel.name, width,
               s.text, s.rodata, s.data, s.bss, s.stack, stack(needs), s.total(),
               100.0 * s.total() / dma::kLocalStoreBytes, s.budget);
    if (on_spu) {
      const ls_sim::ImageSizes& there = on_spu->kernel.sizes;
      fmt::print(" | {:>9} {:>11} {:>7} {:>5.1f}%", there.text, stack(on_spu->needs), there.total(),
                 100.0 * there.total() / dma::kLocalStoreBytes);
      if (on_spu->needs && on_spu->needs->cycles)
        fmt::print("  {:.0f} a {}", *on_spu->needs->cycles, on_spu->needs->piece);
    }
    fmt::print("\n");
    any_stack_for_checks = any_stack_for_checks || stack_for_checks(kernel) != 0;
  }
  if (any_stack_for_checks)
    fmt::print(
        "\nThe stack of a checked image is {} bytes larger than the kernel declares, for the checks; "
        "its budget is the whole local store.\n",
        kCheckStackBytes);
}

void print_functions_of(const BudgetRow& row) {
  if (!row.on_spu || !row.on_spu->needs) return;
  const SampleNeeds& needs = *row.on_spu->needs;
  print_functions(fmt::format("{}, {} times a {}", row.build.kernel.name, needs.pieces, needs.piece),
                  needs.functions);
}

nlohmann::ordered_json to_json(const Build& build) {
  const ls_sim::ImageSizes& s = build.kernel.sizes;
  nlohmann::ordered_json fields{
      {"kernel", build.kernel.name},
      {"checked", build.kernel.checked},
      {"text", s.text},
      {"rodata", s.rodata},
      {"data", s.data},
      {"bss", s.bss},
      {"stack", s.stack},
      {"stack_for_checks", stack_for_checks(build.kernel)},
      {"stack_used", build.needs ? nlohmann::ordered_json(build.needs->stack) : nlohmann::ordered_json()},
      {"total", s.total()},
      {"budget", s.budget}};
  if (build.needs && build.needs->cycles) {
    fields["cycles"] = *build.needs->cycles;
    fields["cycles_for"] = build.needs->piece;
    fields["pieces"] = build.needs->pieces;
    fields["functions"] = tool::to_json(build.needs->functions);
  }
  return fields;
}

nlohmann::ordered_json to_json(const BudgetRow& row) {
  nlohmann::ordered_json fields = to_json(row.build);
  fields["spu"] = row.on_spu ? to_json(*row.on_spu) : nlohmann::ordered_json();
  return fields;
}

/// A sentence for each kernel that exceeds its budget; empty: none does.
std::string over_budget(const std::vector<BudgetRow>& rows) {
  std::string sentences;
  const auto look_at = [&](const Build& build, const char* where) {
    const ls_sim::ImageSizes& s = build.kernel.sizes;
    if (s.total() <= s.budget) return;
    sentences += fmt::format("{}kernel {} is{} {} bytes over its budget", sentences.empty() ? "" : "; ",
                             build.kernel.name, where, s.total() - s.budget);
  };
  for (const BudgetRow& row : rows) {
    look_at(row.build, "");
    if (row.on_spu) look_at(*row.on_spu, " on the SPU");
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
  if (options.functions)
    for (const BudgetRow& row : rows) print_functions_of(row);
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
