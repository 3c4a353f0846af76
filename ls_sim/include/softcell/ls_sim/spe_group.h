#pragma once
// Up to six SPEs that the PPU side starts one by one, and what it sees of each: mailboxes, signals, proxy
// DMA, local store. For jobs that any SPE may take, see ppu/job_system.h.
//
//   SpeGroup spes(memory, {.spes = 2});
//   spes.start(0, image, {.spe_id = 0, .argp = data.ea().value});
//   spes.problem_state(0).write_in_mbox(42);
//   const RunResult result = spes.wait(0);
//
// SPEs that all wait at channels, while nothing is in flight, can only be waiting for the PPU side. When that
// waits too, in one of the calls below that say so, it is a deadlock: each of them stops with a fault that
// says who waits for what. Where more than one thread acts as the PPU, each says so by an Outside.
//
// With Interleaving::kTurns, SPEs run while the PPU side waits in such a call, and for a while when it looks
// at a mailbox or a status in vain; so a run is the same every time if one thread acts as the PPU.

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

/// How a signal register takes a value. [CBEA, signal notification] documented
enum class SignalMode : std::uint8_t { kOverwrite, kOr };

/// One SPE as the PPU sees it. Any thread. [CBEA, problem state area] documented
class ProblemState {
 public:
  virtual ~ProblemState() = default;

  /// Outbound mailboxes, 1 deep each: the value, or nothing when empty.
  virtual std::optional<std::uint32_t> read_out_mbox() = 0;
  virtual std::optional<std::uint32_t> read_out_intr_mbox() = 0;

  /// Waits for a value: nothing when the SPE has stopped without writing one.
  virtual std::optional<std::uint32_t> wait_out_mbox() = 0;
  virtual std::optional<std::uint32_t> wait_out_intr_mbox() = 0;

  /// Inbound mailbox, 4 deep. Into a full one, the value replaces the newest.
  virtual void write_in_mbox(std::uint32_t value) = 0;

  /// Outbound count | free inbound slots << 8 | outbound-interrupt count << 16.
  virtual std::uint32_t mbox_status() = 0;

  /// @param which  1 or 2. @throws std::invalid_argument  another.
  virtual void write_signal(int which, std::uint32_t value) = 0;
  virtual void set_signal_mode(int which, SignalMode mode) = 0;

  /// Proxy DMA: 8 commands, no lists, no line commands but putqlluc. Those with start begin the run of a
  /// prepared SPE once their bytes have moved. @return a fault, and then nothing is queued; waits while full.
  virtual std::optional<dma::Fault> issue_proxy(const dma::MfcCommand& command) = 0;

  /// Which of these tags have no proxy command left. `wait_proxy` completes them first.
  virtual std::uint32_t proxy_status(std::uint32_t tag_mask) = 0;
  virtual std::uint32_t wait_proxy(std::uint32_t tag_mask) = 0;
  virtual int free_proxy_slots() = 0;

  /// Writes to the local store. Code goes there this way only: local_store_bytes.h of dma says why.
  /// @throws std::invalid_argument  the bytes pass the end of the local store.
  virtual void write_local_store(dma::LocalStoreAddress lsa, std::span<const std::byte> bytes) = 0;

  /// The local store's bytes, for data. What runs there may change them at any time.
  virtual std::span<std::byte> local_store() = 0;
  virtual dma::EffectiveAddress local_store_ea() const = 0;
};

class SpeGroup {
 public:
  /// Maps the local stores into `memory`. @throws std::invalid_argument, std::runtime_error options out of
  /// range; a host without AVX2 and FMA.
  SpeGroup(dma::AddressSpace& memory, const SpeOptions& options);

  /// Stops what still runs.
  ~SpeGroup();
  SpeGroup(const SpeGroup&) = delete;
  SpeGroup& operator=(const SpeGroup&) = delete;

  int spes() const;

  /// Loads the image, so that the PPU side and other SPEs may write to the local store before the run begins:
  /// SPEs that talk to each other are all prepared before the first of them starts. Mailboxes and signal
  /// registers stay as they are. The image must outlive the run.
  /// @throws std::logic_error  the SPE runs.
  void prepare(int spe, const KernelImage& image, const EntryArguments& arguments);

  /// Begins the run that was prepared, on the SPE's own thread.
  /// @throws std::logic_error  nothing was prepared, or the SPE runs.
  void start(int spe);

  /// Both.
  void start(int spe, const KernelImage& image, const EntryArguments& arguments) {
    prepare(spe, image, arguments);
    start(spe);
  }

  /// prepare() and start() for a kernel that runs for as long as it likes and calls others, jobs, at whose
  /// begin and end it makes the marks of spu_kernels/common/job_mark.h: what has a deadline, a share in the
  /// statistics and a place in the trace are the jobs. It need not be a checked image for its jobs to be
  /// checked.
  void start_resident(int spe, const KernelImage& image, const EntryArguments& arguments);

  /// Names the image of jobs whose bytes lie at `ea`; it must outlive the group.
  void register_job_image(dma::EffectiveAddress ea, const KernelImage& image);

  /// Calls `listener` at the end of each run, on a thread of the group's, with no lock held; it may start the
  /// SPE anew. To be set before the first start.
  void on_end(std::function<void(int spe, const RunResult&)> listener);

  /// Waits until the run has ended; it always does, by its end, a fault, a deadlock or the deadline. Asked
  /// again, gives the same answer.
  /// @throws std::logic_error  the SPE was never started.
  RunResult wait(int spe);

  ProblemState& problem_state(int spe);

  /// Exact when the SPE does not run, else as of its last run or job.
  SpeStatistics statistics(int spe) const;

  /// While one of these lives, somebody outside may still write to a mailbox, a signal or memory, and SPEs
  /// that all wait are no deadlock.
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
