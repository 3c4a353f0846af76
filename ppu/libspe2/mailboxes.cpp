// Mailboxes and signals.

#include <mutex>

#include "libspe2.h"
#include "object.h"

using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::Waits;
using softcell::libspe2::with_context;
using softcell::ls_sim::ContextState;

namespace {

bool is_behavior(unsigned int behavior) {
  return behavior == SPE_MBOX_ALL_BLOCKING || behavior == SPE_MBOX_ANY_BLOCKING ||
         behavior == SPE_MBOX_ANY_NONBLOCKING;
}

/// Moves values one by one, and waits as `behavior` says.
/// @param move_one  (index) moves one value, or returns false if that has to wait.
/// @param may_move  (state) whether one can be moved.
/// @return  how many were moved.
template <class MoveOne, class MayMove>
int move_values(spe_context& context, int count, unsigned int behavior, MoveOne&& move_one,
                MayMove&& may_move) {
  int moved = 0;
  for (;;) {
    while (moved < count && move_one(moved)) ++moved;
    if (moved == count || behavior == SPE_MBOX_ANY_NONBLOCKING) return moved;
    if (behavior == SPE_MBOX_ANY_BLOCKING && moved != 0) return moved;
    context.spe->move_proxy();  // the SPU may wait for it before it uses the mailbox
    Machine::get().contexts().wait(
        [&] { return context.destroyed || may_move(context.spe->state_in_wait()); });
    if (context.destroyed) return fail(ESRCH);
  }
}

}  // namespace

int spe_out_mbox_read(spe_context_ptr_t spe, unsigned int* mbox_data, int count) {
  return with_context(spe, [&](spe_context& context) {
    if (mbox_data == nullptr || count < 1) return fail(EINVAL);
    int read = 0;
    while (read < count) {
      const auto value = context.problem_state().read_out_mbox();
      if (!value) break;
      mbox_data[read++] = *value;
    }
    return read;
  });
}

int spe_out_mbox_status(spe_context_ptr_t spe) {
  return with_context(spe,
                      [](spe_context& context) { return static_cast<int>(context.spe->state().out_mbox); });
}

int spe_in_mbox_write(spe_context_ptr_t spe, unsigned int* mbox_data, int count, unsigned int behavior) {
  const auto work = [&](spe_context& context) {
    if (mbox_data == nullptr || count < 1 || !is_behavior(behavior)) return fail(EINVAL);
    const auto write = [&](int index) {
      const std::lock_guard lock(context.in_mbox);  // so that no other thread takes the free entry
      if (context.spe->state().in_mbox_free == 0) return false;
      context.problem_state().write_in_mbox(mbox_data[index]);
      return true;
    };
    return move_values(context, count, behavior, write,
                       [](const ContextState& state) { return state.in_mbox_free != 0; });
  };
  return with_context(spe, work, Waits::kForEvents);
}

int spe_in_mbox_status(spe_context_ptr_t spe) {
  return with_context(
      spe, [](spe_context& context) { return static_cast<int>(context.spe->state().in_mbox_free); });
}

int spe_out_intr_mbox_read(spe_context_ptr_t spe, unsigned int* mbox_data, int count, unsigned int behavior) {
  const auto work = [&](spe_context& context) {
    if (mbox_data == nullptr || count < 1 || !is_behavior(behavior)) return fail(EINVAL);
    const auto read = [&](int index) {
      const auto value = context.problem_state().read_out_intr_mbox();
      if (value) mbox_data[index] = *value;
      return value.has_value();
    };
    return move_values(context, count, behavior, read,
                       [](const ContextState& state) { return state.out_intr_mbox != 0; });
  };
  return with_context(spe, work, Waits::kForEvents);
}

int spe_out_intr_mbox_status(spe_context_ptr_t spe) {
  return with_context(
      spe, [](spe_context& context) { return static_cast<int>(context.spe->state().out_intr_mbox); });
}

int spe_signal_write(spe_context_ptr_t spe, unsigned int signal_reg, unsigned int data) {
  return with_context(spe, [&](spe_context& context) {
    if (signal_reg != SPE_SIG_NOTIFY_REG_1 && signal_reg != SPE_SIG_NOTIFY_REG_2) return fail(EINVAL);
    context.problem_state().write_signal(signal_reg == SPE_SIG_NOTIFY_REG_1 ? 1 : 2, data);
    return 0;
  });
}
