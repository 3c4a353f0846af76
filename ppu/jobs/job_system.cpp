#include "softcell/jobs/job_system.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "job_chain.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"
#include "softcell/dma/buffer.h"
#include "softcell/dma/reservations.h"

namespace softcell::ppu {
namespace {

using spu::ChainDone;
using spu::ChainState;
using spu::JobBell;
using spu::JobBoard;
using spu::JobDescriptor;

constexpr dma::BufferOptions kRead{.spe_access = dma::SpeAccess::kRead};

// The widths of the numbers in job_chain.h, for SPEs that run programs built for the SPU.
constexpr dma::ElementRun kDescriptorRecord[] = {{24, 8}, {104, 4}};
constexpr dma::ElementRun kStateRecord[] = {{16, 8}, {112, 4}};
constexpr dma::ElementRun kBoardRecord[] = {{4, 4}, {4, 2}, {120, 8}};
constexpr dma::BufferOptions kWords{.element_bytes = 4};
constexpr dma::BufferOptions kDescriptors{.spe_access = dma::SpeAccess::kRead, .record = kDescriptorRecord};

/// ChainState::failed_status of a job that ended by a fault: no main returns this value.
constexpr std::uint32_t kFaulted = 0x100;

template <class Line>
std::byte* host_of(dma::Buffer<Line>& lines, std::size_t index = 0) {
  return reinterpret_cast<std::byte*>(&lines[index]);
}

/// Changes a line that SPEs also change.
template <class Line, class Change>
Line change_line(dma::Reservations& reservations, dma::ReservationHolder& holder, dma::Buffer<Line>& at,
                 const Change& change, std::size_t index = 0) {
  Line line;
  do {
    reservations.load_and_reserve(holder, at.ea(index), host_of(at, index),
                                  reinterpret_cast<std::byte*>(&line));
    change(line);
  } while (!reservations.store_conditional(holder, at.ea(index), host_of(at, index),
                                           reinterpret_cast<std::byte*>(&line)));
  return line;
}

/// @throws std::invalid_argument  the image lies where its jobs would lie.
const ls_sim::KernelImage& require_loop(const ls_sim::KernelImage& image) {
  if (image.begin == spu::kJobAreaBegin) {
    throw std::invalid_argument(
        "kernel " + image.name +
        " cannot be the job loop: it is linked to the bottom of the local store, where jobs "
        "run; use softcell's kernel job_loop, or RESIDENT_AT");
  }
  return image;
}

/// @throws std::invalid_argument  the job loop could not call this image.
void require_job(const ls_sim::KernelImage& image, const ls_sim::KernelImage& loop, bool wants_checked) {
  if (image.machine != loop.machine) {
    const bool is_spu = image.machine == ls_sim::Machine::kSpu;
    throw std::invalid_argument("kernel " + image.name + " is built for the " + (is_spu ? "SPU" : "host") +
                                ", and the job loop for the " + (is_spu ? "host" : "SPU") +
                                ": a job is built as its loop is");
  }
  if (image.main == 0) {
    throw std::invalid_argument("kernel " + image.name +
                                " is a program of another kind: build a job with softcell_add_spu_kernel");
  }
  if (image.begin != spu::kJobAreaBegin) {
    throw std::invalid_argument("kernel " + image.name +
                                " cannot be a job: it is a resident kernel (RESIDENT_AT), which calls jobs");
  }
  if (image.program) {
    throw std::invalid_argument(
        "kernel " + image.name +
        " is a program, which is loaded whole: build a job without PROGRAM and in C++");
  }
  const std::uint32_t room = loop.stack_top - loop.sizes.stack;
  if (image.sizes.total() > room) {
    throw std::invalid_argument("kernel " + image.name + " with its stack takes " +
                                std::to_string(image.sizes.total()) +
                                " bytes of local store; the job loop leaves " + std::to_string(room));
  }
  if (wants_checked && !image.checked) {
    throw std::invalid_argument(
        "kernel " + image.name +
        " is not a checked image, but SpeOptions::findings asks for one; load its checked image");
  }
}

dma::Buffer<JobDescriptor> room_for(dma::AddressSpace& memory, const std::string& chain, std::size_t jobs) {
  return {memory, chain + ": jobs", std::max<std::size_t>(jobs, 1), kDescriptors};
}

/// Wakes a thread that waits for a chain when an SPE writes the chain's last line.
class DoneListener final : public dma::ReservationListener {
 public:
  void on_reservation_lost() override {
    {
      const std::scoped_lock lock(mutex_);
      written_ = true;
    }
    wake_up_.notify_one();
  }
  void reset() {
    const std::scoped_lock lock(mutex_);
    written_ = false;
  }
  void wait() {
    std::unique_lock lock(mutex_);
    wake_up_.wait(lock, [this] { return written_; });
  }
  void wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    wake_up_.wait_for(lock, time, [this] { return written_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_up_;
  bool written_ = false;
};

}  // namespace

struct JobChain::State {
  State(JobSystem::State& system, const std::string& name, std::size_t most);
  ~State();

  void link_stages();
  bool look();
  bool finished();
  void wait();
  void collect();

  JobSystem::State& shared;
  std::string name;
  std::size_t board_slot = 0;
  dma::Buffer<JobDescriptor> descriptors;
  dma::Buffer<ChainDone> done;
  DoneListener listener;
  dma::ReservationHolder holder;
  std::vector<std::uint32_t> stage_ends;
  std::vector<const ls_sim::KernelImage*> kernels;  // of each job
  std::vector<JobFailure> failures;
  std::vector<JobFailure> faults;  // of the current kick; guarded by the system's mutex
  std::size_t most_jobs;
  std::uint32_t kicks = 0;
  bool under_way = false;
};

struct JobSystem::State {
  State(dma::AddressSpace& space, const ls_sim::SpeOptions& options, const ls_sim::KernelImage& job_loop);
  ~State();

  void stop();
  void kick(JobChain::State& chain, const ChainState& state);

  // Call these with the mutex locked.
  void on_run_ended(int spe, const ls_sim::RunResult& result);
  bool record_failure(int spe, const ls_sim::RunResult& result);
  void end_loops();
  void start_loops();
  void start_loop(int spe);
  void ring(int spe);
  void announce_work();
  void fail_unfinished();
  void fail_if_under_way(JobChain::State& chain, const std::string& reason);
  void tell_end(JobChain::State& chain, std::uint32_t kick);
  template <class Line, class Change>
  Line change(dma::Buffer<Line>& at, const Change& how, std::size_t index = 0) {
    return change_line(memory.reservations(), holder, at, how, index);
  }
  template <class Change>
  ChainState change_state(const JobChain::State& chain, const Change& how) {
    return change(chain_states, how, chain.board_slot);
  }

  struct Placed {
    const ls_sim::KernelImage* kernel;
    dma::Buffer<std::byte> bytes;
  };

  dma::AddressSpace& memory;
  const ls_sim::KernelImage& loop;
  bool wants_checked;
  bool takes_turns;  // SPEs run only while the PPU side waits for them
  dma::Buffer<JobBoard> board;
  dma::Buffer<JobBell> bells;  // for each SPE
  /// For each chain, by its place on the board. A place stays when its chain is destroyed: an SPE that has read the board before may look
  /// at the line afterwards, and finds nothing there to take, or a job of the next chain.
  dma::Buffer<ChainState> chain_states;
  std::vector<Placed> images;

  std::mutex mutex;  // guards all members below; SPEs' threads lock it when a loop has ended
  dma::ReservationHolder holder;
  std::array<JobChain::State*, spu::kMaxChains> chains{};
  bool stopping = false;
  int loops_left = 0;     // loops that have not ended yet
  std::string breakdown;  // why all loops end or have ended, if one has failed by itself

  ls_sim::SpeGroup group;
  ls_sim::SpeGroup::Outside outside;  // the PPU side may always kick a chain
};

JobSystem::State::State(dma::AddressSpace& space, const ls_sim::SpeOptions& options,
                        const ls_sim::KernelImage& job_loop)
    : memory(space),
      loop(require_loop(job_loop)),
      wants_checked(options.findings != nullptr),
      takes_turns(options.interleaving != ls_sim::Interleaving::kFree),
      board(space, "job board", 1, {.record = kBoardRecord}),
      bells(space, "job bells", dma::kSpeCount, kWords),
      chain_states(space, "job chains", spu::kMaxChains, {.record = kStateRecord}),
      holder(space.reservations()),
      group(space, options),
      outside(group) {
  group.on_end([this](int spe, const ls_sim::RunResult& result) {
    const std::scoped_lock lock(mutex);
    on_run_ended(spe, result);
  });
  const std::scoped_lock lock(mutex);
  start_loops();
}

JobSystem::State::~State() {
  SC_ASSERT(std::ranges::count(chains, nullptr) == std::ssize(chains),
            "a job system ends before {} of its chains",
            std::ssize(chains) - std::ranges::count(chains, nullptr));
  stop();
}

void JobSystem::State::stop() {
  for (JobChain::State* const chain : chains)
    if (chain != nullptr) chain->wait();
  {
    const std::scoped_lock lock(mutex);
    stopping = true;
    end_loops();
  }
  for (int spe = 0; spe < group.spes(); ++spe) group.wait(spe);
}

/// Loops end after they have finished their current job.
void JobSystem::State::end_loops() {
  change(board, [](JobBoard& line) {
    line.stop = 1;
    ++line.generation;
  });
  for (int spe = 0; spe < group.spes(); ++spe) ring(spe);
}

void JobSystem::State::start_loops() {
  change(board, [](JobBoard& line) { line.stop = 0; });
  for (int spe = 0; spe < group.spes(); ++spe) start_loop(spe);
}

void JobSystem::State::start_loop(int spe) {
  change(board,
         [spe](JobBoard& line) { line.asleep = static_cast<std::uint16_t>(line.asleep & ~(1u << spe)); });
  SC_ASSERT(loops_left < group.spes(), "the loop of SPE {} starts, and {} run", spe, loops_left);
  group.start_resident(spe, loop, {static_cast<std::uint64_t>(spe), board.ea().value, bells.ea().value});
  ++loops_left;
}

void JobSystem::State::ring(int spe) {
  SC_ASSERT(spe >= 0 && spe < group.spes(), "SPE {} of {}", spe, group.spes());
  const JobBell rung{.rung = 1, .pad = {}};
  const auto which = static_cast<std::size_t>(spe);
  memory.reservations().store_line(holder, bells.ea(which), host_of(bells, which),
                                   reinterpret_cast<const std::byte*>(&rung));
}

/// Wakes at most one SPE: if it leaves work, it wakes the next one.
void JobSystem::State::announce_work() {
  int sleeper = 0;
  change(board, [&sleeper](JobBoard& line) {
    ++line.generation;
    sleeper = std::countr_zero(line.asleep);
    line.asleep = static_cast<std::uint16_t>(line.asleep & (line.asleep - 1));
  });
  if (sleeper < group.spes()) ring(sleeper);
}

void JobSystem::State::kick(JobChain::State& chain, const ChainState& state) {
  const std::scoped_lock lock(mutex);
  SC_ASSERT(chains[chain.board_slot] == &chain, "chain {} of the board is another's", chain.board_slot);
  memory.reservations().store_line(holder, chain_states.ea(chain.board_slot),
                                   host_of(chain_states, chain.board_slot),
                                   reinterpret_cast<const std::byte*>(&state));
  if (stopping) {
    fail_if_under_way(
        chain, "chain '" + chain.name + "' was kicked after JobSystem::stop(): none of its jobs has run");
  } else if (loops_left == 0) {
    breakdown.clear();
    start_loops();
  } else {
    announce_work();
  }
}

/// Runs on the SPE's thread. A job loop ends when it is told to, or when a fault or a stop instruction ends the job that it has called:
/// then another loop takes its place. If it ends for another reason, a job may be lost.
void JobSystem::State::on_run_ended(int spe, const ls_sim::RunResult& result) {
  SC_ASSERT(loops_left > 0, "the loop of SPE {} ends, and none was running", spe);
  --loops_left;
  const bool was_told = stopping || !breakdown.empty();
  const bool is_known = result.job.value != 0 && record_failure(spe, result);
  if (!was_told && is_known) {
    start_loop(spe);
  } else if (!was_told) {
    breakdown = (result.fault ? result.fault->message()
                              : "SPE " + std::to_string(spe) + ", kernel " + loop.name +
                                    ": ended with stop code " + std::to_string(result.stop_code)) +
                "; the loop has ended without naming a job, so that all jobs under way are lost";
    end_loops();
  }
  if (loops_left == 0 && !breakdown.empty()) fail_unfinished();
}

/// Does what the loop would have done: counts the job, as failed. A failed stage is the chain's last one.
/// @return  false: the job belongs to no chain.
bool JobSystem::State::record_failure(int spe, const ls_sim::RunResult& result) {
  for (JobChain::State* chain : chains) {
    if (chain == nullptr) continue;
    const std::uint64_t offset = result.job.value - chain->descriptors.ea().value;
    if (offset >= chain->descriptors.size_bytes()) continue;
    const auto job = static_cast<std::uint32_t>(offset / sizeof(JobDescriptor));
    SC_ASSERT(job < chain->kernels.size(), "SPE {} fails job {} of {}", spe, job, chain->kernels.size());
    chain->faults.push_back({job, result.fault ? result.fault->message()
                                               : "SPE " + std::to_string(spe) + ", kernel " +
                                                     chain->kernels[job]->name + ": stopped with code " +
                                                     std::to_string(result.stop_code)});
    const ChainState state = change_state(*chain, [&](ChainState& line) {
      ++line.finished;
      if (line.failed == 0 || job < line.failed_job) {
        line.failed_job = job;
        line.failed_status = kFaulted;
      }
      ++line.failed;
    });
    if (state.finished == state.stage_end) tell_end(*chain, state.kick);
    return true;
  }
  return false;
}

/// No loop runs, and none will before the next kick: a job that has not ended by now never would.
void JobSystem::State::fail_unfinished() {
  for (JobChain::State* chain : chains)
    if (chain != nullptr) fail_if_under_way(*chain, breakdown);
}

void JobSystem::State::fail_if_under_way(JobChain::State& chain, const std::string& reason) {
  // stop() has waited for all loops to end, but perhaps not for on_run_ended() to count the last one.
  SC_ASSERT(stopping || loops_left == 0, "chain '{}' fails while {} loops run", chain.name, loops_left);
  ChainDone done;
  memory.reservations().load_and_reserve(holder, chain.done.ea(), host_of(chain.done),
                                         reinterpret_cast<std::byte*>(&done));
  std::uint32_t jobs = 0;
  const ChainState state = change_state(chain, [&](ChainState& line) {
    if (line.kick == done.kick) return;  // not under way: its owner may be filling it
    jobs = static_cast<std::uint32_t>(chain.kernels.size());
    line.next = line.stage_end;  // so that nobody takes one
    if (line.failed++ == 0) {
      line.failed_job = jobs;
      line.failed_status = kFaulted;
    }
  });
  if (state.kick == done.kick) return;
  chain.faults.push_back({jobs, reason});
  tell_end(chain, state.kick);
}

void JobSystem::State::tell_end(JobChain::State& chain, std::uint32_t kick) {
  const ChainDone done{.kick = kick, .pad = {}};
  memory.reservations().store_line(holder, chain.done.ea(), host_of(chain.done),
                                   reinterpret_cast<const std::byte*>(&done));
}

JobSystem::JobSystem(dma::AddressSpace& memory, const ls_sim::SpeOptions& options,
                     const ls_sim::KernelImage& job_loop)
    : state_(std::make_unique<State>(memory, options, job_loop)) {}

JobSystem::~JobSystem() = default;

void JobSystem::stop() { state_->stop(); }

JobImage JobSystem::load(const ls_sim::KernelImage& image) {
  SC_ASSERT(!image.bytes.empty(), "the image of kernel {} is empty", image.name);
  auto placed = std::find_if(state_->images.begin(), state_->images.end(),
                             [&](const State::Placed& known) { return known.kernel == &image; });
  if (placed == state_->images.end()) {
    require_job(image, state_->loop, state_->wants_checked);
    // Whole quadwords, which a get can move.
    dma::Buffer<std::byte> bytes(state_->memory, "image " + image.name,
                                 dma::round_up_to_quadword(image.bytes.size()), kRead);
    std::memcpy(bytes.data(), image.bytes.data(), image.bytes.size());
    state_->group.register_job_image(bytes.ea(), image);
    placed = state_->images.insert(placed, {&image, std::move(bytes)});
  }
  JobImage result;
  result.kernel_ = &image;
  result.ea_ = placed->bytes.ea();
  return result;
}

std::vector<ls_sim::SpeStatistics> JobSystem::statistics() const {
  std::vector<ls_sim::SpeStatistics> result;
  for (int spe = 0; spe < spes(); ++spe) result.push_back(state_->group.statistics(spe));
  return result;
}

int JobSystem::spes() const { return state_->group.spes(); }

JobChain::State::State(JobSystem::State& system, const std::string& chain_name, std::size_t most)
    : shared(system),
      name(chain_name),
      descriptors(room_for(system.memory, chain_name, most)),
      done(system.memory, chain_name + ": done", 1, kWords),
      holder(system.memory.reservations(), &listener),
      most_jobs(most) {
  stage_ends.reserve(most);  // each stage has a job
  const std::scoped_lock lock(shared.mutex);
  const auto slot = std::find(shared.chains.begin(), shared.chains.end(), nullptr);
  if (slot == shared.chains.end()) {
    throw std::runtime_error("no room for chain '" + name + "': a job system has at most " +
                             std::to_string(spu::kMaxChains) +
                             " chains (a solver has one, a skinner two, a world's contacts on SPEs two)");
  }
  *slot = this;
  board_slot = static_cast<std::size_t>(slot - shared.chains.begin());
  // Clears what the last chain in this place has left.
  shared.change_state(*this, [](ChainState& line) { line = {}; });
  shared.change(shared.board,
                [&](JobBoard& line) { line.chains[board_slot] = shared.chain_states.ea(board_slot).value; });
}

JobChain::State::~State() {
  wait();
  const std::scoped_lock lock(shared.mutex);
  shared.change(shared.board, [&](JobBoard& line) { line.chains[board_slot] = 0; });
  shared.chains[board_slot] = nullptr;
}

/// Tells each job where the stage after its own ends.
void JobChain::State::link_stages() {
  std::uint32_t job = 0;
  for (std::size_t stage = 0; stage < stage_ends.size(); ++stage) {
    const std::uint32_t next_end = stage + 1 < stage_ends.size() ? stage_ends[stage + 1] : 0;
    for (; job < stage_ends[stage]; ++job) descriptors[job].next_stage_end = next_end;
  }
  SC_ASSERT(job == kernels.size(), "the last stage ends at job {} of {}", job, kernels.size());
}

/// Reads the last line and reserves it, so that the listener hears of its next change.
bool JobChain::State::look() {
  if (!under_way) return true;
  ChainDone last;
  listener.reset();
  shared.memory.reservations().load_and_reserve(holder, done.ea(), host_of(done),
                                                reinterpret_cast<std::byte*>(&last));
  if (last.kick != kicks) return false;
  under_way = false;
  collect();
  return true;
}

bool JobChain::State::finished() {
  if (under_way && shared.takes_turns) shared.group.wait_until_idle();
  return look();
}

/// If SPEs take turns, all of them sleep by now, until a job that waits in vain reaches its deadline. Loops that start anew after that need
/// turns again, so this looks from time to time.
void JobChain::State::wait() {
  constexpr std::chrono::milliseconds kNextLook{5};
  while (!finished()) {
    if (shared.takes_turns)
      listener.wait_for(kNextLook);
    else
      listener.wait();
  }
}

void JobChain::State::collect() {
  ChainState state;
  shared.memory.reservations().load_and_reserve(holder, shared.chain_states.ea(board_slot),
                                                host_of(shared.chain_states, board_slot),
                                                reinterpret_cast<std::byte*>(&state));
  {
    const std::scoped_lock lock(shared.mutex);
    failures = std::move(faults);
    faults.clear();
  }
  if (state.failed != 0 && state.failed_status != kFaulted) {
    SC_ASSERT(state.failed_job < kernels.size() && state.failed > failures.size(),
              "job {} of {} has failed, with {} more and {} by faults", state.failed_job, kernels.size(),
              state.failed, failures.size());
    std::string message = "kernel " + kernels[state.failed_job]->name + ": refused its job with status " +
                          std::to_string(state.failed_status);
    const std::size_t others = state.failed - failures.size() - 1;
    if (others != 0) message += ", and " + std::to_string(others) + " more jobs failed";
    failures.push_back({state.failed_job, std::move(message)});
  }
  std::sort(failures.begin(), failures.end(),
            [](const JobFailure& a, const JobFailure& b) { return a.job < b.job; });
}

JobChain::JobChain(JobSystem& system, const std::string& name, std::size_t most_jobs)
    : state_(std::make_unique<State>(*system.state_, name, most_jobs)) {}

JobChain::~JobChain() = default;

void JobChain::reserve(std::size_t most_jobs) {
  State& state = *state_;
  if (most_jobs <= state.most_jobs) return;
  state.wait();
  dma::Buffer<JobDescriptor> more = room_for(state.shared.memory, state.name, most_jobs);
  state.stage_ends.reserve(most_jobs);
  std::copy_n(state.descriptors.data(), size(), more.data());
  state.descriptors = std::move(more);
  state.most_jobs = most_jobs;
}

void JobChain::clear() {
  SC_ASSERT(!state_->under_way, "clear() while the chain's {} jobs are under way", size());
  state_->kernels.clear();
  state_->stage_ends.clear();
}

void JobChain::add(const Job& job) {
  SC_ASSERT(!state_->under_way, "add() while the chain's {} jobs are under way", size());
  SC_ASSERT(job.image.kernel_ != nullptr, "job {} has no image; JobSystem::load() returns one", size());
  if (state_->kernels.size() == state_->most_jobs) {
    throw std::length_error("chain '" + state_->name + "' is full: it has room for " +
                            base::counted(state_->most_jobs, "job") + "; reserve() makes more room");
  }
  const ls_sim::KernelImage& kernel = *job.image.kernel_;
  JobDescriptor descriptor{};
  descriptor.image_ea = job.image.ea_.value;
  descriptor.argp = job.argp.value;
  descriptor.envp = job.envp.value;
  descriptor.image_bytes = static_cast<std::uint32_t>((kernel.bytes.size() + 15) / 16 * 16);
  descriptor.entry = kernel.main;
  descriptor.data_begin = kernel.data_begin;
  descriptor.data_bytes = (kernel.data_end - kernel.data_begin + 15) / 16 * 16;
  state_->descriptors[state_->kernels.size()] = descriptor;
  state_->kernels.push_back(&kernel);
}

void JobChain::sync() {
  const auto end = static_cast<std::uint32_t>(state_->kernels.size());
  if (end != (state_->stage_ends.empty() ? 0 : state_->stage_ends.back())) state_->stage_ends.push_back(end);
}

void JobChain::kick() {
  SC_ASSERT(!state_->under_way, "kick() while the chain's {} jobs are under way", size());
  state_->failures.clear();
  state_->faults.clear();
  if (state_->kernels.empty()) return;
  sync();
  state_->link_stages();
  ChainState state{};
  state.descriptors_ea = state_->descriptors.ea().value;
  state.done_ea = state_->done.ea().value;
  state.kick = ++state_->kicks;
  state.stage_end = state_->stage_ends.front();
  state_->under_way = true;
  state_->shared.kick(*state_, state);
}

std::size_t JobChain::size() const { return state_->kernels.size(); }

bool JobChain::finished() { return state_->finished(); }

void JobChain::wait() { state_->wait(); }

const std::vector<JobFailure>& JobChain::failures() const {
  SC_ASSERT(!state_->under_way, "failures() of {} jobs without finished() or wait() before", size());
  return state_->failures;
}

}  // namespace softcell::ppu
