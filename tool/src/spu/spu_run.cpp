// softcell spu run: runs one kernel on the user's own data.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "coverage.h"
#include "kernel_report.h"
#include "kernel_runs/kernel_file.h"
#include "kernel_runs/kernel_run.h"
#include "kernel_runs/kernel_timing.h"
#include "softcell/ls_sim/trace.h"
#include "spu_verbs.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"
#include "verb/output_files.h"

namespace softcell::tool {

namespace {

/// The host's calls for a run. With several SPEs, the output of each call is printed at once.
ls_sim::HostCalls host_calls_of(const SpuRunOptions& options) {
  const auto printing_to = [](std::FILE* file) {
    return [file](std::string_view text) {
      std::fwrite(text.data(), 1, text.size(), file);
      std::fflush(file);
    };
  };
  const auto read_input = [](std::span<char> to) -> std::optional<std::size_t> {
    constexpr int kMilliseconds = 50;
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (poll(&input, 1, kMilliseconds) == 0) return std::nullopt;
    return static_cast<std::size_t>(std::max<ssize_t>(read(STDIN_FILENO, to.data(), to.size()), 0));
  };
  return {.standard_output = printing_to(stdout),
          .standard_error = printing_to(stderr),
          .standard_input = read_input,
          .folder = options.folder};
}

void check_folder(const SpuRunOptions& options) {
  if (!options.folder || std::filesystem::is_directory(*options.folder)) return;
  throw std::runtime_error("--folder " + options.folder->string() + ": there is no such folder");
}

}  // namespace

int run_spu_run(const SpuRunOptions& options) {
  const KernelTask& task = options.task;
  check_folder(options);
  std::vector<NamedFile> outputs = written_files(task);
  outputs.push_back({"--trace", options.trace});
  outputs.push_back({"--coverage", options.coverage});
  outputs.push_back({"--json", options.json});
  check_kept(read_files(task), outputs);
  OutputFiles files(outputs);
  const ls_sim::KernelImage image = load_kernel_file(task.image, task.checked, task.machine);
  const auto coverage = options.coverage ? std::make_unique<Coverage>(image) : nullptr;
  dma::AddressSpace memory;
  const KernelBuffers buffers(memory, task);
  std::optional<ls_sim::Trace> trace;
  const auto clock = options.timing ? ls_sim::TraceClock::kSimulated : ls_sim::TraceClock::kHost;
  if (options.trace) trace.emplace(task.spes, ls_sim::Trace::kMostEvents, clock);
  std::optional<ls_sim::Timing> timing;
  if (options.timing) timing.emplace(task.spes);

  const ls_sim::HostCalls host_calls = host_calls_of(options);
  const InterruptGuard guard;
  const KernelRun run = run_kernel(memory, image, buffers, task,
                                   {.schedule = options.schedule,
                                    .clock = options.clock,
                                    .timing = timing ? &*timing : nullptr,
                                    .debugger = coverage.get(),
                                    .trace = trace ? &*trace : nullptr,
                                    .host_calls = options.host_calls ? &host_calls : nullptr,
                                    .interrupted = [&] { return guard.interrupted(); }});

  const int status = exit_status(image, run);
  // This comes before files that may fail to be written, so that the user learns in any case what the kernel did.
  print_statistics(image, run);
  if (guard.interrupted()) {
    fmt::print(stderr, "softcell: interrupted; no file is written\n");
    return kExitInterrupted;
  }
  if (timing) print_timing(image, *timing);
  print_problems(image, run);
  if (status == 0) buffers.write_files(files);
  if (trace) trace->write(files.open(*options.trace));
  if (coverage != nullptr) {
    base::WholeFile& file = files.open(*options.coverage);
    file.write(coverage->lcov());
    file.finish();
  }
  if (options.json) {
    auto document = to_json(image, run);
    document["dma_schedule"] = dma::to_string(options.schedule);
    if (timing) document["timing"] = to_json(image, *timing);
    write_json(files.open(*options.json), document);
  }
  files.commit();
  return status;
}

}  // namespace softcell::tool
