#include "spe_monitor.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "cancellable_wait.h"
#include "softcell/base/assert.h"
#include "softcell/ls_sim/channel_name.h"
#include "softcell/ls_sim/source_lines.h"

namespace softcell::ls_sim {
namespace {

/// Tells apart the random decisions about turns from those of the MFCs, which have the numbers of jobs.
constexpr std::uint64_t kTurnStream = 0x7475'726E;

/// A turn lasts up to 2^0 .. 2^5 channel operations, each order of magnitude as often.
constexpr std::uint32_t kTurnMagnitudes = 6;

/// How long an SPE that has to sleep first polls whether it is woken: the host takes 15 to 50 us to put a thread to sleep and to wake it,
/// and the thread that wakes it waits 5 to 15 us for the host.
constexpr std::chrono::microseconds kLookFor{50};
constexpr int kPausesInLook = 16;  // between looks at the clock

/// Leaves the core's units to its other thread, if it has one.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Operations after which the PPU side may act, if no other SPE is behind in time.
constexpr std::uint32_t kOperationsInOrder = 64;

}  // namespace

SpeMonitor::SpeMonitor(const SpeOptions& options, PpuSide ppu_side)
    : takes_turns_(options.interleaving != Interleaving::kFree),
      by_time_(options.interleaving == Interleaving::kByTime),
      may_look_(!takes_turns_ && std::thread::hardware_concurrency() > 1),
      ppu_side_(ppu_side),
      members_(static_cast<std::size_t>(std::max(options.spes, 1))),
      outside_(ppu_side == PpuSide::kOutside ? 1 : 0),
      random_(options.schedule.seed, kTurnStream) {}

void SpeMonitor::start(int spe, const KernelImage& image, HostTime now, bool timed) {
  Member& m = member(spe);
  SC_ASSERT(m.state == State::kIdle, "SPE {} is started while it runs {}", spe, m.image->name);
  members_used_ = std::max(members_used_, index(spe) + 1);
  m.state = State::kRunnable;
  m.stopped = false;
  m.time = std::max(m.time, ended_time_);
  m.image = &image;
  m.started = timed ? std::optional(now) : std::nullopt;
  if (takes_turns_ && turn_ == kNobody) settle();
}

void SpeMonitor::end(int spe) {
  SC_ASSERT(member(spe).state == State::kRunnable, "SPE {} ends in state {}", spe, member(spe).state);
  member(spe).state = State::kIdle;
  ended_time_ = std::max(ended_time_, member(spe).time);
  wake_ppu();
  give_up_turn(spe);
}

void SpeMonitor::stop(int spe) {
  member(spe).stopped = true;
  member(spe).call();
}

bool SpeMonitor::await_first_turn(Lock& lock, int spe) {
  SC_ASSERT(lock.owns_lock() && runs(spe), "SPE {} waits for a turn without the lock or a run", spe);
  member(spe).wake_up.wait(lock, [&] { return may_go_on(spe); });
  return !member(spe).stopped;
}

bool SpeMonitor::pass_turn_now(int spe) {
  Lock lock(mutex_);
  Member& m = member(spe);
  SC_ASSERT(m.state == State::kRunnable, "SPE {} is at a channel in state {}", spe, m.state);
  if (!m.stopped && operations_left_ != 0 && !(by_time_ && is_behind(spe))) {
    --operations_left_;
    return true;
  }
  give_up_turn(spe);
  m.wake_up.wait(lock, [&] { return may_go_on(spe); });
  return !m.stopped;
}

/// Whether somebody else's clock is behind that of the SPE.
bool SpeMonitor::is_behind(int spe) const {
  const Member& m = members_[index(spe)];
  return std::ranges::any_of(used(), [&](const Member& other) {
    return other.state == State::kRunnable && (other.time < m.time || (other.time == m.time && &other < &m));
  });
}

void SpeMonitor::set_time(int spe, std::uint64_t now, std::uint64_t effect) {
  const Lock lock(mutex_);
  member(spe).time = now;
  effect_time_ = effect;
}

std::uint64_t SpeMonitor::take_woken_at(int spe) {
  const Lock lock(mutex_);
  return std::exchange(member(spe).woken_at, 0);
}

std::uint64_t SpeMonitor::time_at_start(int spe) {
  const Lock lock(mutex_);
  return member(spe).time;
}

Woken SpeMonitor::sleep(Lock& lock, int spe, const Sleep& sleep) {
  Member& m = member(spe);
  SC_ASSERT(lock.owns_lock(), "SPE {} sleeps at channel {} without the lock", spe, sleep.channel);
  SC_ASSERT(m.state == State::kRunnable, "SPE {} sleeps at channel {} in state {}", spe, sleep.channel,
            m.state);
  m.state = State::kAsleep;
  m.woken = Woken::kToLook;
  m.sleep = sleep;
  m.slept_ticks = 0;
  give_up_turn(spe);
  if (may_look_ && !sleep.until && !may_go_on(spe) && spe < looks_) look(lock, spe);
  while (!may_go_on(spe)) {
    if (!sleep.until || m.state == State::kRunnable) {
      m.wake_up.wait(lock);
    } else if (m.wake_up.wait_until(lock, *sleep.until) == std::cv_status::timeout) {
      wake(spe);
    }
  }
  m.state = State::kRunnable;
  return m.stopped ? Woken::kStopped : m.woken;
}

/// Waits for a while without the host's help. One SPE at a time, as each takes a core meanwhile: that of the lowest number, which is the
/// first to be woken where any will do.
void SpeMonitor::look(Lock& lock, int spe) {
  Member& m = member(spe);
  looks_ = spe;
  m.called = false;
  lock.unlock();
  const auto end = std::chrono::steady_clock::now() + kLookFor;
  do {
    for (int i = 0; i < kPausesInLook && !m.called.load(std::memory_order_relaxed); ++i) pause();
  } while (!m.called.load(std::memory_order_relaxed) && looks_ == spe &&
           std::chrono::steady_clock::now() < end);
  lock.lock();
  if (looks_ == spe) looks_ = kNobodyLooks;
}

void SpeMonitor::wake(int spe) { wake_with(spe, Woken::kToLook); }

void SpeMonitor::wake_with(int spe, Woken why) {
  Member& m = member(spe);
  if (m.state != State::kAsleep) return;
  m.state = State::kRunnable;
  m.woken = why;
  m.time = m.woken_at = std::max(m.time, effect_time_);
  if (takes_turns_ && turn_ == kNobody) settle();
  if (has_turn(spe)) m.call();
}

void SpeMonitor::wake_ppu() {
  if (!ppu_waits_.empty()) ppu_wake_up_.notify_all();
}

bool SpeMonitor::ppu_wait(Lock& lock, const std::function<bool()>& ready, std::optional<HostTime> until) {
  SC_ASSERT(lock.owns_lock(), "the PPU side waits without the lock, with {} waits before", ppu_waits_.size());
  SC_ASSERT(static_cast<bool>(ready), "the PPU side's wait has no condition; {} others wait",
            ppu_waits_.size());
  ppu_waits_.push_back(&ready);
  if (turn_ == kNobody) settle();
  const auto may_act = [&] { return (turn_ == kNobody || ppu_side_ == PpuSide::kOutside) && ready(); };
  // Also where the thread is cancelled in its wait.
  struct Place {
    SpeMonitor& monitor;
    const std::function<bool()>* wait;
    ~Place() { monitor.leave_ppu_wait(wait); }
  };
  const Place place{*this, &ready};
  while (!may_act()) {
    if (until && std::chrono::steady_clock::now() >= *until) return false;
    wait_once(ppu_wake_up_, lock, until);
  }
  return true;
}

void SpeMonitor::leave_ppu_wait(const std::function<bool()>* wait) {
  SC_ASSERT(std::ranges::count(ppu_waits_, wait) == 1, "one of the PPU side's {} waits is lost",
            ppu_waits_.size());
  ppu_waits_.erase(std::find(ppu_waits_.begin(), ppu_waits_.end(), wait));
  if (takes_turns_ && turn_ == kNobody && !ppu_waits_.empty()) settle();  // another thread's wait goes on
}

void SpeMonitor::ppu_pause(Lock& lock) {
  if (!takes_turns_ || ppu_side_ == PpuSide::kOutside) return;
  const std::uint64_t before = turns_drawn_;
  ppu_wait(lock, [&] { return turns_drawn_ != before || !any(State::kRunnable); });
}

void SpeMonitor::ppu_wait_until_idle(Lock& lock) {
  SC_ASSERT(takes_turns_, "{} SPEs that do not take turns are waited for", spes());
  ppu_wait(lock, [this] { return is_idle(); });
}

void SpeMonitor::change_outside(int difference) {
  SC_ASSERT(outside_ + difference >= 0, "{} act outside, and {} are taken away", outside_, -difference);
  outside_ += difference;
  if (turn_ == kNobody) settle();
}

bool SpeMonitor::any(State state) const {
  return std::ranges::any_of(used(), [state](const Member& m) { return m.state == state; });
}

/// Whether only somebody else can make an SPE run.
bool SpeMonitor::is_idle() const {
  return std::ranges::none_of(used(), [](const Member& m) {
    return m.state == State::kRunnable ||
           (m.state == State::kAsleep && (m.sleep.until || m.sleep.simulated_ticks));
  });
}

bool SpeMonitor::ppu_acts() const {
  return ppu_waits_.empty() ||
         std::any_of(ppu_waits_.begin(), ppu_waits_.end(), [](const auto* ready) { return (*ready)(); });
}

void SpeMonitor::give_up_turn(int spe) {
  if (turn_ != spe && turn_ != kNobody) return;  // stopped out of turn
  turn_ = kNobody;
  settle();
}

/// Called when an SPE or the PPU side has stopped running: chooses who runs next, or declares a deadlock.
void SpeMonitor::settle() {
  if (takes_turns_ && ppu_side_ == PpuSide::kInside && ppu_acts()) {
    wake_ppu();
    return;
  }
  if (any(State::kRunnable)) {
    if (takes_turns_) draw_turn();
    return;
  }
  if (!any(State::kAsleep) || let_time_pass()) return;
  if (outside_ == 0 && !ppu_acts()) declare_deadlock();
}

void SpeMonitor::draw_turn() {
  SC_ASSERT(turn_ == kNobody, "turn {} is drawn while SPE {} has one", turns_drawn_, turn_);
  runnable_.clear();
  for (int spe = 0; spe < static_cast<int>(members_used_); ++spe) {
    if (member(spe).state == State::kRunnable) runnable_.push_back(spe);
  }
  SC_ASSERT(!runnable_.empty(), "nobody can take turn {}", turns_drawn_);
  if (by_time_) {
    turn_ = *std::ranges::min_element(runnable_, {}, [this](int spe) { return member(spe).time; });
    operations_left_ = kOperationsInOrder;
  } else {
    turn_ = runnable_[random_.below(static_cast<std::uint32_t>(runnable_.size()))];
    operations_left_ = random_.below(1u << random_.below(kTurnMagnitudes));
  }
  ++turns_drawn_;
  member(turn_).call();
}

/// Ends the sleep of SPEs that wait for a time, when all SPEs sleep. The host's time passes by itself. Simulated time is advanced for all
/// sleepers alike, so that an SPE that sleeps often and briefly does not keep the others asleep.
/// @return  whether an SPE waits for a time
bool SpeMonitor::let_time_pass() {
  std::optional<std::uint64_t> ticks;
  for (const Member& m : used()) {
    if (m.state != State::kAsleep) continue;
    if (m.sleep.until) return true;
    if (!m.sleep.simulated_ticks) continue;
    ticks = std::min(ticks.value_or(*m.sleep.simulated_ticks), *m.sleep.simulated_ticks);
  }
  if (!ticks) return false;
  for (Member& m : used()) {
    if (m.state == State::kAsleep) pass_ticks(m, *ticks);
  }
  if (takes_turns_) draw_turn();
  return true;
}

void SpeMonitor::pass_ticks(Member& m, std::uint64_t ticks) {
  m.slept_ticks += ticks;
  if (!m.sleep.simulated_ticks) return;
  SC_ASSERT(ticks <= *m.sleep.simulated_ticks, "{} ticks pass, and an SPE wakes after {}", ticks,
            *m.sleep.simulated_ticks);
  *m.sleep.simulated_ticks -= ticks;
  if (*m.sleep.simulated_ticks != 0) return;
  m.state = State::kRunnable;
  if (!takes_turns_) m.call();
}

void SpeMonitor::declare_deadlock() {
  deadlock_.clear();
  for (int spe = 0; spe < spes(); ++spe) {
    const Member& m = member(spe);
    if (m.state != State::kAsleep) continue;
    if (!deadlock_.empty()) deadlock_ += ", ";
    SC_ASSERT(m.image != nullptr, "SPE {} sleeps at channel {} and runs no image", spe, m.sleep.channel);
    const std::string place = SourceLines(*m.image).place_of(m.sleep.position);
    deadlock_ += "SPE " + std::to_string(spe) + " (" + m.image->name + (place.empty() ? "" : ", " + place) +
                 ") waits to " +
                 (channel_access(m.sleep.channel) == ChannelAccess::kWrite ? "write " : "read ") +
                 std::string(channel_name(m.sleep.channel));
  }
  SC_ASSERT(!deadlock_.empty(), "a deadlock of {} SPEs, none of which sleeps", spes());
  deadlock_ += "; nothing is in flight, and nobody else can wake them";
  for (int spe = 0; spe < spes(); ++spe) wake_with(spe, Woken::kDeadlock);
}

}  // namespace softcell::ls_sim
