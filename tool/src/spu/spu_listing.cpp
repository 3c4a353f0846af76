// softcell spu timing and disasm: list instructions, the cycles in which they issue, and the cycles that they took in a run.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernel_report.h"
#include "kernel_runs/kernel_file.h"
#include "kernel_runs/kernel_run.h"
#include "kernel_runs/kernel_timing.h"
#include "softcell/base/nearest_name.h"
#include "softcell/ls_sim/spu_listing.h"
#include "spu_verbs.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

using ls_sim::CycleCounts;
using ls_sim::DualIssue;
using ls_sim::ListedInstruction;
using nlohmann::ordered_json;

/// A function and its instructions.
struct Part {
  std::string name;
  std::vector<ListedInstruction> instructions;
};

ls_sim::KernelImage load_program(const SpuListingOptions& options, const char* verb) {
  ls_sim::KernelImage image =
      load_kernel_file(options.task.image, options.task.checked, options.task.machine);
  if (image.machine == ls_sim::Machine::kSpu) return image;
  const bool has_other_build =
      std::string_view(verb) == "timing" && !find_kernel_file(options.task.image, false);
  throw std::runtime_error(fmt::format(
      "spu {} {}: this image is built for the host; give a program that a compiler for the SPU has made{}",
      verb, options.task.image,
      has_other_build ? ", or --engine interpreter for softcell's own build for the SPU" : ""));
}

/// Whether the name is the function's: "step_body" matches "step_body(float, Map const&)" as well.
bool is_called(const std::string& function, const std::string& name) {
  return function == name || function.substr(0, function.find('(')) == name;
}

std::vector<Part> parts_of(const ls_sim::KernelImage& image, const std::string& wanted) {
  std::vector<Part> parts;
  std::vector<std::string_view> names;
  const std::vector<ls_sim::ImageObject> functions = ls_sim::code_of(image);
  for (const ls_sim::ImageObject& function : functions) {
    names.push_back(function.name);
    if (!wanted.empty() && !is_called(function.name, wanted)) continue;
    parts.push_back({function.name, ls_sim::list_instructions(image, function.begin,
                                                              {function.begin.value + function.bytes})});
  }
  if (!parts.empty()) return parts;
  if (wanted.empty()) throw std::runtime_error(image.name + " has no instructions");
  const std::string_view nearest = base::nearest_name(wanted, names);
  throw std::runtime_error(fmt::format("--function {}: {} has no function of that name{}", wanted, image.name,
                                       nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
}

const char* mark(DualIssue dual) {
  switch (dual) {
    case DualIssue::kYes:
      return "issued with its neighbour";
    case DualIssue::kPrevented:
      return "kept from its neighbour";
    default:
      return "alone";
  }
}

/// The name of the stall that took most of an instruction's cycles.
std::string worst_stall(const CycleCounts& counts) {
  const auto most = std::ranges::max_element(counts.stalls);
  if (*most == 0) return {};
  const auto stall = static_cast<ls_sim::Stall>(most - counts.stalls.begin());
  return fmt::format("{} {}", ls_sim::name(stall), *most);
}

std::string text_of(const ListedInstruction& line) {
  return fmt::format("{:<10}{}", line.mnemonic, line.operands);
}

/// The sum over the SPEs that have run the program.
CycleCounts counts_at(const ls_sim::Timing& timing, dma::LocalStoreAddress address) {
  CycleCounts sum;
  for (int spe = 0; spe < timing.spes(); ++spe) sum += timing.at(spe, address);
  return sum;
}

void print_schedule(const std::vector<Part>& parts, const ls_sim::Timing* timing) {
  if (timing != nullptr) fmt::print("{:>12} {:>12} ", "executed", "cycles");
  fmt::print("{:>7} {:>6} {}\n", "address", "cycle", "pipe and columns of 50 cycles");
  for (const Part& part : parts) {
    fmt::print("\n{}:\n", part.name.empty() ? "(no symbol)" : part.name);
    for (const ListedInstruction& line : part.instructions) {
      std::string remark = line.note;
      if (timing != nullptr) {
        const CycleCounts counts = counts_at(*timing, line.address);
        fmt::print("{:>12} {:>12} ", counts.instructions, counts.cycles);
        const std::string stall = worst_stall(counts);
        if (!stall.empty()) remark += (remark.empty() ? "" : "; ") + stall;
      }
      fmt::print("0x{:05X} {:06} {}      {}", line.address.value, line.issue.cycle, ls_sim::timing_line(line),
                 text_of(line));
      fmt::print("{}{}\n", remark.empty() ? "" : "   # ", remark);
    }
  }
}

void print_disassembly(const std::vector<Part>& parts, bool with_schedule) {
  bool first = true;
  for (const Part& part : parts) {
    fmt::print("{}{}:\n", first ? "" : "\n", part.name.empty() ? "(no symbol)" : part.name);
    first = false;
    for (const ListedInstruction& line : part.instructions) {
      fmt::print("0x{:05X}  {:08x}  ", line.address.value, line.word);
      if (with_schedule) fmt::print("{:>6} {}  ", line.issue.cycle, ls_sim::timing_line(line).substr(0, 2));
      fmt::print("{}{}{}\n", text_of(line), line.note.empty() ? "" : "   # ", line.note);
    }
  }
}

ordered_json json_of(const ListedInstruction& line, bool with_schedule, const ls_sim::Timing* timing) {
  ordered_json row{{"address", line.address.value},
                   {"word", line.word},
                   {"mnemonic", line.mnemonic},
                   {"operands", line.operands},
                   {"note", line.note}};
  if (with_schedule) {
    row["cycle"] = line.issue.cycle;
    row["pipe"] = line.issue.is_even_pipe ? 0 : 1;
    row["latency"] = line.issue.latency;
    row["dual"] = mark(line.issue.dual);
  }
  if (timing != nullptr) row["run"] = tool::to_json(counts_at(*timing, line.address));
  return row;
}

ordered_json json_of(const std::vector<Part>& parts, bool with_schedule, const ls_sim::Timing* timing) {
  ordered_json document = ordered_json::array();
  for (const Part& part : parts) {
    ordered_json instructions = ordered_json::array();
    for (const ListedInstruction& line : part.instructions)
      instructions.push_back(json_of(line, with_schedule, timing));
    document.push_back({{"function", part.name}, {"instructions", std::move(instructions)}});
  }
  return document;
}

void write_to_standard_output(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace

int run_spu_timing(const SpuListingOptions& options) {
  const KernelTask& task = options.task;
  std::vector<NamedFile> outputs = written_files(task);
  outputs.push_back({"--json", options.json});
  check_kept(read_files(task), outputs);
  OutputFiles files(outputs);
  const ls_sim::KernelImage image = load_program(options, "timing");
  const std::vector<Part> parts = parts_of(image, options.function);

  std::optional<ls_sim::Timing> timing;
  std::optional<KernelRun> run;
  dma::AddressSpace memory;
  std::optional<KernelBuffers> buffers;
  if (!options.is_static) {
    timing.emplace(task.spes);
    buffers.emplace(memory, task);
    const ls_sim::HostCalls host_calls{.standard_output = write_to_standard_output,
                                       .standard_error = write_to_standard_output,
                                       .standard_input = {},
                                       .folder = {}};
    run = run_kernel(memory, image, *buffers, task,
                     {.schedule = options.schedule,
                      .timing = &*timing,
                      .host_calls = options.host_calls ? &host_calls : nullptr});
  }

  const ls_sim::Timing* const counted = timing ? &*timing : nullptr;
  print_schedule(parts, counted);
  if (timing) print_timing(image, *timing);
  const int status = run ? exit_status(image, *run) : 0;
  if (run) print_problems(image, *run);
  if (run && status == 0) buffers->write_files(files);
  if (options.json) {
    ordered_json document{{"program", image.name}, {"functions", json_of(parts, true, counted)}};
    if (run) {
      document["exit_status"] = status;
      document["timing"] = to_json(image, *timing);
    }
    write_json(files.open(*options.json), document);
  }
  files.commit();
  return status;
}

int run_spu_disasm(const SpuListingOptions& options) {
  check_kept(read_files(options.task), {{"--json", options.json}});
  OutputFiles files({{"--json", options.json}});
  const ls_sim::KernelImage image = load_program(options, "disasm");
  const std::vector<Part> parts = parts_of(image, options.function);
  print_disassembly(parts, options.with_schedule);
  if (options.json) {
    write_json(files.open(*options.json),
               {{"program", image.name}, {"functions", json_of(parts, options.with_schedule, nullptr)}});
    files.commit();
  }
  return 0;
}

}  // namespace softcell::tool
