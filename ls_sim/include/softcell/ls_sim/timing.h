#pragma once
// The results of the interpreter's timing model: cycles of programs built for the SPU, instruction by instruction, and of their transfers.
// docs/guide/timing.md explains the figures, docs/reference/timing.md the model.
//
//   Timing timing(2);
//   SpeOptions options{.spes = 2};
//   time_by(&timing, options);
//   SpeGroup spes(memory, options);
//   ...
//   const CycleCounts counts = timing.total(0);

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/timing_parameters.h"

namespace softcell::ls_sim {

/// Why no instruction issued in a cycle.
enum class Stall : std::uint8_t {
  kDependency,       ///< on the result of an earlier instruction
  kBranchMiss,       ///< execution continued elsewhere than predicted
  kHintTarget,       ///< a hint came too late before its branch
  kFetch,            ///< the next line of instructions was not fetched yet
  kFloatUnit,        ///< single precision right after a multiply or a conversion
  kDoublePrecision,  ///< after an instruction in double precision
  kLocalStorePort,   ///< a transfer used the local store
  kSync,             ///< sync, dsync
  kTagWait,          ///< MFC_RdTagStat: a transfer was not complete
  kDmaQueue,         ///< MFC_Cmd: the queue was full
  kOtherChannel,     ///< a mailbox, a signal, an event, a list's stall, an atomic command
};
inline constexpr std::size_t kStalls = 11;

/// "tag wait": for tables. "tag_wait": for JSON.
std::string_view name(Stall stall);
std::string_view json_name(Stall stall);

/// Sums over instructions. Each cycle belongs to one instruction: the one that issued in it, the first of a pair, or the one that could not
/// issue.
struct CycleCounts {
  std::uint64_t instructions = 0;
  std::uint64_t cycles = 0;
  std::uint64_t pairs = 0;  ///< cycles in which two instructions issued
  std::array<std::uint64_t, kStalls> stalls{};

  std::uint64_t stalled(Stall stall) const { return stalls[static_cast<std::size_t>(stall)]; }
  std::uint64_t stalled() const;
  /// Cycles per instruction; 0 without instructions.
  double cycles_per_instruction() const;
  /// The share of cycles with any issue in which two instructions issued: 0..1.
  double dual_issue_share() const;
  CycleCounts& operator+=(const CycleCounts& other);
  CycleCounts& operator-=(const CycleCounts& other);  ///< @pre `other` is of an earlier moment
};

/// Cycles that waited for a result, by the kind of instruction that computes it, and counts of branches.
struct PipelineCounts {
  /// In the order of kLatencyClasses.
  std::array<std::uint64_t, 13> dependency{};
  std::uint64_t branches = 0, branches_taken = 0, branch_misses = 0;
  std::uint64_t hints = 0, hints_used = 0;
  std::uint64_t nops = 0;  ///< nop and lnop
};
/// The names of the classes: "FX2", ..., of PipelineCounts::dependency.
inline constexpr std::array<std::string_view, 13> kLatencyClasses{
    "FX2", "FX3", "FXB", "FP6", "FP7", "FPD", "NOP", "SHUF", "LS", "BR", "SPR", "HB", "LNOP"};

/// The transfers of an SPE.
struct TransferCounts {
  std::uint64_t commands = 0;
  std::uint64_t lines = 0;    ///< of 128 bytes that were moved, even if only a part of one was needed
  std::uint64_t latency = 0;  ///< sum over commands: cycles from issue to completion
  std::uint64_t tag_waits = 0, queue_waits = 0, other_waits = 0;  ///< channel operations that waited
};

/// The cycles of one function of a program, without the functions that it calls.
struct FunctionCycles {
  std::string name;  ///< empty: code that no symbol covers
  dma::LocalStoreAddress begin;
  CycleCounts counts;
};

/// The cycles of the jobs of one kernel that a resident kernel has called.
struct KernelCycles {
  std::string kernel = {};
  std::uint64_t jobs = 0;
  std::uint64_t cycles = 0;  ///< from the call to the return
  std::uint64_t waits = 0;   ///< of these: for transfers, the queue and other SPEs
};

class SpeTimer;
class ElementInterconnect;

/// Collects the cycles of up to six SPEs, from its construction on. Read it when the SPEs have stopped, or sleep after
/// SpeGroup::wait_until_idle().
class Timing {
 public:
  /// @param spes  1..6
  explicit Timing(int spes, const TimingParameters& parameters = {});
  ~Timing();
  Timing(const Timing&) = delete;
  Timing& operator=(const Timing&) = delete;

  int spes() const;
  const TimingParameters& parameters() const { return parameters_; }

  // @pre 0 <= spe < spes()
  /// For programs built for the SPU, and for kernels built for the host, of which only waits are known, not instructions.
  CycleCounts total(int spe) const;
  PipelineCounts pipeline(int spe) const;
  TransferCounts transfers(int spe) const;
  /// The SPE's clock: cycles since the construction, including waits for others before its runs.
  std::uint64_t now(int spe) const;
  /// The clock of the SPE that is farthest ahead.
  std::uint64_t now() const;
  /// For all SPEs together, in the order of names.
  std::vector<KernelCycles> by_kernel() const;
  /// For the instruction at this address, whatever program was there.
  CycleCounts at(int spe, dma::LocalStoreAddress instruction) const;
  /// Returns the cycles of each function, the one with the most cycles first. @param image  the image that has run.
  std::vector<FunctionCycles> by_function(int spe, const KernelImage& image) const;

  /// Internal to the emulator: for the SPE's own thread.
  SpeTimer& timer(int spe);

 private:
  const TimingParameters parameters_;
  std::unique_ptr<ElementInterconnect> interconnect_;
  std::vector<std::unique_ptr<SpeTimer>> timers_;
};

}  // namespace softcell::ls_sim
