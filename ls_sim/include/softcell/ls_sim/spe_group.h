#pragma once
// Up to six SPEs that the PPU side starts one by one, and the problem state of each: mailboxes, signals,
// proxy DMA, local store. For jobs that any SPE may run, see softcell/jobs/job_system.h.
//
//   SpeGroup spes(memory, {.spes = 2});
//   spes.start(0, image, {.spe_id = 0, .argp = data.ea().value});
//   spes.problem_state(0).write_in_mbox(42);
//   const RunResult result = spes.wait(0);
//
// Deadlocks: if all SPEs wait at channels and nothing is in flight, only the PPU side can wake them. If the
// PPU side then waits as well (in a function below whose name or comment says "wait"), each SPE stops with a
// fault that says which SPE waits for what. If several threads act as the PPU, each keeps an Outside object
// meanwhile.
//
// With Interleaving::kTurns, SPEs run only while the PPU side waits in such a function, and for a while after
// it has found a mailbox empty or polled a status. So a run is the same every time if one thread acts as the
// PPU.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "softcell/dma/address_space.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_command.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/statistics.h"

namespace softcell::ls_sim {

/// How a signal register combines a written value with an unread one. [CBEA, signal notification] documented
enum class SignalMode : std::uint8_t { kOverwrite, kOr };

/// One SPE as the PPU sees it. Any thread. [CBEA, problem state area] documented
class ProblemState {
 public:
  virtual ~ProblemState() = default;

  /// Reads an outbound mailbox, which holds 1 value: the value, or nothing if it is empty.
  virtual std::optional<std::uint32_t> read_out_mbox() = 0;
  virtual std::optional<std::uint32_t> read_out_intr_mbox() = 0;

  /// Waits for a value. @return  nothing if the SPE has stopped without writing one.
  virtual std::optional<std::uint32_t> wait_out_mbox() = 0;
  virtual std::optional<std::uint32_t> wait_out_intr_mbox() = 0;

  /// Writes to the inbound mailbox, which holds 4 values. If it is full, the value replaces the newest.
  virtual void write_in_mbox(std::uint32_t value) = 0;

  /// Values in the outbound mailbox | free slots of the inbound one << 8 | values in the outbound-interrupt
  /// one << 16.
  virtual std::uint32_t mbox_status() = 0;

  /// @param which  1 or 2. @throws std::invalid_argument  it is another number.
  virtual void write_signal(int which, std::uint32_t value) = 0;
  /// How a signal register takes what is written. @throws as write_signal()
  virtual void set_signal_mode(int which, SignalMode mode) = 0;

  /// Issues a proxy DMA command. The queue has 8 slots and waits while it is full. It accepts no lists, and
  /// of the line commands only putqlluc. A command with start begins the run of a prepared SPE when its bytes
  /// have moved.
  /// @return  nothing, or a fault; then the command is not queued.
  virtual std::optional<dma::Fault> issue_proxy(const dma::MfcCommand& command) = 0;

  /// The tags of `tag_mask` without a queued proxy command. wait_proxy() completes the commands of all these
  /// tags first. @return  a bit for each of these tags
  virtual std::uint32_t proxy_status(std::uint32_t tag_mask) = 0;
  virtual std::uint32_t wait_proxy(std::uint32_t tag_mask) = 0;
  virtual int free_proxy_slots() = 0;  ///< 0 to 8

  /// Writes to the local store. Write code with this function only: dma/local_store_bytes.h says why.
  /// @throws std::invalid_argument  the range passes the end of the local store.
  virtual void write_local_store(dma::LocalStoreAddress lsa, std::span<const std::byte> bytes) = 0;

  /// The bytes of the local store, for data. A running kernel may change them at any time.
  virtual std::span<std::byte> local_store() = 0;
  virtual dma::EffectiveAddress local_store_ea() const = 0;
};

/// Up to six SPEs, numbered from 0. Any thread, unless a function says otherwise.
/// @throws std::invalid_argument  (all functions with `spe`) the group has no such SPE.
class SpeGroup {
 public:
  /// Creates the SPEs and maps their local stores into `memory`, which must outlive the group. A memory has the SPEs of one group, job
  /// system or SpeRuntime at a time.
  /// @throws std::invalid_argument  options out of range, or the memory has SPEs already.
  /// @throws std::runtime_error  the host lacks AVX2 or FMA, or has no thread left.
  SpeGroup(dma::AddressSpace& memory, const SpeOptions& options);

  /// Stops runs in progress and waits for their ends.
  ~SpeGroup();
  SpeGroup(const SpeGroup&) = delete;
  SpeGroup& operator=(const SpeGroup&) = delete;

  int spes() const;  ///< their number, 1..6

  /// Loads an image into an SPE. Between prepare() and start(), the PPU side and other SPEs may write to the
  /// local store: if SPEs communicate, prepare all of them before you start the first. Mailboxes and signal
  /// registers keep their contents. The image must outlive the run.
  /// @throws std::logic_error  the SPE runs.
  void prepare(int spe, const KernelImage& image, const EntryArguments& arguments);

  /// Begins the run that was prepared, on the SPE's own thread.
  /// @throws std::logic_error  nothing was prepared, or a run is in progress.
  void start(int spe);

  /// prepare() and start().
  void start(int spe, const KernelImage& image, const EntryArguments& arguments) {
    prepare(spe, image, arguments);
    start(spe);
  }

  /// prepare() and start() for a resident kernel: one that runs without a time limit and calls other kernels,
  /// jobs. It marks where each job begins and ends (spu_kernels/common/job_mark.h). Deadline, statistics and
  /// trace then concern the jobs. Checked jobs are checked even if the resident kernel is not.
  /// @throws std::invalid_argument  the image is a program for the SPU that softcell_add_spu_kernel did not build.
  void start_resident(int spe, const KernelImage& image, const EntryArguments& arguments);

  /// Registers the image of the jobs whose code lies at `ea` in main storage, a multiple of 16. The image
  /// must outlive the group.
  /// @throws std::invalid_argument  the image is a program for the SPU that softcell_add_spu_kernel did not build.
  void register_job_image(dma::EffectiveAddress ea, const KernelImage& image);

  /// Sets a function that is called at the end of each run, on a thread of the group, without a lock. It may
  /// start the SPE again.
  /// @pre  nothing was prepared yet
  void on_end(std::function<void(int spe, const RunResult&)> listener);

  /// Waits until the run has ended. Every run ends: normally, by a fault, by a deadlock or at the deadline. A
  /// second call returns the same result.
  /// @throws std::logic_error  the SPE was never started.
  RunResult wait(int spe);

  /// Ends all runs in progress, and those that begin later, as their deadline would. Any thread.
  void stop_runs();

  /// Waits until each SPE has ended its run or sleeps at a channel where only the PPU side can wake it.
  /// @pre  SPEs take turns: Interleaving::kTurns or kByTime
  void wait_until_idle();

  ProblemState& problem_state(int spe);

  /// Statistics up to the end of the SPE's last run or job.
  SpeStatistics statistics(int spe) const;

  /// While an object of this class exists, another thread may still write to a mailbox, a signal or memory;
  /// so SPEs that all wait are not reported as a deadlock.
  class Outside {
   public:
    explicit Outside(SpeGroup& group);
    ~Outside();
    Outside(const Outside&) = delete;
    Outside& operator=(const Outside&) = delete;

   private:
    SpeGroup& group_;
  };

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ls_sim
