// softcell spu debug: runs a program built for the SPU in a debugger.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "debugger/gdb_server.h"
#include "kernel_report.h"
#include "kernel_runs/kernel_file.h"
#include "spu_verbs.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"

namespace softcell::tool {
namespace {

constexpr std::chrono::hours kLongestSession{24};

}  // namespace

int run_spu_debug(const SpuDebugOptions& options) {
  const ls_sim::KernelImage image =
      load_kernel_file(options.task.image, options.task.checked, options.task.machine);
  if (image.machine != ls_sim::Machine::kSpu) {
    throw std::runtime_error("spu debug " + options.task.image +
                             ": this image is built for the host; gdb debugs it as softcell spu run runs it");
  }
  KernelTask task = options.task;
  task.deadline = kLongestSession;  // because people think slowly
  const InterruptGuard guard;
  const auto interrupted = [&guard] { return guard.interrupted(); };
  GdbConnection connection(options.port);
  fmt::print("a debugger may connect to port {}: target remote :{}\n", connection.port(), connection.port());
  std::fflush(stdout);
  while (!connection.accept()) {
    if (interrupted()) return kExitInterrupted;
  }
  DebugSession session(image, task, {.schedule = options.schedule});
  GdbServer server(connection, session);
  switch (server.serve(interrupted)) {
    case GdbServer::End::kKilled:
      return interrupted() ? kExitInterrupted : 0;
    case GdbServer::End::kDetached:
      session.finish();
      break;
    case GdbServer::End::kEnded:
      break;
  }
  print_statistics(image, session.result());
  print_problems(image, session.result());
  return exit_status(image, session.result());
}

}  // namespace softcell::tool
