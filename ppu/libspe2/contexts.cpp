// Contexts and gangs.

#include "libspe2.h"

#include <memory>
#include "object.h"

using softcell::libspe2::context_of;
using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::Objects;
using softcell::libspe2::shielded;

namespace {

constexpr unsigned int kIsolation = SPE_ISOLATE | SPE_ISOLATE_EMULATE;
constexpr unsigned int kFlags = SPE_CFG_SIGNOTIFY1_OR | SPE_CFG_SIGNOTIFY2_OR | SPE_MAP_PS |
                                SPE_EVENTS_ENABLE | SPE_AFFINITY_MEMORY | SPE_NOSCHED | kIsolation;
constexpr int kMostNeighbours = 2;

/// @return  null, with errno set.
spe_context_ptr_t no_context(int error) {
  errno = error;
  return nullptr;
}

spe_context_ptr_t create(unsigned int flags, spe_context* neighbour, std::shared_ptr<spe_gang_context> gang) {
  if ((flags & ~kFlags) != 0) return no_context(EINVAL);
  if ((flags & kIsolation) != 0) return no_context(ENODEV);
  if (neighbour != nullptr && neighbour->neighbours >= kMostNeighbours) return no_context(EEXIST);
  auto context = std::make_shared<spe_context>(flags);
  context->spe = Machine::get().contexts().create();
  if (context->spe == nullptr) return no_context(ENOMEM);
  using softcell::ls_sim::SignalMode;
  if ((flags & SPE_CFG_SIGNOTIFY1_OR) != 0) context->problem_state().set_signal_mode(1, SignalMode::kOr);
  if ((flags & SPE_CFG_SIGNOTIFY2_OR) != 0) context->problem_state().set_signal_mode(2, SignalMode::kOr);
  if (gang != nullptr) {
    if ((flags & SPE_AFFINITY_MEMORY) != 0 && gang->has_memory_affinity.exchange(true))
      return no_context(EEXIST);
    gang->contexts.fetch_add(1);
    context->gang = std::move(gang);
  }
  if (neighbour != nullptr) {
    neighbour->neighbours.fetch_add(1);
    context->neighbours.fetch_add(1);
  }
  Machine::get().count_context();
  return Objects<spe_context>::all().add(std::move(context));
}

}  // namespace

spe_context::~spe_context() {
  if (spe != nullptr) Machine::get().count_last(*spe);
  if (gang == nullptr) return;
  if ((flags & SPE_AFFINITY_MEMORY) != 0) gang->has_memory_affinity = false;
  gang->contexts.fetch_sub(1);
}

spe_context_ptr_t spe_context_create(unsigned int flags, spe_gang_context_ptr_t gang) {
  return shielded<spe_context_ptr_t>(nullptr, [&] {
    std::shared_ptr<spe_gang_context> with;
    if (gang != nullptr && (with = Objects<spe_gang_context>::all().find(gang)) == nullptr)
      return no_context(ESRCH);
    return create(flags, nullptr, std::move(with));
  });
}

spe_context_ptr_t spe_context_create_affinity(unsigned int flags, spe_context_ptr_t affinity_neighbor,
                                              spe_gang_context_ptr_t gang) {
  return shielded<spe_context_ptr_t>(nullptr, [&] {
    if (gang == nullptr) return no_context(EINVAL);
    auto with = Objects<spe_gang_context>::all().find(gang);
    if (with == nullptr) return no_context(ESRCH);
    std::shared_ptr<spe_context> neighbour;
    if (affinity_neighbor != nullptr) {
      neighbour = context_of(affinity_neighbor);
      if (neighbour == nullptr) return no_context(ESRCH);
      if (neighbour->gang != with) return no_context(EINVAL);
    }
    return create(flags, neighbour.get(), std::move(with));
  });
}

int spe_context_destroy(spe_context_ptr_t spe) {
  return softcell::libspe2::with_context(spe, [&](spe_context& context) {
    if (context.busy.exchange(true)) return fail(EAGAIN);
    if (Objects<spe_context>::all().remove(spe) == nullptr) return fail(ESRCH);
    context.destroyed = true;
    Machine::get().contexts().wake();
    return 0;
  });
}

spe_gang_context_ptr_t spe_gang_context_create(unsigned int flags) {
  return shielded<spe_gang_context_ptr_t>(nullptr, [&]() -> spe_gang_context_ptr_t {
    if (flags != 0) {
      errno = EINVAL;
      return nullptr;
    }
    return Objects<spe_gang_context>::all().add(std::make_shared<spe_gang_context>());
  });
}

int spe_gang_context_destroy(spe_gang_context_ptr_t gang) {
  return shielded(-1, [&] {
    const auto found = Objects<spe_gang_context>::all().find(gang);
    if (found == nullptr) return fail(ESRCH);
    if (found->contexts != 0) return fail(EAGAIN);
    Objects<spe_gang_context>::all().remove(gang);
    return 0;
  });
}
