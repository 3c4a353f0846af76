// softcell spu run: one kernel on the user's own data.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "kernel_file.h"
#include "kernel_report.h"
#include "kernel_run.h"
#include "softcell/ls_sim/trace.h"
#include "spu_verbs.h"
#include "verb/output_files.h"

namespace softcell::tool {

int run_spu_run(const SpuRunOptions& options) {
  const KernelTask& task = options.task;
  std::vector<NamedFile> outputs = written_files(task);
  outputs.push_back({"--trace", options.trace});
  outputs.push_back({"--json", options.json});
  check_kept(read_files(task), outputs);
  OutputFiles files(outputs);
  const ls_sim::KernelImage image = load_kernel_file(task.image, task.checked);
  dma::AddressSpace memory;
  const KernelBuffers buffers(memory, task);
  std::optional<ls_sim::Trace> trace;
  if (options.trace) trace.emplace(task.spes);

  const KernelRun run =
      run_kernel(memory, image, buffers, task,
                 {.schedule = options.schedule, .clock = options.clock, .trace = trace ? &*trace : nullptr});

  const int status = exit_status(image, run);
  // Before files that perhaps cannot be written: what the kernel did is to be known all the same.
  print_statistics(image, run);
  print_problems(image, run);
  if (status == 0) buffers.write_files(files);
  if (trace) trace->write(files.open(*options.trace));
  if (options.json) {
    auto document = to_json(image, run);
    document["dma_schedule"] = dma::to_string(options.schedule);
    write_json(files.open(*options.json), document);
  }
  files.commit();
  return status;
}

}  // namespace softcell::tool
