// softcell spu run with programs that a compiler for the SPU has made.

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"

namespace softcell::tests {
namespace {

std::string program(const std::string& name) {
  return std::string(SOFTCELL_SPU_PROGRAMS "/") + name + ".O2.elf";
}

/// Floats as the SPU reads them.
std::string big_endian(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(bits >> shift);
  return bytes;
}

TEST(SpuPrograms, RunOnFilesAndArguments) {
  constexpr int kFloats = 5024;
  const ScratchFolder folder;
  std::string input, expected;
  for (int i = 0; i < kFloats; ++i) {
    input += big_endian(static_cast<float>(i));
    expected += big_endian(0.5f * static_cast<float>(i) + 3.0f);
  }
  std::ofstream(folder / "in.bin", std::ios::binary) << input;
  // The parameters: two addresses, the count and the first factor in one word, the summand in the next; 128 bytes.
  const CommandResult run = run_softcell(
      "spu run --engine interpreter " + program("scale_stream") + " --in in=" + (folder / "in.bin") +
      " --out out=" + (folder / "out.bin") + ":" + std::to_string(4 * kFloats) + " --json " +
      (folder / "s.json") + " --arg @in @out 0x000013A03F000000 0x4040000000000000 0 0 0 0 0 0 0 0 0 0 0 0");
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("SPE 0 executed 17905 instructions"), std::string::npos) << run.output;
  EXPECT_EQ(test::text_of(folder / "out.bin"), expected);
  std::ifstream file(folder / "s.json");
  const auto json = nlohmann::json::parse(file);
  EXPECT_EQ(json["kernel"], "scale_stream.O2");
  EXPECT_EQ(json["spes"][0]["instructions"], 17905);
  EXPECT_EQ(json["dma_schedule"], "eager");
}

nlohmann::json parsed_file(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

TEST(SpuPrograms, AreTimed) {
  const ScratchFolder folder;
  const auto run_timed = [&](const std::string& more) {
    const CommandResult run = run_softcell("spu run " + program("selfcheck") + " --timing --spes 2 --json " +
                                           (folder / "t.json") + more);
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("branch miss"), std::string::npos) << run.output;
    EXPECT_NE(run.output.find("ackermann"), std::string::npos) << run.output;
    return parsed_file(folder / "t.json")["timing"];
  };
  const nlohmann::json timing = run_timed("");
  EXPECT_EQ(timing["cycles_per_second"], 3'200'000'000);
  ASSERT_EQ(timing["spes"].size(), 2u);
  const nlohmann::json& spe = timing["spes"][0];
  EXPECT_EQ(spe["instructions"], 27474);
  std::uint64_t sum = spe["instructions"].get<std::uint64_t>() - spe["pairs"].get<std::uint64_t>();
  for (const auto& [cause, cycles] : spe["stalls"].items()) sum += cycles.get<std::uint64_t>();
  EXPECT_EQ(spe["cycles"], sum);
  std::uint64_t of_functions = 0;
  for (const auto& function : spe["functions"]) of_functions += function["cycles"].get<std::uint64_t>();
  EXPECT_EQ(spe["cycles"], of_functions);
  EXPECT_EQ(run_timed(" --checked --dma random:7"), timing) << "checks and schedules take no time";
  EXPECT_EQ(run_softcell("spu run " + program("selfcheck") + " --timing --clock host").status, 2);
}

/// Jobs, waits and transfers as long as the model says, on its clock.
TEST(SpuPrograms, HaveATraceOnSimulatedTime) {
  const ScratchFolder folder;
  std::ofstream(folder / "in.bin", std::ios::binary) << std::string(4 * 5024, '\0');
  const std::string run =
      "spu run --timing " + program("scale_stream") + " --in in=" + (folder / "in.bin") +
      " --out out=" + (folder / "out.bin") + ":20096 --json " + (folder / "t.json") +
      " --arg @in @out 0x000013A03F000000 0x4040000000000000 0 0 0 0 0 0 0 0 0 0 0 0 --trace ";
  ASSERT_EQ(run_softcell(run + (folder / "a.json")).status, 0);
  ASSERT_EQ(run_softcell(run + (folder / "b.json")).status, 0);
  EXPECT_EQ(test::text_of(folder / "a.json"), test::text_of(folder / "b.json"));
  const nlohmann::json trace = parsed_file(folder / "a.json");
  const nlohmann::json spe = parsed_file(folder / "t.json")["timing"]["spes"][0];
  EXPECT_EQ(trace["softcell"]["time"], "microseconds of the simulated clocks of the SPEs");
  constexpr double kCyclesPerMicrosecond = 3200;
  double waited = 0, in_flight = 0;
  for (const auto& event : trace["traceEvents"]) {
    const std::string category = event.value("cat", "");
    const auto cycles = [&] { return event["dur"].get<double>() * kCyclesPerMicrosecond; };
    if (category == "job") {
      EXPECT_NEAR(cycles(), spe["cycles"].get<double>(), 8);
    }
    if (category == "wait") waited += cycles();
    if (category == "dma") in_flight += cycles();
  }
  EXPECT_NEAR(waited, spe["stalls"]["tag_wait"].get<double>(), 30);
  EXPECT_NEAR(in_flight, spe["dma"]["latency_cycles"].get<double>(), 60);
  const CommandResult report =
      run_softcell("report " + (folder / "a.json") + " --out " + (folder / "a.html"));
  EXPECT_EQ(report.status, 0) << report.output;
}

/// Lines and branches of scale_stream.cpp: its inner loop runs once for each vector of four.
TEST(SpuPrograms, AreCoveredLineByLine) {
  const ScratchFolder folder;
  std::ofstream(folder / "in.bin", std::ios::binary) << std::string(4 * 5024, '\0');
  const std::string run =
      " --in in=" + (folder / "in.bin") + " --out out=" + (folder / "out.bin") +
      ":20096 --arg @in @out 0x000013A03F000000 0x4040000000000000 0 0 0 0 0 0 0 0 0 0 0 0 "
      "--coverage " +
      (folder / "c.info");
  const CommandResult covered =
      run_softcell("spu run " SOFTCELL_SPU_PROGRAMS "/scale_stream.debug.elf" + run);
  ASSERT_EQ(covered.status, 0) << covered.output;
  const std::string text = test::text_of(folder / "c.info");
  EXPECT_EQ(text.substr(0, 7), "TN:\nSF:") << text;
  EXPECT_NE(text.find("scale_stream.cpp\n"), std::string::npos) << text;
  EXPECT_NE(text.find("FNDA:1,main\n"), std::string::npos) << text;
  EXPECT_NE(text.find(",1256\n"), std::string::npos) << "5024 floats in vectors of four\n" << text;
  EXPECT_NE(text.find("BRDA:"), std::string::npos) << text;
  EXPECT_EQ(text.substr(text.size() - 14), "end_of_record\n");
  const CommandResult without = run_softcell("spu run " + program("scale_stream") + run);
  EXPECT_EQ(without.status, 1);
  EXPECT_NE(without.output.find("has no debug information"), std::string::npos) << without.output;
  EXPECT_EQ(run_softcell("spu run --timing --coverage x " + program("selfcheck")).status, 2);
}

/// What lcov's records say of a source file: "DA:41" -> "3", "FNDA" of the first letters of a name, since Clang has main's
/// arguments in it, and all branches.
struct Covered {
  std::map<int, long> lines;
  std::map<std::string, long> functions;
  int branches = 0, ways_taken = 0, never_reached = 0;
};

Covered covered_in(const std::string& text, const std::string& file) {
  Covered covered;
  std::istringstream records(text);
  bool is_here = false;
  for (std::string record; std::getline(records, record);) {
    if (record.starts_with("SF:")) is_here = record.ends_with("/" + file);
    if (!is_here) continue;
    const std::size_t comma = record.find(','), last = record.rfind(',');
    if (record.starts_with("DA:"))
      covered.lines[std::stoi(record.substr(3))] = std::stol(record.substr(comma + 1));
    if (record.starts_with("FNDA:"))
      covered.functions[record.substr(comma + 1, 4)] = std::stol(record.substr(5));
    if (!record.starts_with("BRDA:")) continue;
    const std::string count = record.substr(last + 1);
    ++covered.branches;
    if (count == "-") ++covered.never_reached;
    if (count != "-" && count != "0") ++covered.ways_taken;
  }
  return covered;
}

/// The number of the line of a file that has the text.
int line_with(const std::string& file, const std::string& text) {
  std::ifstream source(file);
  int number = 0;
  for (std::string line; std::getline(source, line);) {
    ++number;
    if (line.find(text) != std::string::npos) return number;
  }
  ADD_FAILURE() << file << " has no " << text;
  return 0;
}

/// A kernel for the host is stepped through.
TEST(SpuPrograms, AreCoveredWhenTheyAreBuiltForTheHost) {
  const ScratchFolder folder;
  const auto run = [&](int floats) {
    for (const char* const name : {"x.bin", "y.bin"})
      std::ofstream(folder / name, std::ios::binary) << std::string(3 * 4 * 2048, '\0');
    const CommandResult result =
        run_softcell(std::string("spu run ") + SOFTCELL_SAXPY + " --in x=" + (folder / "x.bin") +
                     " --inout y=" + (folder / "y.bin") + " --arg f32:2 @x @y " + std::to_string(floats) +
                     " 1 0 --coverage " + (folder / "h.info"));
    EXPECT_EQ(result.status, 0) << result.output;
    return covered_in(test::text_of(folder / "h.info"), "saxpy.cpp");
  };
  const int sum = line_with(SOFTCELL_SAXPY_SOURCE, "spu_madd("),
            put = line_with(SOFTCELL_SAXPY_SOURCE, "mfc_put(");
  const Covered three_blocks = run(3 * 2048), one = run(2048), none = run(0);
  EXPECT_EQ(three_blocks.functions.at("main"), 1);
  EXPECT_GE(three_blocks.lines.at(sum), 3 * 2048 / 4 / 8) << "however far the loop is unrolled";
  EXPECT_EQ(three_blocks.lines.at(sum), 3 * one.lines.at(sum));
  EXPECT_GE(one.lines.at(put), 1);
  EXPECT_GT(three_blocks.lines.at(put), one.lines.at(put));
  EXPECT_EQ(none.lines.at(put), 0);
  EXPECT_EQ(none.lines.at(sum), 0);
  EXPECT_EQ(three_blocks.branches, one.branches);
  EXPECT_EQ(none.branches, one.branches) << "those that were never reached, too";
  EXPECT_GT(three_blocks.ways_taken, one.ways_taken);
  EXPECT_GT(one.ways_taken, none.ways_taken);
  EXPECT_GT(none.never_reached, one.never_reached);
}

TEST(SpuPrograms, HaveASchedule) {
  const ScratchFolder folder;
  const CommandResult fixed = run_softcell("spu timing --static --function main " + program("mailbox_echo"));
  ASSERT_EQ(fixed.status, 0) << fixed.output;
  EXPECT_NE(fixed.output.find("\nmain:\n"), std::string::npos) << fixed.output;
  EXPECT_EQ(fixed.output.find("_start"), std::string::npos) << fixed.output;
  EXPECT_EQ(fixed.output.find("executed"), std::string::npos) << fixed.output;
  const CommandResult run =
      run_softcell("spu timing " + program("mailbox_echo") + " --in-mbox 7 0 --json " + (folder / "t.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("executed"), std::string::npos) << run.output;
  const nlohmann::json document = parsed_file(folder / "t.json");
  std::uint64_t executed = 0, cycles = 0;
  for (const auto& function : document["functions"]) {
    for (const auto& line : function["instructions"]) {
      executed += line["run"]["instructions"].get<std::uint64_t>();
      cycles += line["run"]["cycles"].get<std::uint64_t>();
    }
  }
  EXPECT_GT(executed, 20u);
  EXPECT_EQ(document["timing"]["spes"][0]["instructions"], executed);
  EXPECT_EQ(document["timing"]["spes"][0]["cycles"], cycles);
}

TEST(SpuPrograms, AreDisassembled) {
  const ScratchFolder folder;
  const CommandResult run =
      run_softcell("spu disasm --schedule " + program("atomic_count") + " --json " + (folder / "d.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("0x00080  40800002       0 0   il        $2,0\n"), std::string::npos)
      << run.output;
  EXPECT_NE(run.output.find("brsl      $0,0x80   # main"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("hbrr      0xd8,0xe0   # for 0xD8, br 0xe0"), std::string::npos) << run.output;
  const nlohmann::json document = parsed_file(folder / "d.json");
  EXPECT_EQ(document["functions"][0]["function"], "main");
  EXPECT_EQ(document["functions"][0]["instructions"][0]["mnemonic"], "il");
  EXPECT_EQ(run_softcell("spu disasm " + program("atomic_count") + " --function main").output.find(" 0D "),
            std::string::npos);
}

TEST(SpuPrograms, AreNotKernelsOfTheHost) {
  for (const char* verb : {"timing", "disasm"}) {
    const CommandResult host = run_softcell(std::string("spu ") + verb + " " + SOFTCELL_SAXPY);
    EXPECT_EQ(host.status, 1);
    EXPECT_NE(host.output.find("this image is built for the host"), std::string::npos) << host.output;
    const CommandResult name =
        run_softcell(std::string("spu ") + verb + " --function mian " + program("selfcheck"));
    EXPECT_EQ(name.status, 1);
    EXPECT_NE(name.output.find("has no function of that name; did you mean main?"), std::string::npos)
        << name.output;
  }
}

/// Without instructions, the model still has the transfers: two buffers hide what one waits for.
TEST(SpuPrograms, OfTheHostAreTimedByTheirTransfers) {
  const ScratchFolder folder;
  std::ofstream(folder / "in.bin", std::ios::binary) << std::string(64 * 4096, 'x');
  const auto waits = [&](int buffers) {
    const CommandResult run =
        run_softcell(std::string("spu run --timing ") + SOFTCELL_BLOCKS + " --in in=" + (folder / "in.bin") +
                     " --arg @in 64 " + std::to_string(buffers) + " 0 --json " + (folder / "t.json"));
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("The cycles are those of waits for transfers: "), std::string::npos)
        << run.output;
    return parsed_file(folder / "t.json")["timing"]["spes"][0]["stalls"]["tag_wait"].get<std::uint64_t>();
  };
  const std::uint64_t one = waits(1);
  EXPECT_GT(one, 64u * 500);
  EXPECT_LT(waits(2), one * 3 / 4);
}

TEST(SpuPrograms, RunOnSixSpesUnderEverySchedule) {
  for (const char* schedule : {"eager", "lazy", "random:5"}) {
    const CommandResult run =
        run_softcell("spu run " + program("selfcheck") + " --checked --spes 6 --dma " + schedule);
    EXPECT_EQ(run.status, 0) << run.output;
  }
}

TEST(SpuPrograms, LeaveMail) {
  const CommandResult run = run_softcell("spu run " + program("mailbox_echo") + " --in-mbox 1 0");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("left 0x7FFFFFFF in its outbound mailbox"), std::string::npos) << run.output;
}

TEST(SpuPrograms, FailWithTheirLastInstructions) {
  // Without parameters: the get goes to address 0.
  const CommandResult run = run_softcell("spu run " + program("scale_stream"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("ea-not-mapped"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("the last instructions of SPE 0:"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("wrch $ch21,"), std::string::npos) << run.output;
}

TEST(SpuPrograms, NeedTheInterpreter) {
  const CommandResult native = run_softcell("spu run --engine native " + program("selfcheck"));
  EXPECT_EQ(native.status, 1);
  EXPECT_NE(native.output.find("this is a program built for the SPU"), std::string::npos) << native.output;
  const CommandResult host = run_softcell(std::string("spu run --engine interpreter ") + SOFTCELL_SAXPY);
  EXPECT_EQ(host.status, 1);
  EXPECT_NE(host.output.find("this image is built for the host"), std::string::npos) << host.output;
  EXPECT_EQ(run_softcell("spu run --engine fast " + program("selfcheck")).status, 2);
}

TEST(SpuPrograms, OfThreadGroupsHaveFourArguments) {
  EXPECT_EQ(run_softcell("spu run --entry thread-group " + program("selfcheck") + " --arg 1 2 3 4").status,
            0);
  EXPECT_EQ(run_softcell("spu run --entry thread-group " + program("selfcheck") + " --arg 1 2 3 4 5").status,
            2);
}

TEST(SpuPrograms, OpenFilesInFoldersThatExist) {
  const CommandResult run = run_softcell("spu run --host-calls --folder not/there " + program("selfcheck"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("--folder not/there: there is no such folder"), std::string::npos) << run.output;
  EXPECT_EQ(run_softcell("spu run --host-calls " + program("selfcheck")).status, 0);
}

}  // namespace
}  // namespace softcell::tests
