// Events of contexts.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "libspe2.h"
#include "object.h"

using softcell::libspe2::context_of;
using softcell::libspe2::fail;
using softcell::libspe2::Machine;
using softcell::libspe2::Objects;
using softcell::libspe2::shielded;
using softcell::libspe2::Waits;

namespace {

constexpr unsigned int kEvents[] = {SPE_EVENT_OUT_INTR_MBOX, SPE_EVENT_IN_MBOX, SPE_EVENT_TAG_GROUP,
                                    SPE_EVENT_SPE_STOPPED};

struct Registration {
  std::shared_ptr<spe_context> context;
  spe_context_ptr_t spe;
  unsigned int event;  ///< one
  spe_event_data_t data;
};

/// Any thread.
struct Handler {
  std::atomic<int> waiting{0};
  std::atomic<std::uint64_t> changes{0};  ///< of the registrations

  std::mutex mutex;  // guards all below
  std::vector<Registration> registrations;
};

/// Whether the condition of the event holds. In a wait of the contexts, or with `state` asked for before.
bool holds(const Registration& registration, const softcell::ls_sim::ContextState& state) {
  if (registration.context->destroyed) return false;
  switch (registration.event) {
    case SPE_EVENT_OUT_INTR_MBOX:
      return state.out_intr_mbox != 0;
    case SPE_EVENT_IN_MBOX:
      return state.in_mbox_free != 0;
    case SPE_EVENT_TAG_GROUP:  // proxy commands are complete: they were moved before this was asked
      return registration.context->tags != 0;
    default:
      return registration.context->has_stop;
  }
}

/// errno of an event to be registered, or 0.
int check(const spe_event_unit_t* event, const std::shared_ptr<spe_context>& context) {
  if (event == nullptr || context == nullptr) return EINVAL;
  if ((event->events & ~static_cast<unsigned int>(SPE_EVENT_ALL_EVENTS)) != 0) return ENOTSUP;
  return (context->flags & SPE_EVENTS_ENABLE) == 0 ? ENOTSUP : 0;
}

/// change(handler, context): of a handler and an event that there are.
template <class Change>
int change_registrations(spe_event_handler_ptr_t evhandler, spe_event_unit_t* event, Change&& change) {
  return shielded(-1, [&] {
    const auto handler = Objects<Handler>::all().find(evhandler);
    if (handler == nullptr) return fail(ESRCH);
    const auto context = event == nullptr ? nullptr : context_of(event->spe);
    if (const int error = check(event, context)) return fail(error);
    {
      const std::lock_guard lock(handler->mutex);
      std::erase_if(handler->registrations, [&](const Registration& known) {
        return known.context->destroyed || (known.context == context && (known.event & event->events) != 0);
      });
      change(*handler, context);
      ++handler->changes;
    }
    Machine::get().contexts().wake();
    return 0;
  });
}

int take_events(const std::vector<Registration>& registrations, spe_event_unit_t* events, int max_events) {
  int taken = 0;
  for (const Registration& registration : registrations) {
    if (taken == max_events) break;
    if (holds(registration, registration.context->spe->state()))
      events[taken++] = {registration.event, registration.spe, registration.data};
  }
  return taken;
}

int wait_for_events(Handler& handler, spe_event_unit_t* events, int max_events, int timeout) {
  using Clock = std::chrono::steady_clock;
  std::optional<Clock::time_point> until;
  if (timeout >= 0) until = Clock::now() + std::chrono::milliseconds(timeout);
  for (;;) {
    std::uint64_t seen = 0;
    std::vector<Registration> registrations;
    {
      const std::lock_guard lock(handler.mutex);
      seen = handler.changes;
      registrations = handler.registrations;
    }
    for (const Registration& registration : registrations) {
      if (registration.context->tags != 0) registration.context->spe->move_proxy();
    }
    if (const int taken = take_events(registrations, events, max_events)) return taken;
    if (timeout == 0) return 0;
    const bool something = Machine::get().contexts().wait(
        [&] {
          return handler.changes != seen || std::ranges::any_of(registrations, [](const Registration& each) {
                   return holds(each, each.context->spe->state_in_wait());
                 });
        },
        until);
    if (!something) return 0;
  }
}

}  // namespace

spe_event_handler_ptr_t spe_event_handler_create(void) {
  return shielded<spe_event_handler_ptr_t>(
      nullptr, [] { return Objects<Handler>::all().add(std::make_shared<Handler>()); });
}

int spe_event_handler_destroy(spe_event_handler_ptr_t evhandler) {
  return shielded(-1, [&] {
    const auto handler = Objects<Handler>::all().find(evhandler);
    if (handler == nullptr) return fail(ESRCH);
    if (handler->waiting != 0) return fail(EAGAIN);
    return Objects<Handler>::all().remove(evhandler) == nullptr ? fail(ESRCH) : 0;
  });
}

int spe_event_handler_register(spe_event_handler_ptr_t evhandler, spe_event_unit_t* event) {
  return change_registrations(evhandler, event,
                              [&](Handler& handler, const std::shared_ptr<spe_context>& context) {
                                for (const unsigned int one : kEvents) {
                                  if ((event->events & one) != 0)
                                    handler.registrations.push_back({context, event->spe, one, event->data});
                                }
                              });
}

int spe_event_handler_deregister(spe_event_handler_ptr_t evhandler, spe_event_unit_t* event) {
  return change_registrations(evhandler, event, [](Handler&, const std::shared_ptr<spe_context>&) {});
}

int spe_event_wait(spe_event_handler_ptr_t evhandler, spe_event_unit_t* events, int max_events, int timeout) {
  const auto work = [&] {
    const auto handler = Objects<Handler>::all().find(evhandler);
    if (handler == nullptr) return fail(ESRCH);
    if (events == nullptr || max_events < 1 || timeout < -1) return fail(EINVAL);
    struct Waiting {  // also of a thread that is cancelled
      std::atomic<int>& count;
      ~Waiting() { count.fetch_sub(1); }
    };
    handler->waiting.fetch_add(1);
    const Waiting waiting{handler->waiting};
    return wait_for_events(*handler, events, max_events, timeout);
  };
  return shielded(-1, work, Waits::kForEvents);
}
