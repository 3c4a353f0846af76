#pragma once
// One SPE: local store, MFC, channels, engine.

#include <string>

#include "softcell/ls_sim/spe_pool.h"

namespace softcell::ls_sim {

/// Used by one thread, except for interrupt().
class Spe {
 public:
  Spe(int number, dma::AddressSpace& memory, const SpeOptions& options)
      : number_(number),
        options_(options),
        mfc_(local_store_.bytes(), memory, options.schedule, static_cast<std::uint64_t>(number)),
        engine_(make_native_engine(local_store_)) {}

  /// Runs one job to its end. @return an empty string, or why it failed.
  std::string run(const Job& job, std::uint64_t job_number);

  void interrupt() { engine_->interrupt(); }

  const SpeStatistics& statistics() const { return statistics_; }

 private:
  void make_resident(const KernelImage& image);

  int number_;
  SpeOptions options_;
  LocalStore local_store_;
  dma::Mfc mfc_;
  std::unique_ptr<Engine> engine_;
  const KernelImage* resident_ = nullptr;
  SpeStatistics statistics_;
};

}  // namespace softcell::ls_sim
