#pragma once
// The run of a thread group: from its start to its end.

#include <memory>
#include <mutex>

#include "lv2.h"

namespace softcell::psl1ght {

/// Makes contexts for the threads and has them run. @pre the lock of Lv2 is held; it is given up meanwhile.
/// @return  kOk when all threads are at work, or kWrongState, kAgain.
std::uint32_t start_group(std::unique_lock<std::mutex>& lock, const std::shared_ptr<Group>& group);

/// Gives its context the signal modes of its configuration. @pre it has a context
void configure_signals(SpuThread& thread);

/// Has the group end so. @pre the lock of Lv2 is held, and the group runs.
void end_group(Group& group, Group::End end);

}  // namespace softcell::psl1ght
