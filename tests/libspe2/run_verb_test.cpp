// softcell run, and the environment variables that it sets.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "softcell/base/sanitizers.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"

namespace softcell::tests {
namespace {

const std::string kPingPong = LIBSPE2_PROGRAMS "/libspe2_mailbox_ping_pong";
const std::string kForgets = LIBSPE2_PROGRAMS "/libspe2_forgets_to_wait";
const std::string kOverruns = LIBSPE2_PROGRAMS "/libspe2_overruns_a_block";

bool has(const CommandResult& result, const std::string& text) {
  return result.output.find(text) != std::string::npos;
}

TEST(RunVerb, RunsAProgramAndSaysWhatItDid) {
  const CommandResult run = run_softcell("run -- " + kPingPong);
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "ok\n")) << run.output;
  EXPECT_TRUE(has(run, "ended with status 0; 4 SPE contexts, 4 runs, 0 DMA commands (0.0 MB), 0 findings"))
      << run.output;
}

TEST(RunVerb, CountsWhatContextsHaveMovedThatTheProgramHasNotDestroyed) {
  const ScratchFolder folder;
  for (const std::string way : {" 0", " 0 keeps"}) {
    const CommandResult run = run_softcell("run --json " + (folder / "r.json") + " -- " + kForgets + way);
    EXPECT_EQ(run.status, 0) << run.output;
    std::ifstream file(folder / "r.json");
    const auto json = nlohmann::json::parse(file);
    EXPECT_EQ(json["report"]["dma_commands"], 1) << way << ": " << run.output;
    EXPECT_EQ(json["report"]["dma_bytes"], 64) << way;
  }
}

TEST(RunVerb, CountsOnlyRunsThatHaveBegun) {
  const CommandResult run = run_softcell("run -- " + kForgets + " 0 wrong_entry");
  EXPECT_TRUE(has(run, "status 0; 1 SPE context, 1 run, ")) << run.output;
}

TEST(RunVerb, LosesNoFindingOfARunThatAnExceptionLeaves) {
  const CommandResult run = run_softcell("run --checked -- " LIBSPE2_PROGRAMS "/libspe2_throws_in_a_call");
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_TRUE(has(run, "load-in-flight")) << run.output;
}

TEST(RunVerb, EndsAsTheProgramDoes) {
  EXPECT_EQ(run_softcell("run -- " + kForgets + " 17").status, 17);
  EXPECT_EQ(run_softcell("run -- sh -c 'kill -9 $$'").status, 137);
  EXPECT_EQ(run_softcell("run -- sh -c 'kill -s XFSZ $$'").status, 128 + SIGXFSZ)
      << "a signal that softcell ignores and the program does not";
  const CommandResult other = run_softcell("run -- true");
  EXPECT_EQ(other.status, 0);
  EXPECT_TRUE(has(other, "no SPE context was made")) << other.output;
  const ScratchFolder folder;
  const CommandResult untraced = run_softcell("run --trace " + (folder / "t.json") + " -- true");
  EXPECT_EQ(untraced.status, 1);
  EXPECT_TRUE(has(untraced, "is not written: a trace shows SPE contexts")) << untraced.output;
  EXPECT_FALSE(std::filesystem::exists(folder / "t.json"));
  const CommandResult none = run_softcell("run -- ./no_such_program");
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(has(none, "softcell: cannot run ./no_such_program: there is no such file")) << none.output;
  const CommandResult unknown = run_softcell("run -- no_such_program");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_TRUE(has(unknown, "softcell: cannot run no_such_program: no folder of PATH has it"))
      << unknown.output;
}

TEST(RunVerb, RunsAlthoughTMPDIRNamesNoFolder) {
  EXPECT_EQ(run_shell("TMPDIR=/there/is/none " SOFTCELL_COMMAND " run -- true").status, 0);
}

TEST(RunVerb, NamesTheLibraryThatIsNotInstalled) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "bin");
  const std::string copy = folder / "bin/softcell";
  std::filesystem::copy_file(SOFTCELL_COMMAND, copy);
  for (const std::string name : {"allocations", "low_memory"}) {
    const std::string option = name == "allocations" ? "--allocations" : "--low-memory";
    const CommandResult run = run_shell(copy + " run " + option + " -- true");
    EXPECT_EQ(run.status, 1) << run.output;
    EXPECT_TRUE(has(run, option + ": there is no library " + (folder / "lib/softcell/libsoftcell_") + name +
                             ".so; it comes with softcell's libraries, on Debian in the package "
                             "libsoftcell-dev\n"))
        << run.output;
  }
}

TEST(RunVerb, FindsAForgottenWaitOfACheckedProgram) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell("run --checked --json " + (folder / "r.json") + " -- " + kForgets);
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_TRUE(has(run, "finding: SPE 0, kernel breaks_rules, breaks_rules.cpp:")) << run.output;
  EXPECT_TRUE(has(run, "load-in-flight")) << run.output;
  std::ifstream file(folder / "r.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json.at("status"), 0);
  EXPECT_EQ(json.at("report").at("findings").at(0).at("rule"), "load-in-flight");
}

TEST(RunVerb, LosesNoFindingOfAProgramThatEndsWithoutItsExitHandlers) {
  const CommandResult exits = run_softcell("run --checked -- " + kForgets + " 0 _exit");
  EXPECT_EQ(exits.status, 3) << exits.output;
  EXPECT_TRUE(has(exits, "finding: SPE 0, kernel breaks_rules, breaks_rules.cpp:")) << exits.output;
  EXPECT_TRUE(has(exits, "1 SPE context, ")) << exits.output;
  EXPECT_TRUE(has(
      exits, "2 findings; it ended by _exit() or a signal, so the counts are those of before its last runs"))
      << exits.output;
  const CommandResult quickly = run_softcell("run --checked -- " + kForgets + " 0 quick_exit");
  EXPECT_EQ(quickly.status, 3) << quickly.output;
  EXPECT_TRUE(has(quickly, "2 findings\n")) << quickly.output;
  const CommandResult aborts = run_softcell("run --checked -- " + kForgets + " 0 abort");
  EXPECT_EQ(aborts.status, 134) << aborts.output;
  EXPECT_TRUE(has(aborts, "2 findings;")) << aborts.output;
}

TEST(RunVerb, AddsUpTheProcessesOfAProgram) {
  const CommandResult run = run_softcell("run --checked -- sh -c '" + kForgets + "; " + kPingPong + "; " +
                                         kForgets + " 0 _exit; true'");
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_TRUE(has(run, "6 SPE contexts, ")) << run.output;
  EXPECT_TRUE(has(run, ", 4 findings; it ended by")) << run.output;
}

TEST(RunVerb, SeedsTellWhatDependsOnTheOrder) {
  const CommandResult run = run_softcell("run --seeds 30 --quiet -- " + kForgets);
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_TRUE(has(
      run,
      "the outcome depends on the order of transfers or SPEs; see it again with softcell run --dma random:"))
      << run.output;
  EXPECT_TRUE(has(run, ", beside seed 1: line 1 of its output is '")) << run.output;
  const std::string allocations = SC_ADDRESS_SANITIZER ? "" : " --allocations";
  const CommandResult otherwise =
      run_softcell("run --seeds 30 --deadline 25 --checked" + allocations + " -- " + kForgets);
  EXPECT_TRUE(has(otherwise, " --turns --checked" + allocations + " --deadline 25 -- " + kForgets + "\n"))
      << otherwise.output;
  const CommandResult good = run_softcell("run --seeds 5 -- " + kPingPong);
  EXPECT_EQ(good.status, 0) << good.output;
  EXPECT_TRUE(has(good, "softcell: 5 seeds: ")) << good.output;
  EXPECT_TRUE(has(good, "with the same output")) << good.output;
}

TEST(RunVerb, IsQuietAboutWhatIsRight) {
  for (const std::string seeds : {"", "--seeds 2 "}) {
    const CommandResult good = run_softcell("run --quiet " + seeds + "-- " + kPingPong);
    EXPECT_EQ(good.status, 0) << good.output;
    EXPECT_FALSE(has(good, "softcell: ")) << good.output;
    EXPECT_TRUE(has(good, "ok\n")) << "the program's own output: " << good.output;
    const CommandResult bad = run_softcell("run --quiet --checked " + seeds + "-- " + kForgets);
    EXPECT_NE(bad.status, 0) << bad.output;
    EXPECT_TRUE(has(bad, "softcell: ")) << bad.output;
  }
}

TEST(RunVerb, TakesADeadlineInSeconds) {
  const std::string never = LIBSPE2_PROGRAMS "/libspe2_never_ends";
  const CommandResult run = run_softcell("run --deadline 0.3 -- " + never);
  EXPECT_TRUE(has(run, "deadline-exceeded")) << run.output;
  for (const char* wrong : {"soon", "0", "-1", "1e9"}) {
    const CommandResult refused = run_softcell(std::string("run --deadline=") + wrong + " -- " + never);
    EXPECT_EQ(refused.status, 2) << refused.output;
    EXPECT_TRUE(has(refused, "give seconds from 0.001 to 86400")) << refused.output;
  }
}

TEST(RunVerb, SeedsHaveTheSameInput) {
  const ScratchFolder folder;
  const std::string file = folder / "input";
  std::ofstream(file) << "7\n8\n";
  std::ofstream(folder / "program") << "read word\n" << kPingPong << "\necho got $word\n";
  std::ofstream(folder / "reads_all") << "cat\n" << kPingPong << "\n";
  const std::string one = std::string(SOFTCELL_COMMAND) + " run --seeds 3 -- sh " + (folder / "program");
  const std::string all = std::string(SOFTCELL_COMMAND) + " run --seeds 3 -- sh " + (folder / "reads_all");
  for (const std::string& line :
       {one + " < " + file, "cat " + file + " | " + one, "cat " + file + " | " + all, "yes 7 | " + one,
        "(echo 7; sleep 2) | " + one, "head -c 300000 /dev/zero | " + all + " | tail -c 300"}) {
    const CommandResult run = run_shell(line);
    EXPECT_TRUE(has(run, "softcell: 3 seeds: sh ended with status 0 under each, with the same output"))
        << line << ": " << run.output;
    EXPECT_TRUE(line.find(one) == std::string::npos || has(run, "got 7\n")) << line << ": " << run.output;
  }
  for (const char* none : {" < /dev/null", " <&-"})
    EXPECT_TRUE(has(run_shell(one + none), "softcell: 3 seeds: ")) << none;
}

TEST(RunVerb, SaysOfAProgramWithoutSpesThatTheirOrderIsNotTheReason) {
  const CommandResult run = run_softcell("run --seeds 2 --quiet -- sh -c 'date +%N'");
  EXPECT_EQ(run.status, 1) << run.output;
  EXPECT_TRUE(has(run, "this is not the order of transfers or SPEs: no SPE context was made")) << run.output;
  const CommandResult seeds = run_softcell("run --seeds 30 --quiet -- sh -c '" + kForgets + " 0'");
  EXPECT_TRUE(has(seeds, " --turns -- sh -c '" + kForgets + " 0'\n")) << seeds.output;
}

TEST(RunVerb, HoldsTransfersAgainstTheBlocksOfTheHeap) {
  if (SC_ADDRESS_SANITIZER) GTEST_SKIP() << "the sanitizer finds it first, and has an allocator of its own";
  EXPECT_EQ(run_softcell("run -- " + kOverruns).status, 0) << "nobody knows of the block";
  const CommandResult run = run_softcell("run --allocations -- " + kOverruns);
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_TRUE(has(run, "ea-outside-allocation")) << run.output;
  EXPECT_TRUE(has(run, "40 of 64 bytes lie in 40 bytes at")) << run.output;
  EXPECT_TRUE(has(run, "allocated by make_block at overruns_a_block.c:")) << run.output;
  EXPECT_EQ(run_softcell("run --allocations -- " + kPingPong).status, 0);
  const CommandResult mapped =
      run_softcell("run --allocations -- " LIBSPE2_PROGRAMS "/libspe2_maps_a_freed_block");
  EXPECT_EQ(mapped.status, 0) << "the pages are the program's again: " << mapped.output;
}

TEST(RunVerb, ChildrenOfAForkAllocateWhileOtherThreadsDo) {
  if (SC_ADDRESS_SANITIZER) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  const CommandResult run =
      run_softcell("run --allocations -- " LIBSPE2_PROGRAMS "/libspe2_forks_while_it_allocates");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "ok\n")) << run.output;
}

TEST(RunVerb, RecordsATrace) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell("run --trace " + (folder / "t.json") + " -- " + kForgets);
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run_softcell("report " + (folder / "t.json") + " --out " + (folder / "t.html")).status, 0);
  std::ifstream file(folder / "t.json");
  const auto trace = nlohmann::json::parse(file);
  for (const auto& event : trace["traceEvents"]) {
    if (event.contains("cat") && event["cat"] == "job") {
      EXPECT_FALSE(event["args"]["failed"]) << "a status is the program's own";
    }
  }
}

TEST(RunVerb, WritesATraceToStandardOutput) {
  const ScratchFolder folder;
  const CommandResult run =
      run_shell("cd " + folder.path().string() + " && " SOFTCELL_COMMAND " run --trace - -- " + kForgets +
                " 2>said >t.json");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_FALSE(std::filesystem::exists(folder / "-"));
  EXPECT_EQ(run_softcell("report " + (folder / "t.json") + " --out " + (folder / "t.html")).status, 0);
}

TEST(RunVerb, GivesEachOfSeveralProcessesATraceOfItsOwn) {
  const ScratchFolder folder;
  const std::string in_folder = "cd " + folder.path().string() + " && " SOFTCELL_COMMAND " run ",
                    programs = " -- sh -c '" + kPingPong + "; " + kForgets + "; " + kPingPong + "'";
  const CommandResult run = run_shell(in_folder + "--trace t.json" + programs);
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "softcell: 3 processes have traces: 't.json', 't.2.json' to 't.3.json'\n"))
      << run.output;
  const auto images_in = [&](const std::string& name) {
    std::ifstream file(folder / name);
    std::set<std::string> images;
    const auto trace = nlohmann::json::parse(file);
    for (const auto& event : trace["traceEvents"]) {
      if (event.contains("cat") && event["cat"] == "job") images.insert(event["name"]);
    }
    return images;
  };
  EXPECT_EQ(images_in("t.json"), std::set<std::string>{"echoes"});
  EXPECT_EQ(images_in("t.2.json"), std::set<std::string>{"breaks_rules"}) << "in the order of processes";
  EXPECT_EQ(images_in("t.3.json"), std::set<std::string>{"echoes"});

  const CommandResult printed =
      run_shell(in_folder + "--trace -" + programs + " 2>said >first.json; cat said");
  EXPECT_TRUE(has(printed,
                  "softcell: standard output has the trace of the first of 3 processes; give "
                  "--trace a file, and each has its own\n"))
      << printed.output;
  EXPECT_EQ(images_in("first.json"), std::set<std::string>{"echoes"});
  const CommandResult taken = run_shell(in_folder + "--json t.2.json --trace t.json" + programs);
  EXPECT_EQ(taken.status, 2);
  EXPECT_TRUE(has(taken, "--json and the trace of process 2 are one file, t.2.json")) << taken.output;
}

TEST(RunVerb, SaysWhichOfSeveralProcessesHasNoTrace) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell("run --trace " + (folder / "t.json") + " -- sh -c '" + kPingPong +
                                         "; " + kForgets + " 0 _exit'");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "softcell: 1 of 2 processes has ended before it wrote a trace\n")) << run.output;
}

TEST(RunVerb, RefusesAFileThatItCannotWriteBeforeTheRun) {
  const ScratchFolder folder;
  for (const std::string& file : {folder / "none/t.json", folder.path().string()}) {
    for (const std::string option : {"--trace ", "--json "}) {
      const CommandResult run =
          run_softcell("run " + option + file + " -- sh -c 'touch " + (folder / "ran") + "'");
      EXPECT_EQ(run.status, 1) << option << file;
      EXPECT_EQ(run.output.rfind("softcell: cannot write " + file + ": ", 0), 0u) << run.output;
      EXPECT_FALSE(std::filesystem::exists(folder / "ran")) << option << file;
    }
  }
  const CommandResult full = run_softcell("run --trace /dev/full -- " + kForgets);
  EXPECT_EQ(full.status, 1);
  EXPECT_TRUE(has(full, "1 SPE context, 1 run, 1 DMA command")) << full.output;
  EXPECT_TRUE(has(full, "softcell: cannot write /dev/full: No space left on device")) << full.output;
}

TEST(RunVerb, ReplacesNeitherItsProgramNorAnotherOfItsFiles) {
  const ScratchFolder folder;
  const std::string program = folder / "program";
  std::filesystem::copy_file("/bin/true", program);
  const auto size = std::filesystem::file_size(program);
  for (const std::string option : {"--trace", "--json"}) {
    const CommandResult run = run_softcell("run " + option + " " + program + " -- " + program);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(has(run, "softcell: the program and " + option + " are one file, " + program)) << run.output;
    EXPECT_EQ(std::filesystem::file_size(program), size);
  }
  const std::string file = folder / "j";
  EXPECT_TRUE(has(run_softcell("run --json " + file + " --trace " + file + " -- true"),
                  "softcell: --json and --trace are one file, " + file + "; give each a file of its own"));
  EXPECT_EQ(run_softcell("run --json - --trace - -- true").status, 2);
}

/// Runs a line of shell in an empty folder, with the name of a file among the words; the line's output.
std::string said_by(const ScratchFolder& folder, const std::string& line) {
  return run_shell("cd " + folder.path().string() + "; TMPDIR=$PWD; export TMPDIR; " + line).output;
}

TEST(RunVerb, SeedsThatAreInterruptedAreNoDifference) {
  for (const std::string to : {"", "--foreground "}) {  // with it softcell alone gets the signal
    for (const std::string signal : {"INT", "TERM", "HUP"}) {
      const ScratchFolder folder;
      const std::string said =
          said_by(folder, "timeout " + to + "-s " + signal +
                              " 1 " SOFTCELL_COMMAND
                              " run --quiet --seeds 1000000 --json j -- sleep 0.01; echo $?; ls -A");
      EXPECT_TRUE(said.starts_with("softcell: interrupted; ")) << signal << ": " << said;
      EXPECT_NE(said.find(" of 1000000 seeds gave the same outcome\n"), std::string::npos) << said;
      EXPECT_EQ(said.find("depends on the order"), std::string::npos) << said;
      EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << said;
    }
  }
}

TEST(RunVerb, PassesOnWhatEndsIt) {
  const ScratchFolder folder;
  const std::string said =
      said_by(folder, "timeout --foreground -s TERM 1 " SOFTCELL_COMMAND " run --json j -- sleep 60; ls -A");
  EXPECT_EQ(said,
            "softcell: sleep was ended by signal 15; no SPE context was made with softcell's libspe2\nj\n");
}

TEST(RunVerb, RefusesWhatMakesNoSense) {
  EXPECT_EQ(run_softcell("run").status, 2);
  EXPECT_EQ(run_softcell("run --dma sometimes -- true").status, 2);
  EXPECT_EQ(run_softcell("run --seeds 3 --dma lazy -- true").status, 2);
  EXPECT_EQ(run_softcell("run --seeds 3 --dma eager -- true").status, 2);
  EXPECT_EQ(run_softcell("run --seeds 3 --trace t.json -- true").status, 2);
}

TEST(Environment, AWrongValueEndsTheProgramWithASentence) {
  for (const std::string variable :
       {"SOFTCELL_DMA=sometimes", "SOFTCELL_CHECKED=yes", "SOFTCELL_TURNS=2", "SOFTCELL_DEADLINE_MS=-1"}) {
    const CommandResult run = run_shell(variable + " " + kPingPong);
    EXPECT_EQ(run.status, 2) << run.output;
    EXPECT_TRUE(
        has(run, "softcell: the environment variable " + variable.substr(0, variable.find('=')) + " is '"))
        << run.output;
  }
}

TEST(Environment, ATraceThatCannotBeWrittenLeavesTheReportWhole) {
  const ScratchFolder folder;
  const CommandResult run =
      run_shell("SOFTCELL_TRACE=/none/t.json SOFTCELL_REPORT=" + (folder / "r.json") + " " + kForgets);
  EXPECT_TRUE(has(run, "cannot write /none/t.json: ")) << run.output;
  std::ifstream file(folder / "r.json");
  const auto report = nlohmann::json::parse(file);
  EXPECT_EQ(report["whole"], true);
  EXPECT_EQ(report["dma_commands"], 1);
}

TEST(Environment, ADeadlineEndsAProgramThatNeverEnds) {
  const CommandResult run = run_shell("SOFTCELL_DEADLINE_MS=300 " LIBSPE2_PROGRAMS "/libspe2_never_ends");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "deadline-exceeded")) << run.output;
}

TEST(Environment, AProgramMayEndWhileItsContextsRun) {
  const CommandResult run = run_shell(LIBSPE2_PROGRAMS "/libspe2_never_ends leave");
  EXPECT_EQ(run.status, 5) << run.output;
  EXPECT_FALSE(has(run, "deadline-exceeded")) << run.output;
}

TEST(Environment, RunsThatTheEndOfTheProgramEndsDoNotComeBack) {
  const std::string program = LIBSPE2_PROGRAMS "/libspe2_ends_meanwhile ";
  for (int i = 0; i < 5; ++i) {
    const CommandResult returns = run_shell(program + "return");
    EXPECT_EQ(returns.status, 0) << returns.output;
    EXPECT_EQ(returns.output, "ok\n");
  }
  for (const std::string way : {"exit", "quick"}) {
    const CommandResult exits = run_shell(program + way);
    EXPECT_EQ(exits.status, 7) << way << ": " << exits.output;
    EXPECT_EQ(exits.output, "ok\n") << way;
  }
}

TEST(Environment, ExitHandlersFindTheSpesAlive) {
  const CommandResult run = run_shell(LIBSPE2_PROGRAMS "/libspe2_ends_meanwhile handler");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.output, "ok\nasked\n");
}

TEST(RunVerb, CountsRunsThatTheEndOfTheProgramEndsAndFindsNothingInThem) {
  const ScratchFolder folder;
  const CommandResult run =
      run_softcell("run --trace " + (folder / "t.json") + " -- " LIBSPE2_PROGRAMS "/libspe2_ends_meanwhile");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run, "status 0; 7 SPE contexts, 7 runs, 0 DMA commands (0.0 MB), 0 findings"))
      << run.output;
  std::ifstream file(folder / "t.json");
  const std::string trace((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(trace.find("echoes"), std::string::npos) << "no run in the trace";
  EXPECT_EQ(trace.find("deadline-exceeded"), std::string::npos) << trace;
}

TEST(RunVerb, RemembersWhatAPluginDidThatIsUnloaded) {
  const CommandResult run =
      run_softcell("run -- " LIBSPE2_PROGRAMS "/libspe2_reloads_plugin " LIBSPE2_PLUGIN);
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_TRUE(has(run, "ok\n")) << run.output;
  EXPECT_TRUE(has(run, "status 0; 20 SPE contexts, 20 runs, ")) << run.output;
  EXPECT_TRUE(has(run, ", 0 findings, 1 fault\n")) << run.output;
}

TEST(RunVerb, KeepsAllMemoryBelow4GB) {
#if SC_ADDRESS_SANITIZER || SC_THREAD_SANITIZER
  GTEST_SKIP() << "sanitizers have their own heap and stacks";
#endif
  const std::string program = std::string(LIBSPE2_PROGRAMS) + "/libspe2_keeps_pointers_in_32_bits";
  EXPECT_EQ(run_softcell("run -- " + program).status, 1) << "a stack of a PC program lies high";
  const CommandResult low = run_softcell("run --low-memory -- " + program);
  EXPECT_EQ(low.status, 0) << low.output;
  const CommandResult moving = run_softcell("run --low-memory -- " + kPingPong);
  EXPECT_EQ(moving.status, 2);
  EXPECT_NE(moving.output.find("link the program with -no-pie: it is position-independent"),
            std::string::npos)
      << moving.output;
}

}  // namespace
}  // namespace softcell::tests
