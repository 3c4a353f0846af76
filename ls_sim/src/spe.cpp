#include "spe.h"

#include <algorithm>

#include "softcell/ls_sim/source_lines.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {

Spe::Spe(int number, dma::AddressSpace& memory, const SpeOptions& options, SpeMonitor& monitor)
    : number_(number),
      options_(options),
      monitor_(monitor),
      trace_(options.trace == nullptr ? nullptr : &options.trace->spe(number)),
      mfc_(local_store_.bytes(), memory, options.schedule, static_cast<std::uint64_t>(number), this),
      engine_(make_native_engine(local_store_)),
      channels_({.spe = number_,
                 .options = options_,
                 .monitor = monitor_,
                 .registers = registers_,
                 .mfc = mfc_,
                 .engine = *engine_,
                 .statistics = statistics_,
                 .trace = trace_}) {
  mfc_.set_observer(trace_);
  if (options_.findings != nullptr) {
    checker_ = std::make_unique<Checker>(Checker::Surroundings{.spe = number_,
                                                               .local_store = local_store_.bytes(),
                                                               .channels = channels_,
                                                               .engine = *engine_,
                                                               .findings = *options_.findings,
                                                               .trace = trace_});
  }
}

RunResult Spe::run(const Run& run) {
  RunResult result = execute(run);
  channels_.end_run();
  if (result.fault) {
    result.fault->spe = number_;
    result.fault->kernel = run.image->name;
  }
  // Whatever a kernel that failed did to its local store goes with it.
  if (result.fault || options_.reload_always) resident_ = nullptr;
  account(run, result, std::chrono::steady_clock::now());
  return result;
}

RunResult Spe::execute(const Run& run) {
  if (options_.findings != nullptr && !run.image->checked) {
    return {0, dma::Fault{.rule = dma::Rule::kImageNotLoadable,
                          .detail = "the image is not a checked one, so that nothing would be found"}};
  }
  if (resident_ != run.image) load(*run.image);
  mfc_.begin_job(run.number);
  channels_.begin_run();
  RunResult result = run_engine(run);
  if (!result.fault) result.fault = mfc_.drain();
  if (result.fault) result.fault->place = SourceLines(*run.image).place_of(position_of(*result.fault));
  return result;
}

RunResult Spe::run_engine(const Run& run) {
  if (checker_ == nullptr) return engine_->run(run.arguments, channels_);
  checker_->begin_run(*run.image);
  RunResult result = engine_->run(run.arguments, *checker_, checker_.get());
  if (!result.fault) checker_->end_run();
  return result;
}

dma::LocalStoreAddress Spe::position_of(const dma::Fault& fault) const {
  // A list's elements are looked at while it executes: the mistake is where it was issued. One that has
  // stalled is no mistake before something waits for it.
  if (fault.rule == dma::Rule::kListStalledForEver) return engine_->position();
  return channels_.issued_at(fault).value_or(engine_->position());
}

void Spe::load(const KernelImage& image) {
  engine_->load(image);
  if (checker_ != nullptr) checker_->on_load();
  resident_ = &image;
  ++statistics_.image_loads;
}

void Spe::account(const Run& run, const RunResult& result, SpeMonitor::HostTime end) {
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
  if (trace_ == nullptr) return;
  const bool failed = !result.ended_normally() || result.status() != 0;
  trace_->on_job(*run.image, run.number, run.begin.time_since_epoch().count(), end.time_since_epoch().count(),
                 failed);
  if (result.fault) trace_->on_finding(*result.fault, end.time_since_epoch().count());
  if (options_.measure_stack) trace_->on_stack_used(*run.image, stack);
}

void Spe::interrupt() {
  monitor_.stop(number_);
  engine_->interrupt();
}

void Spe::on_external_write(dma::LocalStoreAddress lsa, std::uint32_t bytes) {
  if (checker_ != nullptr) checker_->on_external_write(lsa, bytes);
}

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
