#include "host_access.h"

#include <signal.h>
#include <ucontext.h>

#include <mutex>

#include "host_registers_decoder.h"

namespace softcell::dma {
namespace {

struct sigaction previous_segv, previous_bus;

const struct sigaction& previous_of(int signal) { return signal == SIGBUS ? previous_bus : previous_segv; }

void pass_on(int signal, siginfo_t* info, void* machine) {
  const struct sigaction& previous = previous_of(signal);
  if ((previous.sa_flags & SA_SIGINFO) != 0) return previous.sa_sigaction(signal, info, machine);
  if (previous.sa_handler == SIG_DFL) {
    sigaction(signal, &previous, nullptr);  // the instruction runs again and ends the process
    if (info->si_code <= 0) raise(signal);
  } else if (previous.sa_handler != SIG_IGN) {
    previous.sa_handler(signal);
  }
}

void handle(int signal, siginfo_t* info, void* machine) {
  host_access::Guard* const guard = host_access::current();
  if (guard == nullptr || info->si_code <= 0) {
    const bool is_access = guard == nullptr && signal == SIGSEGV && info->si_code > 0;
    auto& interrupted = static_cast<ucontext_t*>(machine)->uc_mcontext;
    if (is_access && access_host_register(reinterpret_cast<std::uint64_t>(info->si_addr), interrupted))
      return;
    return pass_on(signal, info, machine);
  }
  guard->address = info->si_addr;
  siglongjmp(guard->back, 1);
}

thread_local host_access::Guard* guard_of_thread = nullptr;

}  // namespace

namespace host_access {

Guard*& current() { return guard_of_thread; }

void unblock_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGSEGV);
  sigaddset(&signals, SIGBUS);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace host_access

void install_host_access_handlers() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};
    action.sa_sigaction = handle;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    sigaction(SIGSEGV, &action, &previous_segv);
    sigaction(SIGBUS, &action, &previous_bus);
  });
}

}  // namespace softcell::dma
