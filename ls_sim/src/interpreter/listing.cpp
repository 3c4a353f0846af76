// Programs as text, with their static schedule.

#include <algorithm>
#include <string>
#include <vector>

#include "disassembler.h"
#include "image/function_names.h"
#include "pipeline.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/spu_listing.h"

namespace softcell::ls_sim {
namespace {

using namespace interpreter;

constexpr std::uint32_t kWordBytes = 4;
constexpr std::size_t kColumns = 50;

std::uint32_t word_at(const KernelImage& image, std::uint32_t address) {
  std::uint32_t word = 0;
  for (std::uint32_t i = 0; i < kWordBytes; ++i)
    word = word << 8 | static_cast<std::uint32_t>(image.bytes[address - image.begin + i]);
  return word;
}

/// The note on the target of a branch whose word says it.
std::string target_note(const KernelImage& image, const Operation& op, std::uint32_t address) {
  const InstructionInfo& info = info_of(op.mnemonic);
  if (info.kind != Kind::kJump || info.format != Format::kRi16) return {};
  const bool is_absolute = op.mnemonic == Mnemonic::bra || op.mnemonic == Mnemonic::brasl;
  const std::uint32_t target =
      ((is_absolute ? 0 : address) + (static_cast<std::uint32_t>(op.imm) << 2)) & kInstructionMask;
  return function_at(image, {target});
}

std::string hint_note(const KernelImage& image, const Operation& op, std::uint32_t address) {
  if (info_of(op.mnemonic).latency != LatencyClass::kHb) return {};
  if (op.mnemonic == Mnemonic::hbr && (op.rb & kFeatureBit) != 0) return "lets the next line be fetched";
  const std::uint32_t branch =
      (address + (static_cast<std::uint32_t>(hint_distance(op)) << 2)) & kInstructionMask;
  if (branch < image.begin || branch - image.begin + kWordBytes > image.bytes.size())
    return "for " + base::hex(branch);
  const Operation hinted = decode(word_at(image, branch));
  return "for " + base::hex(branch) + ", " + disassemble(hinted, branch);
}

std::string note_of(const KernelImage& image, const Operation& op, std::uint32_t address) {
  if (op.mnemonic == Mnemonic::invalid) return {};
  const std::string hint = hint_note(image, op, address);
  return hint.empty() ? target_note(image, op, address) : hint;
}

/// A pair that would issue together if the second word had its operands.
bool may_pair(const ListedInstruction& first, const ListedInstruction& second) {
  return first.address.value % 8 == 0 && second.address.value == first.address.value + kWordBytes &&
         first.issue.is_even_pipe && !second.issue.is_even_pipe;
}

}  // namespace

std::vector<ListedInstruction> list_instructions(const KernelImage& image, dma::LocalStoreAddress begin,
                                                 dma::LocalStoreAddress end,
                                                 const TimingParameters& parameters) {
  SC_ASSERT(image.machine == Machine::kSpu && begin.value % kWordBytes == 0 && end.value % kWordBytes == 0,
            "instructions of {} from {} to {}", image.name, begin, end);
  SC_ASSERT(
      image.begin <= begin.value && begin.value <= end.value && end.value <= image.begin + image.bytes.size(),
      "instructions of {} from {} to {}; it has {} bytes from {} on", image.name, begin, end,
      image.bytes.size(), image.begin);
  require_vector_units(__builtin_cpu_supports("avx2") != 0, __builtin_cpu_supports("fma") != 0);
  ElementInterconnect interconnect(parameters);
  SpeTimer timer(0, interconnect, parameters);
  IssueModel model(timer, nullptr);
  model.begin_run(begin.value);
  std::vector<ListedInstruction> listed;
  std::uint64_t first_cycle = 0;
  for (std::uint32_t address = begin.value; address < end.value; address += kWordBytes) {
    ListedInstruction& line = listed.emplace_back();
    line.address = {address};
    line.word = word_at(image, address);
    const Operation op = decode(line.word);
    const std::string text = disassemble(op, address);
    const std::size_t space = text.find(' ');
    line.mnemonic = text.substr(0, space);
    if (space != std::string::npos) line.operands = text.substr(text.find_first_not_of(' ', space));
    line.note = note_of(image, op, address);
    const std::uint64_t previous = model.last_issue();
    model.on_instruction(op, address);
    if (listed.size() == 1) first_cycle = model.last_issue();
    line.issue.is_even_pipe = op.mnemonic == Mnemonic::invalid || is_even_pipe(info_of(op.mnemonic).latency);
    line.issue.latency = model.latency_of(op);
    line.issue.cycle = model.last_issue() - first_cycle;
    line.issue.waited_from = listed.size() == 1 ? 0 : std::min(previous + 1 - first_cycle, line.issue.cycle);
    if (listed.size() == 1) continue;
    ListedInstruction& before = listed[listed.size() - 2];
    if (!may_pair(before, line)) continue;
    before.issue.dual = line.issue.dual = model.was_pair() ? DualIssue::kYes : DualIssue::kPrevented;
    line.issue.waited_from = before.issue.cycle;
  }
  return listed;
}

std::vector<ImageObject> code_of(const KernelImage& image) {
  const std::uint32_t unit = image.machine == Machine::kSpu ? kWordBytes : 1;
  const std::uint32_t begin = (image.text_begin + unit - 1) / unit * unit;
  const std::uint32_t end =
      std::min(image.text_end, image.begin + static_cast<std::uint32_t>(image.bytes.size())) / unit * unit;
  std::vector<ImageObject> parts;
  const auto add = [&](const std::string& name, std::uint32_t from) {
    if (!parts.empty() && parts.back().begin.value == from) return;  // two names of one function
    parts.push_back({name, {from}, 0});
  };
  if (begin < end) add("", begin);
  for (const ImageObject& function : image.functions) {
    if (function.begin.value < begin || function.begin.value >= end || function.begin.value % unit != 0)
      continue;
    if (function.begin.value == begin) parts.clear();
    add(function.name, function.begin.value);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::uint32_t next = i + 1 < parts.size() ? parts[i + 1].begin.value : end;
    parts[i].bytes = next - parts[i].begin.value;
  }
  return parts;
}

std::string timing_line(const ListedInstruction& instruction) {
  const StaticIssue& issue = instruction.issue;
  std::string columns(kColumns, ' ');
  const std::uint64_t wait = std::min<std::uint64_t>(issue.cycle - issue.waited_from, kColumns);
  for (std::uint64_t cycle = issue.cycle - wait; cycle < issue.cycle; ++cycle)
    columns[cycle % kColumns] = '-';
  for (std::uint64_t cycle = issue.cycle; cycle < issue.cycle + issue.latency; ++cycle)
    columns[cycle % kColumns] = static_cast<char>('0' + cycle % 10);
  std::string line(1, issue.is_even_pipe ? '0' : '1');
  line += issue.dual == DualIssue::kYes ? 'D' : issue.dual == DualIssue::kPrevented ? 'd' : ' ';
  return line + " " + columns;
}

}  // namespace softcell::ls_sim
