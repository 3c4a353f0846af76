#include "debug_session.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr auto kLookPeriod = std::chrono::milliseconds(20);

bool overlaps(const Watchpoint& watchpoint, std::uint32_t quadword) {
  return watchpoint.begin < quadword + dma::kQuadwordBytes && quadword < watchpoint.begin + watchpoint.bytes;
}

bool concerns(const Watchpoint& watchpoint, bool is_store) {
  return watchpoint.kind == Watchpoint::kBoth || (watchpoint.kind == Watchpoint::kStores) == is_store;
}

}  // namespace

DebugSession::DebugSession(const ls_sim::KernelImage& image, const KernelTask& task,
                           const RunSettings& settings)
    : image_(image), task_(task), settings_(settings) {
  SC_ASSERT(image.machine == ls_sim::Machine::kSpu, "{} is debugged as a program for the SPU", image.name);
  settings_.clock = ls_sim::Clock::kSimulated;
  settings_.debugger = this;
}

// ---- the SPEs' threads

bool DebugSession::on_instruction(int spe, dma::LocalStoreAddress pc) {
  if (abandoned_.load(std::memory_order_relaxed)) return false;
  ++count_;
  positions_[index(spe)] = pc.value;
  for (const Edit& edit : edits_) {
    if (edit.at == count_) apply(edit);
  }
  const auto stop = stop_at(spe, pc.value);
  return !stop || stand(*stop);
}

std::optional<DebugStop> DebugSession::stop_at(int spe, std::uint32_t pc) {
  const std::optional<Watchpoint> accessed = std::exchange(accessed_, std::nullopt);
  const bool is_interrupted = interrupt_.load(std::memory_order_relaxed);
  if (is_interrupted && goal_.kind != Goal::kEnd) {
    interrupt_ = false;
    return DebugStop{.kind = DebugStop::kInterrupted, .spe = spe};
  }
  switch (goal_.kind) {
    case Goal::kEnd:
      return std::nullopt;
    case Goal::kNumber:
      if (count_ == goal_.number) return DebugStop{.kind = DebugStop::kStep, .spe = spe};
      return std::nullopt;
    case Goal::kLastStopBefore:
      // When going back, an access stops the run before its instruction; on_access() does that.
      if (count_ >= goal_.number) return DebugStop{.kind = DebugStop::kStep, .spe = spe};
      if (breakpoints_[pc / 4]) {
        best_ = {.kind = DebugStop::kBreakpoint, .spe = spe};
        best_number_ = count_;
      }
      return std::nullopt;
    default:
      break;
  }
  if (accessed) return DebugStop{.kind = DebugStop::kWatchpoint, .spe = spe, .watchpoint = *accessed};
  if (breakpoints_[pc / 4]) return DebugStop{.kind = DebugStop::kBreakpoint, .spe = spe};
  if (goal_.kind != Goal::kStepOf) return std::nullopt;
  if (goal_.spe == spe && std::exchange(goal_.must_begin, false)) return std::nullopt;
  if (goal_.spe != spe && !has_ended(goal_.spe)) return std::nullopt;
  return DebugStop{.kind = DebugStop::kStep, .spe = spe};
}

void DebugSession::on_access(int spe, dma::LocalStoreAddress quadword, bool is_store) {
  const auto watched = std::ranges::find_if(watchpoints_, [&](const Watchpoint& watchpoint) {
    return overlaps(watchpoint, quadword.value) && concerns(watchpoint, is_store);
  });
  if (watched == watchpoints_.end()) return;
  accessed_ = *watched;
  if (goal_.kind != Goal::kLastStopBefore || count_ >= goal_.number) return;
  best_ = {.kind = DebugStop::kWatchpoint, .spe = spe, .watchpoint = *watched};
  best_number_ = count_;
}

/// @return  whether the run goes on.
bool DebugSession::stand(const DebugStop& stop) {
  std::unique_lock lock(mutex_);
  stop_ = stop;
  state_ = State::kStanding;
  changed_.notify_all();
  changed_.wait(lock, [this] { return state_ == State::kRunning || abandoned_; });
  return !abandoned_;
}

// ---- the session's own thread

void DebugSession::begin(const Goal& goal) {
  abandon();
  abandoned_ = false;
  count_ = 0;
  states_ = {};
  ended_ = {};
  positions_.fill(image_.entry);
  accessed_.reset();
  goal_ = goal;
  state_ = State::kRunning;
  runner_ = std::jthread([this] {
    dma::AddressSpace memory;
    const KernelBuffers buffers(memory, task_);
    KernelRun run = run_kernel(memory, image_, buffers, task_, settings_);
    const std::lock_guard lock(mutex_);
    result_ = std::move(run);
    stop_ = {.kind = DebugStop::kEnded, .spe = stop_.spe};
    state_ = State::kEnded;
    changed_.notify_all();
  });
}

/// Ends the run wherever it is.
void DebugSession::abandon() {
  {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    changed_.notify_all();
  }
  if (runner_.joinable()) runner_.join();
}

DebugStop DebugSession::wait(const Interrupted& interrupted) {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kLookPeriod, [this] { return state_ != State::kRunning; })) {
    lock.unlock();
    if (interrupted()) interrupt_ = true;
    lock.lock();
  }
  interrupt_ = false;
  return stop_;
}

DebugStop DebugSession::start() {
  begin({.kind = Goal::kNumber, .number = 1});
  return wait([] { return false; });
}

DebugStop DebugSession::run_to(const Goal& goal, const Interrupted& interrupted) {
  {
    const std::lock_guard lock(mutex_);
    SC_ASSERT(state_ == State::kStanding, "the program is continued at instruction {} but is not stopped",
              count_);
    goal_ = goal;
    accessed_.reset();
    state_ = State::kRunning;
    changed_.notify_all();
  }
  return wait(interrupted);
}

DebugStop DebugSession::go_on(const Interrupted& interrupted) {
  return back_before_a_fault(run_to({.kind = Goal::kStops}, interrupted), interrupted);
}
DebugStop DebugSession::step(int spe, const Interrupted& interrupted) {
  SC_ASSERT(!has_ended(spe), "a step of SPE {}, which has ended", spe);
  return back_before_a_fault(
      run_to({.kind = Goal::kStepOf, .spe = spe, .must_begin = !is_running(spe)}, interrupted), interrupted);
}

/// Once a run has ended, its registers and local stores are gone. After a fault the user wants to see them, so the session goes back there.
DebugStop DebugSession::back_before_a_fault(const DebugStop& stop, const Interrupted& interrupted) {
  if (stop.kind != DebugStop::kEnded || std::exchange(shown_fault_, count_) == count_) return stop;
  const auto failed =
      std::ranges::find_if(result_->spes, [](const SpeRun& spe) { return spe.result.fault.has_value(); });
  if (failed == result_->spes.end()) return stop;
  const DebugStop back = run_again_to(count_, interrupted);
  if (back.kind != DebugStop::kStep) return back;
  return {.kind = DebugStop::kFault, .spe = static_cast<int>(failed - result_->spes.begin())};
}

DebugStop DebugSession::finish() {
  return run_to({.kind = Goal::kEnd}, [] { return false; });
}

DebugStop DebugSession::run_again_to(std::uint64_t number, const Interrupted& interrupted) {
  begin({.kind = Goal::kNumber, .number = std::max<std::uint64_t>(number, 1)});
  return wait(interrupted);
}

DebugStop DebugSession::step_back(const Interrupted& interrupted) {
  const bool is_beginning = count_ <= 1;
  DebugStop stop = run_again_to(count_ - 1, interrupted);
  if (is_beginning && stop.kind == DebugStop::kStep) stop.kind = DebugStop::kBeginning;
  return stop;
}

/// One run finds the place, and another one goes there.
DebugStop DebugSession::go_back(const Interrupted& interrupted) {
  best_.reset();
  begin({.kind = Goal::kLastStopBefore, .number = count_});
  if (const DebugStop stop = wait(interrupted); stop.kind == DebugStop::kInterrupted) return stop;
  const auto found = best_;
  const DebugStop stop = run_again_to(found ? best_number_ : 1, interrupted);
  if (stop.kind != DebugStop::kStep) return stop;
  if (!found) return {.kind = DebugStop::kBeginning, .spe = stop.spe};
  return *found;
}

void DebugSession::set_watchpoint(const Watchpoint& watchpoint, bool is_set) {
  std::erase(watchpoints_, watchpoint);
  if (is_set) watchpoints_.push_back(watchpoint);
}

ls_sim::RegisterBytes DebugSession::read_register(int spe, int number) const {
  const auto* const state = states_[index(spe)];
  return state == nullptr ? ls_sim::RegisterBytes{} : state->read_register(number);
}

std::vector<std::byte> DebugSession::read_memory(int spe, std::uint32_t address, std::uint32_t bytes) const {
  SC_ASSERT(address <= dma::kLocalStoreBytes && bytes <= dma::kLocalStoreBytes - address, "{} bytes at {}",
            bytes, address);
  auto* const state = states_[index(spe)];
  if (state == nullptr) {
    std::vector<std::byte> loaded(bytes);
    const std::uint32_t end = image_.begin + static_cast<std::uint32_t>(image_.bytes.size());
    const std::uint32_t from = std::max(address, image_.begin), to = std::min(address + bytes, end);
    if (from < to)
      std::copy(image_.bytes.begin() + (from - image_.begin), image_.bytes.begin() + (to - image_.begin),
                loaded.begin() + (from - address));
    return loaded;
  }
  const auto part = state->local_store().subspan(address, bytes);
  return {part.begin(), part.end()};
}

void DebugSession::write_register(int spe, int number, const ls_sim::RegisterBytes& value) {
  edit({count_, spe, number, {value.begin(), value.end()}});
}
void DebugSession::write_memory(int spe, std::uint32_t address, const std::vector<std::byte>& bytes) {
  SC_ASSERT(address <= dma::kLocalStoreBytes && bytes.size() <= dma::kLocalStoreBytes - address,
            "{} bytes at {}", bytes.size(), address);
  edit({count_, spe, address, bytes});
}

/// Drops what was written later: it belongs to a future that no longer exists.
void DebugSession::edit(Edit made) {
  std::erase_if(edits_, [&](const Edit& other) { return other.at > made.at; });
  apply(made);
  edits_.push_back(std::move(made));
}

void DebugSession::apply(const Edit& edit) {
  auto* const state = states_[index(edit.spe)];
  if (state == nullptr) return;
  if (const auto* number = std::get_if<int>(&edit.where)) {
    ls_sim::RegisterBytes value;
    std::ranges::copy(edit.bytes, value.begin());
    state->write_register(*number, value);
  } else {
    std::ranges::copy(edit.bytes, state->local_store().begin() + std::get<std::uint32_t>(edit.where));
  }
}

}  // namespace softcell::tool
