// softcell report: a trace as a page to look at.

#include <fmt/format.h>

#include "distinct_files.h"
#include "report_page.h"
#include "softcell/base/whole_file.h"
#include "verbs.h"

namespace softcell::demos {

int run_report(const ReportOptions& options) {
  check_distinct({{"the trace", options.trace}, {"--out", options.out}});
  const TraceFile trace = read_trace(options.trace);
  const std::string page = report_page(trace, options.trace.filename().string());
  base::WholeFile file(options.out);
  file.write(page);
  file.commit();

  std::size_t jobs = 0, commands = 0, findings = 0;
  for (const TraceSpe& spe : trace.spes) {
    jobs += spe.jobs.size();
    commands += spe.commands.size();
    findings += spe.findings.size();
  }
  fmt::print("trace:    {} SPEs, {} jobs, {} DMA commands, {} findings\n", trace.spes.size(), jobs, commands,
             findings);
  fmt::print("page:     {} ({:.1f} MB); it opens offline in any browser\n", options.out.string(),
             static_cast<double>(page.size()) / 1e6);
  return 0;
}

}  // namespace softcell::demos
