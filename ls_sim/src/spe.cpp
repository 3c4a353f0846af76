#include "spe.h"

#include <algorithm>

#include "softcell/ls_sim/source_lines.h"

namespace softcell::ls_sim {

Spe::Spe(int number, dma::AddressSpace& memory, const SpeOptions& options, SpeMonitor& monitor)
    : number_(number),
      options_(options),
      monitor_(monitor),
      mfc_(local_store_.bytes(), memory, options.schedule, static_cast<std::uint64_t>(number), this),
      engine_(make_native_engine(local_store_)),
      channels_({.spe = number_,
                 .options = options_,
                 .monitor = monitor_,
                 .registers = registers_,
                 .mfc = mfc_,
                 .engine = *engine_,
                 .statistics = statistics_}) {}

RunResult Spe::run(const Run& run) {
  RunResult result = execute(run);
  if (result.fault) {
    result.fault->spe = number_;
    result.fault->kernel = run.image->name;
    resident_ = nullptr;  // whatever it did to its local store goes with it
  }
  add_to_statistics(run, std::chrono::steady_clock::now());
  return result;
}

RunResult Spe::execute(const Run& run) {
  make_resident(*run.image);
  mfc_.begin_job(run.number);
  channels_.begin_run();
  RunResult result = engine_->run(run.arguments, channels_);
  if (result.fault) {
    result.fault->place = SourceLines(*run.image).place_of(engine_->position());
  } else {
    result.fault = mfc_.drain();  // of a command issued earlier: nobody knows where
  }
  return result;
}

void Spe::make_resident(const KernelImage& image) {
  if (resident_ == &image && !options_.reload_always) return;
  engine_->load(image);
  resident_ = &image;
  ++statistics_.image_loads;
}

void Spe::add_to_statistics(const Run& run, SpeMonitor::HostTime end) {
  ++statistics_.jobs;
  statistics_.busy += end - run.begin;
  statistics_.dma = mfc_.statistics();
  const ImageSizes& sizes = run.image->sizes;
  std::uint32_t stack = sizes.stack;
  if (options_.measure_stack) {
    stack = engine_->stack_high_water();
    statistics_.stack_high_water = std::max(statistics_.stack_high_water, stack);
  }
  statistics_.local_store_high_water = std::max(statistics_.local_store_high_water, sizes.end + stack);
}

void Spe::interrupt() {
  monitor_.stop(number_);
  engine_->interrupt();
}

void Spe::on_external_write(dma::LocalStoreAddress, std::uint32_t) {}

void Spe::on_register_write(dma::SpeRegister which, std::uint32_t value) {
  const SpeMonitor::Lock lock = monitor_.lock();
  switch (which) {
    case dma::SpeRegister::kInMbox:
      registers_.write_in_mbox(value);
      break;
    case dma::SpeRegister::kSignal1:
      registers_.write_signal(1, value);
      break;
    case dma::SpeRegister::kSignal2:
      registers_.write_signal(2, value);
      break;
  }
  monitor_.wake(number_);
}

void Spe::on_reservation_lost() {
  const SpeMonitor::Lock lock = monitor_.lock();
  registers_.events.raise(event::kLostReservation);
  monitor_.wake(number_);
}

}  // namespace softcell::ls_sim
