#pragma once
// Lists programs built for the SPU as text, with their static schedule.

#include <cstdint>
#include <string>
#include <vector>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/timing_parameters.h"

namespace softcell::ls_sim {

/// Whether an instruction issues together with its neighbour in a pair of words.
enum class DualIssue : std::uint8_t {
  kNo,  ///< both need the same pipe, or each needs the other's place
  kYes,
  kPrevented,  ///< the second waits for a result
};

/// An instruction in the static schedule, which assumes that only pipelines and operands take time, and that every branch is predicted or
/// not taken. The first of the instructions issues in cycle 0 with all its operands ready.
struct StaticIssue {
  std::uint64_t cycle = 0;
  std::uint64_t waited_from = 0;  ///< the cycle in which it would issue if its operands were ready
  bool is_even_pipe = true;
  std::uint32_t latency = 1;  ///< cycles until its result may be used
  DualIssue dual = DualIssue::kNo;
};

/// A word of a program, as a listing shows it.
struct ListedInstruction {
  dma::LocalStoreAddress address;
  std::uint32_t word = 0;
  std::string mnemonic, operands;  ///< as GNU objdump writes them; no instruction: ".long" and the word
  /// Additional information: where a branch goes ("main + 0x20"), which branch a hint is for. May be empty.
  std::string note;
  StaticIssue issue;
};

/// The instructions from `begin` to `end`.
/// Any thread. @pre both are multiples of 4, image.begin <= begin <= end <= image.begin + image.bytes.size(), for Machine::kSpu
/// @throws std::runtime_error  the processor lacks AVX2.
std::vector<ListedInstruction> list_instructions(const KernelImage& image, dma::LocalStoreAddress begin,
                                                 dma::LocalStoreAddress end,
                                                 const TimingParameters& parameters = {});

/// The functions of an image that have instructions, in order of address: each ends where the next begins, and the last one at the end of
/// the code. Code before the first one has no name.
std::vector<ImageObject> code_of(const KernelImage& image);

/// A line in the layout of spu_timing: pipe; D for one of two that issue together, d if that is prevented; then 50 columns, with the last
/// digits of the cycles from issue to result in the columns of these cycles modulo 50, and dashes where the instruction waits. [IBM SDK
/// tutorial, static analysis] documented
std::string timing_line(const ListedInstruction& instruction);

}  // namespace softcell::ls_sim
