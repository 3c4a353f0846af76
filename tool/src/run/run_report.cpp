#include "run_report.h"

#include <fmt/format.h>

#include <utility>

#include "softcell/base/text.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

std::size_t count_in(const nlohmann::json& report, const char* list) { return report.at(list).size(); }

/// The rules that were broken and where, without addresses, which differ from run to run.
std::string mistakes(const nlohmann::json& report, const char* list) {
  std::string text;
  for (const auto& finding : report.at(list)) {
    text += fmt::format("{} {} {}\n", finding.at("rule").get<std::string>(),
                        finding.at("kernel").get<std::string>(), finding.at("place").get<std::string>());
  }
  return text;
}

}  // namespace

ProgramRun program_run(const ChildEnd& end, std::string output, const std::string& report) {
  ProgramRun run{end, std::move(output), nullptr};
  if (!report.empty()) run.report = nlohmann::json::parse(report);
  return run;
}

bool ProgramRun::has_findings() const {
  return !report.is_null() && count_in(report, "findings") + count_in(report, "faults") != 0;
}

std::string ProgramRun::outcome() const {
  std::string text = fmt::format("{}\n{}\n", end.status, output);
  if (!report.is_null()) text += mistakes(report, "findings") + mistakes(report, "faults");
  return text;
}

std::string ProgramRun::summary() const {
  if (report.is_null()) return "no SPE context was made with softcell's libspe2";
  std::string text = fmt::format(
      "{}, {}, {} ({:.1f} MB), {}", base::counted(report.at("contexts"), "SPE context"),
      base::counted(report.at("runs"), "run"), base::counted(report.at("dma_commands"), "DMA command"),
      report.at("dma_bytes").get<double>() / 1e6, base::counted(count_in(report, "findings"), "finding"));
  if (const std::size_t faults = count_in(report, "faults"); faults != 0)
    text += ", " + base::counted(faults, "fault");
  return text;
}

int ProgramRun::exit_status() const {
  if (end.status != 0) return end.status;
  return has_findings() ? kExitFindings : 0;
}

}  // namespace softcell::tool
