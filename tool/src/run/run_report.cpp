#include "run_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <sstream>
#include <utility>

#include "softcell/base/text.h"
#include "verb/exit_status.h"

namespace softcell::tool {
namespace {

std::size_t count_in(const nlohmann::json& report, const char* list) { return report.at(list).size(); }

/// The rules that were broken and where, without addresses, which differ from run to run, and sorted, because processes have no order.
std::set<std::string> mistakes(const nlohmann::json& report) {
  std::set<std::string> all;
  if (report.is_null()) return all;
  for (const char* list : {"findings", "faults"}) {
    for (const auto& finding : report.at(list)) {
      all.insert(fmt::format("{} in {} {}", finding.at("rule").get<std::string>(),
                             finding.at("kernel").get<std::string>(),
                             finding.at("place").get<std::string>()));
    }
  }
  return all;
}

/// Adds the report of another process to the report of one.
void add(nlohmann::json& report, const nlohmann::json& other) {
  for (const char* count : {"contexts", "runs", "dma_commands", "dma_bytes"})
    report.at(count) = report.at(count).get<std::int64_t>() + other.at(count).get<std::int64_t>();
  for (const char* list : {"findings", "faults"}) {
    for (const auto& finding : other.at(list)) report.at(list).push_back(finding);
  }
  report.at("whole") = report.at("whole").get<bool>() && other.at("whole").get<bool>();
}

/// The first line in which two texts differ, and its number, counted from 1.
struct OutputLine {
  std::size_t number;
  std::string first, other;
};
OutputLine first_difference(const std::string& first, const std::string& other) {
  std::istringstream a(first), b(other);
  OutputLine line{0, {}, {}};
  do {
    ++line.number;
    line.first.clear();
    line.other.clear();
    std::getline(a, line.first);
    std::getline(b, line.other);
  } while (line.first == line.other && (a || b));
  return line;
}

std::string how_it_ended(const ChildEnd& end) {
  if (end.signal != 0) return fmt::format("was ended by signal {}", end.signal);
  return fmt::format("ended with status {}", end.status);
}

}  // namespace

ProgramRun program_run(const ChildEnd& end, std::string output, const std::vector<std::string>& reports) {
  ProgramRun run{end, std::move(output), {}, nullptr, reports.size(), {}};
  for (const std::string& text : reports) {
    nlohmann::json report = nlohmann::json::parse(text);
    if (!report.at("whole").get<bool>()) {
      for (const auto& finding : report.at("findings")) run.unsaid_findings.push_back(finding.at("message"));
    }
    if (run.report.is_null()) {
      run.report = std::move(report);
    } else {
      add(run.report, report);
    }
  }
  return run;
}

bool ProgramRun::has_findings() const {
  return !report.is_null() && count_in(report, "findings") + count_in(report, "faults") != 0;
}

std::string ProgramRun::ending() const { return how_it_ended(end); }

std::optional<std::string> ProgramRun::difference(const ProgramRun& other) const {
  if (other.end.status != end.status || other.end.signal != end.signal)
    return fmt::format("it {}, and not: {}", other.ending(), ending());
  if (other.output != output) {
    const OutputLine line = first_difference(output, other.output);
    return fmt::format("line {} of its output is '{}', and not '{}'", line.number, line.other, line.first);
  }
  const std::set<std::string> ours = mistakes(report), theirs = mistakes(other.report);
  if (ours == theirs) return std::nullopt;
  return fmt::format("it broke {}, and not {}",
                     theirs.empty() ? "no rule" : fmt::format("{}", fmt::join(theirs, ", ")),
                     ours.empty() ? "any" : fmt::format("{}", fmt::join(ours, ", ")));
}

std::string ProgramRun::summary() const {
  constexpr int kNotStarted = 127;  // the exit status of the loader and of shells for this
  if (report.is_null() && end.status == kNotStarted)
    return "the program or one of its libraries was not found, as its last line says";
  if (report.is_null()) return "no SPE context was made with softcell's libspe2";
  std::string text = fmt::format(
      "{}, {}, {} ({:.1f} MB), {}", base::counted(report.at("contexts"), "SPE context"),
      base::counted(report.at("runs"), "run"), base::counted(report.at("dma_commands"), "DMA command"),
      report.at("dma_bytes").get<double>() / 1e6, base::counted(count_in(report, "findings"), "finding"));
  if (const std::size_t faults = count_in(report, "faults"); faults != 0)
    text += ", " + base::counted(faults, "fault");
  if (!report.at("whole").get<bool>())
    text += "; it ended by _exit() or a signal, so the counts are those of before its last runs";
  return text;
}

int ProgramRun::exit_status() const {
  if (end.status != 0) return end.status;
  return has_findings() ? kExitFindings : 0;
}

}  // namespace softcell::tool
