#include "report_verb.h"

#include <string>

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "report_page.h"
#include "softcell/base/text.h"
#include "verb/output_files.h"

namespace softcell::tool {

int run_report(const ReportOptions& options) {
  check_kept({{"the trace", options.trace}}, {{"--out", options.out}});
  OutputFiles files({{"--out", options.out}});
  const TraceFile trace = read_trace(options.trace);
  const std::string page = report_page(trace, options.trace.filename().string());
  files.open(options.out).write(page);
  files.commit();

  std::size_t jobs = 0, commands = 0;
  std::uint64_t findings = 0;
  for (const TraceSpe& spe : trace.spes) {
    jobs += spe.jobs.size();
    commands += spe.commands.size();
    for (const TraceFinding& finding : spe.findings) findings += finding.count;
  }
  fmt::print("trace:    {}, {}, {}, {}\n", base::counted(trace.spes.size(), "SPE"),
             base::counted(jobs, "job"), base::counted(commands, "DMA command"),
             base::counted(findings, "finding"));
  fmt::print("page:     {} ({:.1f} MB); it opens offline in any browser\n", shown_name(options.out),
             static_cast<double>(page.size()) / 1e6);
  return 0;
}

namespace {

class ReportVerb final : public Verb {
 public:
  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* r = command.add_subcommand("report", "Make an HTML page of what --trace recorded");
    r->add_option("TRACE", options_.trace, "The file that --trace wrote")->required()->type_name("FILE");
    r->add_option("--out", options_.out, "HTML page to write, which opens offline; - is standard output")
        ->required()
        ->type_name("FILE");
    r->callback([&] { chosen = [this] { return run_report(options_); }; });
  }

 private:
  ReportOptions options_;
};

}  // namespace

std::unique_ptr<Verb> report_verb() { return std::make_unique<ReportVerb>(); }

}  // namespace softcell::tool
