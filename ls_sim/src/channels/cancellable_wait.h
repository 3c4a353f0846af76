#pragma once
// Waits at which the thread may be cancelled, where MayBeCancelled allows it. (std::condition_variable lets no cancelled thread out: its
// functions are noexcept.)

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>

namespace softcell::ls_sim {

/// Sleeps until the condition is notified, or until the time has come. With the lock, which is held again afterwards, also in a thread that
/// is cancelled: its stack is unwound from here.
void wait_once(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
               std::optional<std::chrono::steady_clock::time_point> until);

}  // namespace softcell::ls_sim
