#pragma once
// One SPE: local store, MFC, channels, engine.

#include <chrono>
#include <memory>

#include "checker.h"
#include "softcell/dma/local_store_port.h"
#include "softcell/dma/mfc.h"
#include "softcell/dma/reservations.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/local_store.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/statistics.h"
#include "spe_monitor.h"
#include "spe_registers.h"
#include "spu_channels.h"

namespace softcell::ls_sim {

/// One run of an image.
struct Run {
  const KernelImage* image = nullptr;
  EntryArguments arguments;
  std::uint64_t number = 0;  ///< tells apart the random schedules of runs
  SpeMonitor::HostTime begin{};
};

/// Used by its own thread, except for what is said to be for others.
class Spe final : public dma::LocalStorePort, private dma::ReservationListener {
 public:
  /// @param monitor  of all SPEs that run together; outlives them.
  Spe(int number, dma::AddressSpace& memory, const SpeOptions& options, SpeMonitor& monitor);

  /// Moves with the SPE from now on; outlives its runs.
  void set_proxy(dma::ProxyQueue* proxy) { channels_.set_proxy(proxy); }

  /// Makes the image resident anew. Any thread, while no run is in progress.
  void load(const KernelImage& image);

  /// Runs an image to its end, which is made resident if it is not. @pre the monitor has been told of its
  /// start.
  RunResult run(const Run& run);

  /// Ends the run in progress with the fault deadline-exceeded. Any thread, with the monitor's lock.
  void interrupt();

  /// Guarded by the monitor.
  SpeRegisters& registers() { return registers_; }

  /// While no run is in progress.
  const SpeStatistics& statistics() const { return statistics_; }

  // dma::LocalStorePort, any thread.
  std::span<std::byte> local_store() override { return local_store_.bytes(); }
  void on_external_write(dma::LocalStoreAddress lsa, std::uint32_t bytes) override;
  void on_register_write(dma::SpeRegister which, std::uint32_t value) override;

 private:
  void on_reservation_lost() override;

  RunResult execute(const Run& run);
  RunResult run_engine(const Run& run);
  dma::LocalStoreAddress position_of(const dma::Fault& fault) const;
  void account(const Run& run, const RunResult& result, SpeMonitor::HostTime end);

  int number_;
  SpeOptions options_;
  SpeMonitor& monitor_;
  SpeTrace* trace_;  ///< may be null
  LocalStore local_store_;
  SpeRegisters registers_;
  dma::Mfc mfc_;
  std::unique_ptr<Engine> engine_;
  SpeStatistics statistics_;
  SpuChannels channels_;
  std::unique_ptr<Checker> checker_;  ///< null: nothing is checked
  const KernelImage* resident_ = nullptr;
};

}  // namespace softcell::ls_sim
