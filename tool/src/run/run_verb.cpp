#include "run_verb.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include "child_process.h"
#include "command_line/shared_options.h"
#include "command_line/shell_words.h"
#include "kept_input.h"
#include "run_report.h"
#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"
#include "verb/deadline.h"
#include "verb/exit_status.h"
#include "verb/interrupt.h"
#include "verb/output_files.h"
#include "verb/progress_bar.h"
#include "verb/verb_files.h"

namespace softcell::tool {
namespace {

/// Default when SPEs take turns: one that reads its local store until another one has written there would keep the turn for ever.
constexpr std::chrono::seconds kDeadlineOfTurns{30};

/// The path of a library that is loaded before those of the program.
std::string library_for(const char* option, const std::string& name) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::filesystem::path file;
  for (const char* place : {SOFTCELL_ALLOCATIONS_BUILT, SOFTCELL_ALLOCATIONS_INSTALLED}) {
    file = (folder / place / name).lexically_normal();
    if (std::filesystem::exists(file)) return file.string();
  }
  throw std::runtime_error(
      fmt::format("{}: there is no library {}; it comes with softcell's libraries, on Debian in the package "
                  "libsoftcell-dev",
                  option, file.string()));
}

/// The value of LD_PRELOAD; empty: it is not changed.
std::string preloaded(const RunOptions& options) {
  std::string libraries;
  const auto add = [&](const std::string& library) { libraries += (libraries.empty() ? "" : ":") + library; };
  if (options.allocations) add(library_for("--allocations", "libsoftcell_allocations.so"));
  if (options.low_memory) add(library_for("--low-memory", "libsoftcell_low_memory.so"));
  const char* const others = std::getenv("LD_PRELOAD");
  if (!libraries.empty() && others != nullptr && *others != '\0') add(others);
  return libraries;
}

/// 0: none.
std::chrono::milliseconds deadline_of(const RunOptions& options) {
  if (!options.deadline.empty()) return parse_deadline(options.deadline);
  return options.turns ? kDeadlineOfTurns : std::chrono::seconds(0);
}

std::map<std::string, std::string> variables_of(const RunOptions& options) {
  std::map<std::string, std::string> variables{
      {"SOFTCELL_DMA", options.dma},
      {"SOFTCELL_TURNS", options.turns ? "1" : "0"},
      {"SOFTCELL_CHECKED", options.checked ? "1" : "0"},
      {"SOFTCELL_DEADLINE_MS", std::to_string(deadline_of(options).count())}};
  if (const std::string libraries = preloaded(options); !libraries.empty())
    variables["LD_PRELOAD"] = libraries;
  return variables;
}

/// The options that the outcome of a run depends on, as words of the command line.
std::string options_of_outcome(const RunOptions& options) {
  std::string words = fmt::format("--dma {}", options.dma);
  if (options.turns) words += " --turns";
  if (options.checked) words += " --checked";
  if (options.allocations) words += " --allocations";
  if (options.low_memory) words += " --low-memory";
  if (!options.deadline.empty()) words += " --deadline " + options.deadline;
  return words;
}

/// A file that an option asks for.
struct Output {
  explicit Output(const NamedFile& named) : files({named}), file(files.open(named.file)) {}

  OutputFiles files;
  base::WholeFile* file;  // null: it asks for none
};

/// @param input  of the program, whose output is collected, and whose interrupts are ours, too; null: all are those of this process.
ProgramRun run_once(const RunOptions& options, const InterruptGuard& guard, KeptInput* input = nullptr) {
  SC_ASSERT(!options.words.empty(), "a run of no program under {}", options.dma);
  const RunFolder folder;
  const std::string output = "output";
  auto variables = variables_of(options);
  variables["SOFTCELL_REPORT"] = folder.path() / "%p.json";
  // softcell writes the user's file itself, so that one that cannot be written is refused before the run.
  variables["SOFTCELL_TRACE"] = options.trace ? folder.path() / "%p.trace" : std::filesystem::path();
  const ChildEnd end = input == nullptr
                           ? run_child(options.words, variables, guard, Interrupts::kOfTheProgram)
                           : run_child(options.words, variables, guard, Interrupts::kOfTheProgramAndOurs,
                                       folder.path() / output, input->begin_run());
  ProgramRun run = program_run(end, folder.text(output), folder.texts(".json"));
  run.traces = folder.texts(".trace");
  return run;
}

nlohmann::ordered_json document(const RunOptions& options, const ProgramRun& run) {
  return {{"program", options.words},
          {"status", run.end.status},
          {"signal", run.end.signal},
          {"report", run.report}};
}

/// "t.json" of the first process with a trace, "t.2.json" of the second.
std::filesystem::path file_of_trace(const std::filesystem::path& file, std::size_t number) {
  if (number == 1) return file;
  std::filesystem::path other = file;
  other.replace_extension(fmt::format(".{}{}", number, file.extension().string()));
  return other;
}

/// Devices, pipes and standard output hold only one trace.
bool holds_all_traces(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  return file != kStandardOutput && (!exists(status) || is_regular_file(status));
}

/// Prints which process each trace is of.
void report_traces(const std::filesystem::path& file, const ProgramRun& run) {
  const std::size_t traces = run.traces.size();
  if (traces < run.processes)
    fmt::print(stderr, "softcell: {} of {} processes {} ended before {} wrote a trace\n",
               run.processes - traces, run.processes, run.processes - traces == 1 ? "has" : "have",
               run.processes - traces == 1 ? "it" : "they");
  if (traces < 2) return;
  if (!holds_all_traces(file)) {
    fmt::print(stderr,
               "softcell: {} has the trace of the first of {} processes; give --trace a file, and each has "
               "its own\n",
               shown_name(file), traces);
    return;
  }
  const auto name = [&](std::size_t number) { return file_of_trace(file, number).string(); };
  fmt::print(stderr, "softcell: {} processes have traces: '{}', '{}'{}\n", traces, name(1), name(2),
             traces == 2 ? "" : fmt::format(" to '{}'", name(traces)));
}

/// Writes the traces of all processes but the first, each into a file of its own beside that of the first.
/// @throws UsageError  one of them would replace another file of the run.
void write_other_traces(const RunOptions& options, const ProgramRun& run) {
  if (!holds_all_traces(*options.trace)) return;
  base::WholeFiles files;
  for (std::size_t number = 2; number <= run.traces.size(); ++number) {
    const auto file = file_of_trace(*options.trace, number);
    check_kept({{"--json", options.json}, {"the program", options.words.front()}},
               {{fmt::format("the trace of process {}", number), file}});
    files.open(file).write(run.traces[number - 1]);
  }
  files.commit();
}

int run_one(const RunOptions& options, const InterruptGuard& guard, Output& json, Output& trace) {
  const ProgramRun run = run_once(options, guard);
  for (const std::string& finding : run.unsaid_findings)
    fmt::print(stderr, "softcell: finding: {}\n", finding);
  if (!options.quiet || run.exit_status() != 0)
    fmt::print(stderr, "softcell: {} {}; {}\n", options.words.front(), run.ending(), run.summary());
  const bool lacks_trace = trace.file != nullptr && run.traces.empty();
  const bool has_trace = trace.file != nullptr && !lacks_trace;
  if (has_trace) {
    trace.file->write(run.traces.front());
    trace.file->finish();
  }
  if (json.file != nullptr) write_json(*json.file, document(options, run));
  json.files.commit();
  if (has_trace) {
    trace.files.commit();
    write_other_traces(options, run);
    report_traces(*options.trace, run);
  }
  const int status = run.exit_status();
  if (!lacks_trace || status != 0) return status;
  fmt::print(
      stderr, "softcell: '{}' is not written: {}\n", options.trace->string(),
      run.report.is_null() ? "a trace shows SPE contexts" : "the program has ended before it wrote a trace");
  return kExitFailed;
}

int run_many(const RunOptions& options, const InterruptGuard& guard, Output& json) {
  RunOptions seeded = options;
  seeded.turns = true;
  SC_ASSERT(options.seeds > 0, "{} runs under {} seeds", options.words.size(), options.seeds);
  const RunFolder folder;
  KeptInput input(folder.path() / "input");
  ProgramRun first;
  std::uint64_t seed = 0;
  bool differs = false;
  {
    ProgressBar bar("run", options.seeds, options.quiet);
    while (seed < options.seeds && !differs && !guard.interrupted()) {
      seeded.dma = fmt::format("random:{}", ++seed);
      ProgramRun run = run_once(seeded, guard, &input);
      if (guard.interrupted()) {  // perhaps during the run
        --seed;
        break;
      }
      if (seed == 1) {
        first = std::move(run);
      } else if (const auto difference = first.difference(run)) {
        differs = true;
        fmt::print(stderr, "softcell: {} under seed {}, beside seed 1: {}\n", options.words.front(), seed,
                   *difference);
      }
      if (first.end.signal != 0 && first.report.is_null()) break;  // somebody wants the run to end
      if (!options.quiet) bar.show(seed);
    }
  }
  if (guard.interrupted() && !differs) {
    fmt::print(stderr, "softcell: interrupted; {} of {} seeds gave the same outcome\n", seed, options.seeds);
    return kExitInterrupted;
  }
  fmt::print("{}", first.output);
  if (differs && first.report.is_null()) {
    fmt::print(stderr, "softcell: this is not the order of transfers or SPEs: {}\n", first.summary());
  } else if (differs) {
    fmt::print(stderr,
               "softcell: the outcome depends on the order of transfers or SPEs; see it again with softcell "
               "run {} -- {}\n",
               options_of_outcome(seeded), quoted_for_shell(options.words));
  } else if (!options.quiet || first.exit_status() != 0) {
    fmt::print(stderr, "softcell: {} seeds: {} {} under each, with the same output; {}\n", seed,
               options.words.front(), first.ending(), first.summary());
  }
  if (json.file != nullptr) {
    nlohmann::ordered_json all = document(options, first);
    all["seeds"] = seed;
    all["same"] = !differs;
    write_json(*json.file, all);
  }
  json.files.commit();
  return differs ? kExitFailed : first.exit_status();
}

class RunVerb final : public Verb {
 public:
  void add_to(CLI::App& command, Call& chosen) override {
    CLI::App* r = command.add_subcommand(
        "run", "Run a program that uses libspe2: softcell run --checked -- ./program its arguments");
    r->add_option("PROGRAM", options_.words, "The program and its arguments, after --")
        ->required()
        ->expected(1, -1)
        ->type_name("PROGRAM");
    add_dma_option(*r, options_.dma);
    r->add_flag("--turns", options_.turns,
                "SPEs run one at a time; whose turn it is follows from the seed of --dma random:SEED");
    r->add_flag("--checked", options_.checked,
                "Use the checked images of the SPE programs and report every mistake in their loads "
                "and stores");
    r->add_flag("--allocations", options_.allocations,
                "Report transfers outside of the allocated blocks of the program's heap");
    r->add_flag(
        "--low-memory", options_.low_memory,
        "Keep all memory of the program below 4 GB, for code that keeps pointers in 32 bits; the program "
        "must be linked with -no-pie");
    r->add_option(
         "--deadline", options_.deadline,
         "Seconds after which a run of an SPE context is stopped with a fault, 0.001 to 86400 (default: "
         "none, and 30 with --turns or --seeds)")
        ->type_name("SECONDS");
    CLI::Option* seeds = accept_whole_number(
        r->add_option("--seeds", options_.seeds,
                      "Run it under random:1 to random:SEEDS with --turns; all must have the same outcome"),
        1, kMaxSeeds);
    seeds->type_name("SEEDS");
    r->add_flag("--quiet", options_.quiet, "Print errors only, besides the program's own output");
    add_trace_option(*r, options_.trace);
    add_json_option(*r, options_.json, "how it ended, statistics, findings and faults");
    r->callback([this, r, &chosen] {
      options_.dma_is_given = r->count("--dma") != 0;
      chosen = [this] { return run_program(options_); };
    });
  }

 private:
  RunOptions options_;
};

}  // namespace

int run_program(const RunOptions& options) {
  static_cast<void>(parse_dma(options.dma));
  static_cast<void>(deadline_of(options));
  if (options.seeds != 0 && options.trace)
    throw UsageError("--trace with --seeds: trace one of the runs, with --dma random:SEED --turns");
  if (options.seeds != 0 && (options.dma_is_given || options.dma != "eager"))
    throw UsageError("--dma with --seeds: the seeds are those of --dma random:1 to random:SEEDS");
  const NamedFile json_file{"--json", options.json}, trace_file{"--trace", options.trace};
  check_distinct({json_file, trace_file});
  // A name without a slash is searched for in the folders of PATH.
  if (const std::string& program = options.words.front(); program.find('/') != std::string::npos)
    check_kept({{"the program", program}}, {json_file, trace_file});
  const InterruptGuard guard;  // before the first file is opened, so that no part of one is left
  Output json(json_file), trace(trace_file);
  return options.seeds == 0 ? run_one(options, guard, json, trace) : run_many(options, guard, json);
}

std::unique_ptr<Verb> run_verb() { return std::make_unique<RunVerb>(); }

}  // namespace softcell::tool
