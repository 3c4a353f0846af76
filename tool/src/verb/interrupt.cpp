#include "interrupt.h"

#include <csignal>

namespace softcell::tool {
namespace {

volatile std::sig_atomic_t signalled = 0;

struct sigaction previous_interrupt, previous_terminate;

void note(int) { signalled = 1; }

}  // namespace

InterruptGuard::InterruptGuard() {
  signalled = 0;
  struct sigaction action {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &previous_interrupt);
  sigaction(SIGTERM, &action, &previous_terminate);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &previous_interrupt, nullptr);
  sigaction(SIGTERM, &previous_terminate, nullptr);
}

bool InterruptGuard::interrupted() const { return signalled != 0; }

}  // namespace softcell::tool
