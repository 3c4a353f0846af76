#pragma once
// One SPE: local store, MFC, channels, engine.

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "channels/spe_monitor.h"
#include "channels/spe_registers.h"
#include "channels/spu_channels.h"
#include "checker/checker.h"
#include "softcell/base/assert.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/dma/mfc.h"
#include "softcell/dma/reservations.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/statistics.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {

/// One run of an image.
struct Run {
  const KernelImage* image = nullptr;
  EntryArguments arguments;
  std::uint64_t number = 0;  ///< gives each run a random schedule of its own
  SpeMonitor::HostTime begin{};
  /// The image is a resident kernel, which has no deadline; the jobs that it calls have.
  bool resident = false;
};

/// The images of jobs, by their effective addresses. Guarded by the monitor.
using JobImages = std::map<std::uint64_t, const KernelImage*>;

/// Only its own thread may use it, unless a function says otherwise.
class Spe final : public dma::LocalStorePort, private dma::ReservationListener, private JobObserver {
 public:
  /// @param monitor  of all SPEs that run together; outlives them.
  Spe(int number, dma::AddressSpace& memory, const SpeOptions& options, SpeMonitor& monitor);

  /// Sets the proxy queue, whose commands move at the SPE's channel operations. It outlives the SPE's runs.
  void set_proxy(dma::ProxyQueue* proxy) { channels_.set_proxy(proxy); }

  /// Sets the listener for stops that do not end a program. Null: such a stop ends the run, too.
  void set_stop_listener(StopListener* listener) { channels_.set_stop_listener(listener); }

  /// Sets the window through which this SPE reaches the threads of its own group, while no run is in progress.
  void set_window(dma::AddressWindow window) { mfc_.set_window(std::move(window)); }

  /// Sets the images of jobs. They outlive the SPE's runs.
  void set_job_images(const JobImages* images) { job_images_ = images; }

  /// Announces an image that a resident kernel may fetch from now on. Any thread.
  void announce_job_image(const KernelImage& image);

  /// Declares that loading a program clears its bss, as an ELF loader does; the checker then counts bss as written.
  void set_clears_bss() { clears_bss_ = true; }

  /// Loads the image. Any thread, while no run is in progress.
  void load(const KernelImage& image);

  /// Loads an image if it is not loaded, and runs it to its end. @pre SpeMonitor::start() was called
  RunResult run(const Run& run);

  /// Why a run is to end: because it is late, which is a mistake of its kernel, or because the PPU side wants it.
  enum class Interrupt : std::uint8_t { kLate, kWanted };
  /// Ends the run in progress with the fault deadline-exceeded; the trace shows one that is late only. Any thread, with
  /// the monitor's lock.
  void interrupt(Interrupt why);

  /// The engine's position. Any thread, while no run is in progress.
  dma::LocalStoreAddress position() const { return engine_->position(); }

  /// Guarded by the monitor.
  SpeRegisters& registers() { return registers_; }

  /// The statistics up to the end of the last run or job. Call it with the monitor's lock.
  const SpeStatistics& statistics() const { return published_; }
  void publish_statistics() { published_ = statistics_; }

  // dma::LocalStorePort, any thread.
  std::span<std::byte> local_store() override { return local_store_.bytes(); }
  void on_external_write(dma::LocalStoreAddress lsa, std::uint32_t bytes) override;
  void on_register_write(dma::SpeRegister which, std::uint32_t value) override;

  /// The PPU side gets a pointer to the local store. Any thread.
  void on_shared() {
    if (checker_ != nullptr) checker_->on_shared();
  }

 private:
  void on_reservation_lost() override;
  const KernelImage* on_job_begin(dma::EffectiveAddress image, dma::EffectiveAddress job) override;
  std::optional<dma::Fault> on_job_returned() override;
  void on_job_end() override;

  /// The channels of a resident kernel: they are checked while a checked job runs.
  class JobDoor final : public ChannelPort {
   public:
    explicit JobDoor(Spe& spe) : spe_(spe) {
      SC_ASSERT(spe.checker_ != nullptr, "SPE {} checks nothing", spe.number_);
    }
    ChannelReply read(std::uint32_t channel) override { return port().read(channel); }
    ChannelReply write(std::uint32_t channel, std::uint32_t value) override {
      return port().write(channel, value);
    }
    ChannelReply count(std::uint32_t channel) override { return port().count(channel); }
    ChannelReply issue(const dma::MfcCommand& command) override {
      if (!spe_.is_checked_job()) spe_.checker_->on_unchecked_issue(command);
      return port().issue(command);
    }
    void sync() override { spe_.checker_->sync(); }
    bool stop(std::uint32_t code, dma::LocalStoreAddress assist) override {
      return port().stop(code, assist);
    }

   private:
    ChannelPort& port() {
      if (spe_.is_checked_job()) return *spe_.checker_;
      return spe_.channels_;
    }
    Spe& spe_;
  };

  class TimeOfSpe;

  const KernelImage& image_under_way() const;
  bool is_checked_job() const;
  StackRange stack_of_job() const;
  template <class Work>
  RunResult guarded(const Work& work);
  RunResult execute(const Run& run);
  RunResult run_engine(const Run& run);
  RunResult run_timed(const Run& run, ChannelPort& channels, AccessObserver* accesses, JobObserver* jobs);
  dma::LocalStoreAddress position_of(const dma::Fault& fault) const;
  void account(const Run& run, const RunResult& result);
  void count_job(const KernelImage& image, std::uint64_t number, SpeMonitor::HostTime begin,
                 TraceTime trace_begin, bool failed);
  TraceTime trace_time() const;

  int number_;
  SpeOptions options_;
  SpeMonitor& monitor_;
  SpeTrace* trace_;  ///< may be null
  SpeTimer* timer_;  ///< may be null
  LocalStore local_store_;
  SpeRegisters registers_;
  dma::Mfc mfc_;
  std::unique_ptr<Engine> engine_;
  SpeStatistics statistics_, published_;
  SpuChannels channels_;
  std::unique_ptr<Checker> checker_;  ///< null: nothing is checked
  const KernelImage* resident_ = nullptr;
  bool clears_bss_ = false;

  /// The job inside the run, while one is under way.
  struct InnerJob {
    const KernelImage* image = nullptr;  ///< null: not known
    dma::EffectiveAddress ea;
    SpeMonitor::HostTime begin;
    TraceTime trace_begin = 0;
  };
  const JobImages* job_images_ = nullptr;
  const Run* run_ = nullptr;
  std::optional<InnerJob> job_;
  TraceTime run_begin_ = 0;
  std::atomic<bool> end_is_wanted_{false};  ///< of the run in progress
};

}  // namespace softcell::ls_sim
