#include "spe.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "engine_by_image.h"
#include "image/function_names.h"
#include "softcell/base/assert.h"
#include "softcell/ls_sim/source_lines.h"
#include "softcell/ls_sim/trace.h"
#include "timing/spe_timer.h"
#include "timing/timed_channels.h"

namespace softcell::ls_sim {

namespace {

/// The size that faults of kernels are explained with. The memory of a host program has no main memory of softcell; the usual size stands
/// for it.
std::uint64_t main_memory_bytes_of(const dma::AddressSpace& memory) {
  return memory.is_host_program() ? dma::kMainMemoryBytes : memory.main_memory_bytes();
}

}  // namespace

Spe::Spe(int number, dma::AddressSpace& memory, const SpeOptions& options, SpeMonitor& monitor)
    : number_(number),
      options_(options),
      monitor_(monitor),
      trace_(options.trace == nullptr ? nullptr : &options.trace->spe(number)),
      timer_(options.timing == nullptr ? nullptr : &options.timing->timer(number)),
      local_store_(memory.host_address_of_local_store(number)),
      mfc_(local_store_.bytes(), memory, options.schedule, static_cast<std::uint64_t>(number), this),
      engine_(std::make_unique<EngineByImage>(
          local_store_, dma::local_store_ea(number),
          InterpreterOptions{
              .host_calls = options.host_calls, .timer = timer_, .debugger = options.debugger, .spe = number},
          main_memory_bytes_of(memory))),
      channels_({.spe = number_,
                 .options = options_,
                 .monitor = monitor_,
                 .registers = registers_,
                 .mfc = mfc_,
                 .engine = *engine_,
                 .statistics = statistics_,
                 .trace = trace_,
                 .cycles = timer_ == nullptr ? nullptr : &timer_->clock}) {
  mfc_.set_observer(trace_);
  mfc_.confine_code({0});
  if (options_.findings != nullptr) {
    checker_ = std::make_unique<Checker>(Checker::Surroundings{.spe = number_,
                                                               .local_store = local_store_.bytes(),
                                                               .channels = channels_,
                                                               .engine = *engine_,
                                                               .findings = *options_.findings,
                                                               .trace = trace_});
  }
}

/// Turns an exception of the host into a fault of this run, because nothing else on this thread would catch it. Adds the SPE and the kernel
/// to a fault.
template <class Work>
RunResult Spe::guarded(const Work& work) {
  RunResult result;
  try {
    result = work();
  } catch (dma::StorageLost& lost) {
    result = {0, std::move(lost.fault)};
  } catch (const std::exception& error) {
    result = {0, dma::Fault{.rule = dma::Rule::kHostFailure, .detail = error.what()}};
  }
  if (result.fault) {
    result.fault->spe = number_;
    result.fault->kernel = image_under_way().name;
  }
  return result;
}

RunResult Spe::run(const Run& run) {
  SC_ASSERT(run.image != nullptr, "run {} of SPE {} has no image", run.number, number_);
  SC_ASSERT(!job_, "run {} of SPE {} begins within a job", run.number, number_);
  SC_ASSERT(monitor_.runs_now(number_), "run {} of SPE {}, which the monitor has not started", run.number,
            number_);
  run_ = &run;
  run_begin_ = timer_ == nullptr ? run.begin.time_since_epoch().count() : trace_time();
  RunResult result = guarded([&] { return execute(run); });
  channels_.end_run();
  RunResult accounting = guarded([&] {
    account(run, result);
    return RunResult{};
  });
  if (accounting.fault && !result.fault) result = std::move(accounting);
  if (job_) result.job = job_->ea;
  end_is_wanted_ = false;
  // A kernel that failed may have damaged its local store, so the next run loads its image anew.
  if (result.fault) resident_ = nullptr;
  job_.reset();
  return result;
}

const KernelImage& Spe::image_under_way() const {
  SC_ASSERT(run_ != nullptr, "SPE {} has not run", number_);
  return job_ && job_->image != nullptr ? *job_->image : *run_->image;
}

RunResult Spe::execute(const Run& run) {
  if (options_.findings != nullptr && !run.image->checked && !run.resident) {
    return {0, dma::Fault{.rule = dma::Rule::kImageNotLoadable,
                          .detail = "findings were asked for, and the image is not a checked one"}};
  }
  if (resident_ != run.image) load(*run.image);
  SC_ASSERT(resident_ == run.image, "SPE {} is to run {}, which is not loaded", number_, run.image->name);
  mfc_.begin_job(run.number);
  channels_.begin_run(run.resident);
  RunResult result = run_engine(run);
  if (!result.fault) result.fault = mfc_.drain();
  if (result.fault) {
    const KernelImage& image = image_under_way();
    const dma::LocalStoreAddress position = position_of(*result.fault);
    result.fault->place = SourceLines(image).place_of(position);
    if (result.fault->place.empty()) result.fault->place = function_at(image, position);
  }
  return result;
}

/// The time by the clock of the trace.
TraceTime Spe::trace_time() const {
  return timer_ == nullptr ? trace_now() : TimedChannels::nanoseconds(timer_->clock.now());
}

/// The SPE's clock among those of the others.
class Spe::TimeOfSpe final : public TimeOrder {
 public:
  TimeOfSpe(SpeMonitor& monitor, int spe) : monitor_(monitor), spe_(spe) {}
  void set_time(std::uint64_t now, std::uint64_t effect) override { monitor_.set_time(spe_, now, effect); }
  /// An SPE that has been stopped learns of it at its next channel operation.
  void await_turn() override { monitor_.pass_turn(spe_); }
  std::uint64_t woken_at() override { return monitor_.take_woken_at(spe_); }

 private:
  SpeMonitor& monitor_;
  const int spe_;
};

/// Runs the engine with the model of time between it and its channels, if there is one.
RunResult Spe::run_timed(const Run& run, ChannelPort& channels, AccessObserver* accesses, JobObserver* jobs) {
  if (timer_ == nullptr) return engine_->run(run.arguments, channels, accesses, jobs);
  TimeOfSpe order(monitor_, number_);
  timer_->clock.advance_to(monitor_.time_at_start(number_));
  timer_->mfc.begin_run();
  run_begin_ = trace_time();
  const bool is_native = run.image->machine == Machine::kHost;
  const std::uint64_t begin = timer_->clock.now();
  TimedChannels timed(channels, *timer_, order, trace_, local_store_.bytes(), mfc_.is_big_endian(),
                      is_native ? timer_->parameters.native_operation : 0);
  RunResult result = engine_->run(run.arguments, timed, accesses, jobs);
  if (is_native) {
    timer_->native.cycles += timer_->clock.now() - begin;
    const auto waits = timer_->clock.take_waits();
    for (std::size_t i = 0; i < kStalls; ++i) timer_->native.stalls[i] += waits[i];
  }
  order.set_time(timer_->clock.now(), timer_->clock.now());
  return result;
}

RunResult Spe::run_engine(const Run& run) {
  JobObserver* const jobs = run.resident ? this : nullptr;
  if (checker_ == nullptr) return run_timed(run, channels_, nullptr, jobs);
  checker_->on_start();
  if (run.resident) {
    JobDoor door(*this);
    return run_timed(run, door, checker_.get(), jobs);
  }
  SC_ASSERT(run.image->sizes.stack <= run.image->stack_top, "{} has a stack of {} bytes below {}",
            run.image->name, run.image->sizes.stack, run.image->stack_top);
  checker_->begin_run(*run.image, {run.image->stack_top - run.image->sizes.stack, run.image->stack_top},
                      run.arguments.data_as_linked);
  RunResult result = run_timed(run, *checker_, checker_.get(), nullptr);
  if (!result.fault) checker_->end_run();
  return result;
}

dma::LocalStoreAddress Spe::position_of(const dma::Fault& fault) const {
  // The MFC checks a list's elements while the list executes, but the mistake is where the list was issued. A list that has stalled is no
  // mistake until the kernel waits for it.
  if (fault.rule == dma::Rule::kListStalledForEver) return engine_->position();
  return channels_.issued_at(fault).value_or(engine_->position());
}

void Spe::load(const KernelImage& image) {
  SC_ASSERT(!image.bytes.empty(), "image {} of SPE {} is empty", image.name, number_);
  SC_ASSERT(!job_, "SPE {} loads {} within a job", number_, image.name);
  resident_ = nullptr;
  engine_->load(image);
  mfc_.set_big_endian(image.machine == Machine::kSpu);
  if (image.machine == Machine::kHost && image.begin == kEnvironmentBytes)
    mfc_.expect_code_below({image.data_begin});
  if (checker_ != nullptr) checker_->on_load();
  const auto bss = image.begin + static_cast<std::uint32_t>(image.bytes.size());
  SC_ASSERT(bss <= image.sizes.end && image.sizes.end <= dma::kLocalStoreBytes,
            "the bytes of {} end at {}, and it at {}", image.name, bss, image.sizes.end);
  if (clears_bss_ && bss < image.sizes.end) on_external_write({bss}, image.sizes.end - bss);
  resident_ = &image;
  ++statistics_.image_loads;
}

// ---- jobs inside a run

void Spe::announce_job_image(const KernelImage& image) {
  mfc_.expect_code_below({image.data_begin});
  channels_.announce_jobs();
}

const KernelImage* Spe::on_job_begin(dma::EffectiveAddress image, dma::EffectiveAddress job) {
  const auto now = std::chrono::steady_clock::now();
  SC_ASSERT(run_ != nullptr && run_->resident, "SPE {} begins the job at {} outside a resident run", number_,
            job);
  job_ = {.image = nullptr, .ea = job, .begin = now, .trace_begin = trace_time()};
  {
    const SpeMonitor::Lock lock = monitor_.lock();
    SC_ASSERT(job_images_ != nullptr, "SPE {} is to run the job at {} and knows no images", number_, job);
    const auto known = job_images_->find(image.value);
    if (known != job_images_->end()) job_->image = known->second;
    if (job_->image == nullptr) mfc_.expect_code_everywhere();
    monitor_.begin_job(number_, now);
  }
  channels_.begin_job();
  if (timer_ != nullptr) timer_->jobs.begin(timer_->clock);
  if (is_checked_job()) checker_->begin_run(*job_->image, stack_of_job());
  return job_->image;
}

std::optional<dma::Fault> Spe::on_job_returned() {
  SC_ASSERT(job_.has_value(), "a job returns in SPE {}, and none was under way", number_);
  if (is_checked_job()) checker_->end_run();
  return mfc_.drain();
}

void Spe::on_job_end() {
  SC_ASSERT(job_.has_value(), "a job ends in SPE {}, and none was under way", number_);
  count_job(image_under_way(), statistics_.jobs, job_->begin, job_->trace_begin, false);
  if (timer_ != nullptr) timer_->jobs.end(image_under_way(), timer_->clock);
  channels_.end_job();
  job_.reset();
  const SpeMonitor::Lock lock = monitor_.lock();
  monitor_.end_job(number_);
  publish_statistics();
}

bool Spe::is_checked_job() const {
  return checker_ != nullptr && job_ && job_->image != nullptr && job_->image->checked;
}

/// The job's stack begins where its caller's ends, which may be anywhere in the stack that the caller has declared.
StackRange Spe::stack_of_job() const {
  SC_ASSERT(is_checked_job(), "SPE {} runs no checked job", number_);
  const KernelImage& caller = *run_->image;
  SC_ASSERT(caller.sizes.stack + job_->image->sizes.stack <= caller.stack_top,
            "the stacks of {} and of job {} have {} and {} bytes below {}", caller.name, job_->image->name,
            caller.sizes.stack, job_->image->sizes.stack, caller.stack_top);
  return {caller.stack_top - caller.sizes.stack - job_->image->sizes.stack, caller.stack_top};
}

void Spe::count_job(const KernelImage& image, std::uint64_t number, SpeMonitor::HostTime begin,
                    TraceTime trace_begin, bool failed) {
  const auto end = std::chrono::steady_clock::now();
  SC_ASSERT(begin <= end, "job {} of {} begins in the future", number, image.name);
  ++statistics_.jobs;
  statistics_.busy += end - begin;
  statistics_.dma = mfc_.statistics();
  if (trace_ == nullptr) return;
  trace_->on_job(image, number, trace_begin, std::max(trace_begin, trace_time()), failed);
}

void Spe::account(const Run& run, const RunResult& result) {
  const bool succeeded = result.ended_normally() && result.status() == 0;
  const bool is_fault =
      result.fault && !(end_is_wanted_ && result.fault->rule == dma::Rule::kDeadlineExceeded);
  const bool failed = options_.status_says_failure ? !succeeded : is_fault;
  if (!run.resident) count_job(*run.image, run.number, run.begin, run_begin_, failed);
  if (run.resident && job_)
    count_job(image_under_way(), statistics_.jobs, job_->begin, job_->trace_begin, true);
  statistics_.dma = mfc_.statistics();
  statistics_.instructions = engine_->instructions();
  const ImageSizes& sizes = run.image->sizes;
  SC_ASSERT(sizes.from <= sizes.end, "{} lies from {} to {}", run.image->name, sizes.from, sizes.end);
  std::uint32_t stack = sizes.stack;
  if (options_.measure_stack) {
    stack = engine_->stack_high_water();
    statistics_.stack_high_water = std::max(statistics_.stack_high_water, stack);
    if (trace_ != nullptr) trace_->on_stack_used(*run.image, stack);
  }
  statistics_.local_store_high_water =
      std::max(statistics_.local_store_high_water, sizes.end - sizes.from + stack);
  if (trace_ != nullptr && is_fault) {
    trace_->on_finding(*result.fault, trace_time());
  }
}

void Spe::interrupt(Interrupt why) {
  if (why == Interrupt::kWanted) end_is_wanted_ = true;
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
