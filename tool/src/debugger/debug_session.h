#pragma once
// A run that a debugger can stop, and that goes backwards by running again.

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "kernel_runs/kernel_run.h"
#include "kernel_runs/kernel_task.h"
#include "softcell/ls_sim/debugger.h"

namespace softcell::tool {

/// Accesses that stop the run: those to some bytes of each local store.
struct Watchpoint {
  enum Kind : std::uint8_t { kStores, kLoads, kBoth };
  Kind kind = kStores;
  std::uint32_t begin = 0, bytes = 0;
  bool operator==(const Watchpoint&) const = default;
};

/// The reason why the SPEs stand still.
struct DebugStop {
  enum Kind : std::uint8_t { kStep, kBreakpoint, kWatchpoint, kInterrupted, kBeginning, kFault, kEnded };
  Kind kind = kStep;
  int spe = 0;                 ///< the SPE whose instruction is next; for kFault, the one that has failed
  Watchpoint watchpoint = {};  ///< of kWatchpoint
};

/// SPEs take turns by the schedule's seed and the clock is simulated, so the program does the same in every run: each instruction has a
/// number, and going back means running again up to a smaller number. What the debugger has written to registers and local stores is
/// written again at the same instruction. One thread uses the session, besides those of the SPEs.
class DebugSession final : private ls_sim::Debugger {
 public:
  /// Called while SPEs run; if it returns true, they stop.
  using Interrupted = std::function<bool()>;

  /// @param image, task, settings  must outlive this object. The image is a program built for the SPU.
  DebugSession(const ls_sim::KernelImage& image, const KernelTask& task, const RunSettings& settings);
  ~DebugSession() override { abandon(); }
  DebugSession(const DebugSession&) = delete;
  DebugSession& operator=(const DebugSession&) = delete;

  /// Starts the run, and stops before the first instruction.
  DebugStop start();

  // @pre the last stop was not kEnded
  // A program that fails stops twice: first before the last instruction of the run (kFault), and when it goes on from there, at its end
  // (kEnded).
  DebugStop go_on(const Interrupted& interrupted);
  /// Executes one instruction of this SPE; other SPEs may execute some meanwhile. If that is its last one, the next SPE stops.
  /// @pre  !has_ended(spe)
  DebugStop step(int spe, const Interrupted& interrupted);
  /// Goes back to the last stop before this instruction; if there is none, to the beginning.
  DebugStop go_back(const Interrupted& interrupted);
  DebugStop step_back(const Interrupted& interrupted);

  /// Runs to the end without stops.
  DebugStop finish();

  void set_breakpoint(std::uint32_t address, bool is_set) { breakpoints_[address / 4] = is_set; }
  void set_watchpoint(const Watchpoint& watchpoint, bool is_set);

  // While the run stands still:
  int spes() const { return task_.spes; }
  /// Whether an SPE runs: false before its first instruction and after its end.
  bool is_running(int spe) const { return states_[index(spe)] != nullptr; }
  /// An SPE begins with its first turn.
  bool has_ended(int spe) const { return ended_[index(spe)]; }
  /// The address of the instruction that the SPE is at: the next one, or one that waits.
  std::uint32_t position(int spe) const { return positions_[index(spe)]; }
  ls_sim::RegisterBytes read_register(int spe, int number) const;
  /// These functions do nothing for an SPE that does not run.
  void write_register(int spe, int number, const ls_sim::RegisterBytes& value);
  /// @pre the range lies in the local store
  /// Of an SPE that has not begun, what its image has there.
  std::vector<std::byte> read_memory(int spe, std::uint32_t address, std::uint32_t bytes) const;
  void write_memory(int spe, std::uint32_t address, const std::vector<std::byte>& bytes);
  /// The number of the next instruction; the first one has number 1.
  std::uint64_t instruction() const { return count_; }

  /// After kEnded or kFault.
  const KernelRun& result() const { return *result_; }
  std::vector<std::string> failures() const { return result_->failures(image_); }

 private:
  struct Edit {
    std::uint64_t at;  ///< before this instruction
    int spe;
    std::variant<int, std::uint32_t> where;  ///< register, or address
    std::vector<std::byte> bytes;
  };
  /// The aim of the threads of SPEs.
  struct Goal {
    enum Kind : std::uint8_t { kStops, kStepOf, kNumber, kLastStopBefore, kEnd };
    Kind kind = kStops;
    int spe = 0;
    std::uint64_t number = 0;
    bool must_begin = false;  ///< kStepOf: the SPE's first instruction is the one to be executed
  };

  static std::size_t index(int spe) { return static_cast<std::size_t>(spe); }

  // ls_sim::Debugger; the threads of SPEs call these, one at a time.
  void on_begin(int spe, ls_sim::DebuggedSpe& state) override { states_[index(spe)] = &state; }
  void on_end(int spe) override {
    states_[index(spe)] = nullptr;
    ended_[index(spe)] = true;
  }
  bool on_instruction(int spe, dma::LocalStoreAddress pc) override;
  void on_access(int spe, dma::LocalStoreAddress quadword, bool is_store) override;

  std::optional<DebugStop> stop_at(int spe, std::uint32_t pc);
  bool stand(const DebugStop& stop);
  void apply(const Edit& edit);
  void edit(Edit made);

  void begin(const Goal& goal);
  DebugStop run_to(const Goal& goal, const Interrupted& interrupted);
  DebugStop back_before_a_fault(const DebugStop& stop, const Interrupted& interrupted);
  DebugStop run_again_to(std::uint64_t number, const Interrupted& interrupted);
  DebugStop wait(const Interrupted& interrupted);
  void abandon();

  const ls_sim::KernelImage& image_;
  const KernelTask& task_;
  RunSettings settings_;

  // The SPEs' threads use these while they run, and the session's thread while they stand still.
  std::array<ls_sim::DebuggedSpe*, dma::kSpeCount> states_{};
  std::array<bool, dma::kSpeCount> ended_{};
  std::array<std::uint32_t, dma::kSpeCount> positions_{};
  std::uint64_t count_ = 0;
  std::uint64_t shown_fault_ = 0;  ///< the instruction that the last kFault stood before; 0: none
  Goal goal_;
  std::optional<Watchpoint> accessed_;  ///< by the previous instruction
  std::optional<DebugStop> best_;       ///< for kLastStopBefore
  std::uint64_t best_number_ = 0;
  std::vector<bool> breakpoints_ = std::vector<bool>(dma::kLocalStoreBytes / 4);
  std::vector<Watchpoint> watchpoints_;
  std::vector<Edit> edits_;  ///< in order

  std::atomic<bool> abandoned_{false}, interrupt_{false};
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  enum class State : std::uint8_t { kRunning, kStanding, kEnded };
  State state_ = State::kEnded;
  DebugStop stop_;
  std::optional<KernelRun> result_;
  std::jthread runner_;
};

}  // namespace softcell::tool
