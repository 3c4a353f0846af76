#include "machine.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>

#include "object.h"
#include "registers.h"
#include "softcell/base/json_text.h"
#include "softcell/base/whole_file.h"

namespace softcell::libspe2 {
namespace {

constexpr std::chrono::seconds kEndOfRuns{2};

ls_sim::SpeOptions options_of(const Settings& settings, ls_sim::Findings& findings, ls_sim::Trace* trace) {
  ls_sim::SpeOptions options;
  options.spes = kMostContexts;
  options.schedule = settings.schedule;
  options.deadline = settings.deadline;
  if (settings.turns) options.interleaving = ls_sim::Interleaving::kTurns;
  if (settings.checked) options.findings = &findings;
  options.trace = trace;
  options.status_says_failure = false;  // a program's statuses and stops mean what it likes
  return options;
}

void append(base::JsonText& json, const std::vector<ls_sim::Finding>& findings) {
  json.raw("[");
  for (const ls_sim::Finding& finding : findings) {
    if (&finding != &findings.front()) json.raw(",");
    json.raw("\n  {\"rule\":").string(name(finding.fault.rule));
    json.raw(",\"kernel\":").string(finding.fault.kernel);
    json.raw(",\"place\":").string(finding.fault.place);
    json.raw(",\"count\":").number(static_cast<std::int64_t>(finding.count));
    json.raw(",\"message\":").string(finding.fault.message()).raw("}");
  }
  json.raw("]");
}

std::atomic<Machine*> machine_of_process{nullptr};

/// At exit(), a process's libraries come last, behind all exit handlers and destructors of the program, which may still
/// need its SPEs.
[[gnu::destructor]] void end_library() { Machine::at_exit(); }

[[noreturn]] void wait_for_the_end() {
  for (;;) pause();
}

}  // namespace

Machine& Machine::get() {
  static Machine* const machine = [] {
    try {
      auto* made = new Machine;
      std::at_quick_exit(&Machine::at_exit);
      map_registers();
      machine_of_process = made;
      return made;
    } catch (const std::exception& error) {
      complain(error.what());
      _exit(2);
    }
  }();
  return *machine;
}

Machine::Machine()
    : settings_(settings_from_environment()),
      process_(getpid()),
      memory_(dma::HostProgram{.spes = kMostContexts}),
      trace_(settings_.trace_file.empty() ? nullptr : std::make_unique<ls_sim::Trace>(kMostContexts)),
      contexts_(
          std::make_unique<ls_sim::SpeContexts>(memory_, options_of(settings_, findings_, trace_.get()))) {
  memory_.set_allocations(interposed_allocations());
}

void Machine::complain(std::string_view what) {
  std::fprintf(stderr, "softcell: %.*s\n", static_cast<int>(what.size()), what.data());
}

void Machine::report(const dma::Fault& fault) {
  complain(fault.message());
  dma::Fault counted = fault;
  if (counted.kernel.empty()) counted.kernel = "PPU side";  // a proxy command
  faults_.add(counted);
}

void Machine::count_last(ls_sim::SpeContext& context) {
  if (!context.state().runs) context.end_run();
  const ls_sim::SpeStatistics statistics = context.statistics();
  commands_.fetch_add(statistics.dma.commands(), std::memory_order_relaxed);
  bytes_.fetch_add(statistics.dma.bytes(), std::memory_order_relaxed);
}

void Machine::count_context() {
  if (contexts_made_.fetch_add(1, std::memory_order_relaxed) == 0) write_report_so_far();
}

void Machine::end_run() {
  const std::size_t mistakes = findings_.size() + faults_.size();
  {
    const std::lock_guard lock(report_mutex_);
    if (mistakes == reported_mistakes_) return;
    reported_mistakes_ = mistakes;
  }
  write_report_so_far();
}

void Machine::write_report_so_far() {
  if (settings_.report_file.empty() || process_ != getpid()) return;
  const std::lock_guard lock(report_mutex_);
  if (is_ending()) return;
  try {
    write_report(Report::kSoFar);
  } catch (const std::exception&) {  // is said at the end, when it cannot be written either
  }
}

void Machine::at_exit() {
  Machine* const made = machine_of_process;
  if (made == nullptr) return;
  Machine& machine = *made;
  if (machine.process_ != getpid()) return;  // a fork of the program
  pid_t first = 0;
  if (!machine.ending_thread_.compare_exchange_strong(first, gettid())) {
    if (first != gettid())
      wait_for_the_end();  // the first one's status counts, and its reports are not cut off
    return;
  }
  try {
    machine.end_runs();
    machine.count_contexts();
    machine.print_findings();
    {
      const std::lock_guard lock(machine.report_mutex_);
      machine.write_report(Report::kWhole);
    }
    machine.write_trace();  // the longest of the files, which may not fit on the disk
  } catch (const std::exception& error) {
    complain(error.what());
  }
}

void Machine::end_process(int status) {
  at_exit();
  std::fflush(nullptr);
  _exit(status);
}

void Machine::stay_if_ending() const {
  if (is_ending() && process_ == getpid()) wait_for_the_end();
}

/// A program may end while contexts run; they end with it.
void Machine::end_runs() {
  contexts_->interrupt_all();
  const auto until = std::chrono::steady_clock::now() + kEndOfRuns;
  contexts_->wait([this] { return contexts_->none_runs_in_wait(); }, until);
}

/// Counts what was done by the contexts that the program has left to its end.
void Machine::count_contexts() {
  Objects<spe_context>::all().for_each([this](spe_context& context) {
    if (context.spe == nullptr) return;
    try {
      count_last(*context.spe);
    } catch (const std::logic_error&) {  // a thread runs it again, meanwhile
    }
  });
}

void Machine::print_findings() const {
  for (const ls_sim::Finding& finding : findings_.list()) {
    const std::string times = finding.count == 1 ? "" : " (" + std::to_string(finding.count) + " times)";
    complain("finding: " + finding.fault.message() + times);
  }
}

void Machine::write_trace() const {
  if (trace_ != nullptr) trace_->write(settings_.trace_file);
}

void Machine::write_report(Report which) const {
  if (settings_.report_file.empty()) return;
  base::JsonText json;
  json.raw("{\"contexts\":").number(static_cast<std::int64_t>(contexts_made_.load()));
  json.raw(",\"runs\":").number(static_cast<std::int64_t>(runs_.load()));
  json.raw(",\"dma_commands\":").number(static_cast<std::int64_t>(commands_.load()));
  json.raw(",\"dma_bytes\":").number(static_cast<std::int64_t>(bytes_.load()));
  json.raw(",\"dma\":").string(to_string(settings_.schedule));
  json.raw(",\"checked\":").boolean(settings_.checked);
  json.raw(",\"whole\":").boolean(which == Report::kWhole);
  json.raw(",\"findings\":");
  append(json, findings_.list());
  json.raw(",\"faults\":");
  append(json, faults_.list());
  json.raw("}\n");
  base::WholeFile file(settings_.report_file);
  file.write(json.text());
  file.commit();
}

}  // namespace softcell::libspe2
