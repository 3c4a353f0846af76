#include "coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "host_listing.h"
#include "softcell/ls_sim/source_lines.h"
#include "softcell/ls_sim/spu_listing.h"

namespace softcell::tool {
namespace {

struct Branch {
  std::uint64_t executed, taken;
};
struct Line {
  std::uint64_t executed = 0;
  std::vector<Branch> branches;
};
struct Function {
  std::string name;
  std::uint64_t executed;
};
struct SourceFile {
  std::map<int, Line> lines;
  std::map<int, Function> functions;  ///< by the line of the function's first instruction
};

/// brz, brhnz, bihz, ...: the branches that may go either way.
bool is_conditional(const std::string& mnemonic) {
  if (!mnemonic.starts_with("br") && !mnemonic.starts_with("bi")) return false;
  const std::string condition = mnemonic.substr(2);
  return condition == "z" || condition == "nz" || condition == "hz" || condition == "hnz";
}

/// The instructions of a function, for either machine.
std::vector<CoveredInstruction> instructions_of(const ls_sim::KernelImage& image,
                                                const ls_sim::ImageObject& function) {
  const dma::LocalStoreAddress end{function.begin.value + function.bytes};
  if (image.machine == ls_sim::Machine::kHost) return list_host_instructions(image, function.begin, end);
  std::vector<CoveredInstruction> instructions;
  for (const ls_sim::ListedInstruction& each : ls_sim::list_instructions(image, function.begin, end))
    instructions.push_back({each.address, is_conditional(each.mnemonic)});
  return instructions;
}

std::string text_of(const std::string& name, const SourceFile& file) {
  std::string text = fmt::format("TN:\nSF:{}\n", name);
  for (const auto& [line, function] : file.functions) text += fmt::format("FN:{},{}\n", line, function.name);
  for (const auto& [line, function] : file.functions)
    text += fmt::format("FNDA:{},{}\n", function.executed, function.name);
  text += fmt::format(
      "FNF:{}\nFNH:{}\n", file.functions.size(),
      std::ranges::count_if(file.functions, [](const auto& f) { return f.second.executed != 0; }));
  std::size_t branches = 0, branches_hit = 0, lines_hit = 0;
  for (const auto& [number, line] : file.lines) {
    for (std::size_t i = 0; i < line.branches.size(); ++i) {
      const Branch& branch = line.branches[i];
      const std::uint64_t ways[] = {branch.taken, branch.executed - branch.taken};
      for (int way = 0; way < 2; ++way) {
        text += fmt::format("BRDA:{},{},{},{}\n", number, i, way,
                            branch.executed == 0 ? "-" : std::to_string(ways[way]));
        ++branches;
        if (ways[way] != 0) ++branches_hit;
      }
    }
  }
  text += fmt::format("BRF:{}\nBRH:{}\n", branches, branches_hit);
  for (const auto& [number, line] : file.lines) {
    text += fmt::format("DA:{},{}\n", number, line.executed);
    if (line.executed != 0) ++lines_hit;
  }
  return text + fmt::format("LF:{}\nLH:{}\nend_of_record\n", file.lines.size(), lines_hit);
}

}  // namespace

Coverage::Coverage(const ls_sim::KernelImage& image) : image_(image) {}

/// The address after the instruction at `pc`, where it matters: in a kernel built for the host only after a conditional branch.
std::uint32_t Coverage::behind(std::uint32_t pc) const {
  if (image_.machine == ls_sim::Machine::kSpu) return pc + 4;
  const std::uint32_t at = pc - image_.begin;
  if (pc < image_.begin || at + 1 >= image_.bytes.size()) return kNowhere;
  const auto byte = [&](std::uint32_t i) { return static_cast<unsigned>(image_.bytes[at + i]); };
  // Jcc with 8 and with 32 bits. [AMD64 manual, volume 3] documented
  if ((byte(0) & 0xF0) == 0x70) return pc + 2;
  return byte(0) == 0x0F && (byte(1) & 0xF0) == 0x80 ? pc + 6 : kNowhere;
}

/// In a kernel built for the host this runs in a signal handler.
bool Coverage::on_instruction(int spe, dma::LocalStoreAddress pc) {
  Counts& counts = spes_[static_cast<std::size_t>(spe)];
  if (pc.value == counts.next) ++counts.went_on[counts.last];
  ++counts.executed[pc.value];
  counts.last = pc.value;
  counts.next = behind(pc.value);
  return true;
}

std::uint64_t Coverage::executed(dma::LocalStoreAddress pc) const {
  std::uint64_t sum = 0;
  for (const Counts& counts : spes_) sum += counts.executed[pc.value];
  return sum;
}
std::uint64_t Coverage::went_on(dma::LocalStoreAddress pc) const {
  std::uint64_t sum = 0;
  for (const Counts& counts : spes_) sum += counts.went_on[pc.value];
  return sum;
}

std::string Coverage::lcov() const {
  const ls_sim::SourceLines lines(image_);
  std::map<std::string, SourceFile> files;
  for (const ls_sim::ImageObject& function : ls_sim::code_of(image_)) {
    if (lines.is_in_library(function.begin))
      continue;  // which no user has written, nor need have the sources of
    const ls_sim::SourcePlace begin = lines.source_of(function.begin);
    if (!begin.file.empty() && !function.name.empty())
      files[begin.file].functions.try_emplace(begin.line, Function{function.name, executed(function.begin)});
    for (const CoveredInstruction& instruction : instructions_of(image_, function)) {
      const ls_sim::SourcePlace place = lines.source_of(instruction.address);
      if (place.file.empty() || place.line <= 0) continue;
      Line& line = files[place.file].lines[place.line];
      const std::uint64_t count = executed(instruction.address);
      line.executed = std::max(line.executed, count);
      if (instruction.is_conditional)
        line.branches.push_back({count, count - std::min(count, went_on(instruction.address))});
    }
  }
  if (files.empty())
    throw std::runtime_error("--coverage: " + image_.name +
                             " has no debug information; have the compiler write it (-g)");
  std::string text;
  for (const auto& [name, file] : files) text += text_of(name, file);
  return text;
}

}  // namespace softcell::tool
