// What `softcell bench` measures, prints and leaves.

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <string>
#include <vector>

#include "bench/median.h"
#include "command_support.h"
#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"

namespace softcell::tests {
namespace {

using test::files_in;

TEST(Command, ListsBenchmarksWithoutRunningThem) {
  const CommandResult run = run_softcell("bench --list --filter penguin150/w2");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.output,
            "solver3d/penguin150/w2/spe\nsolver3d/penguin150/w2/bullet-links\n"
            "solver3d/penguin150/w2/bullet-pose\nsolver3d/penguin150/w2/eigen\n"
            "solver3d/penguin150/w2/naive\nsolver3d/penguin150/w2/ppu\n");
}

TEST(Command, TheMedianOfAnEvenNumberOfRoundsIsBetweenTheTwoInTheMiddle) {
  EXPECT_EQ(tool::median_of(std::vector{3.0}), 3);
  EXPECT_EQ(tool::median_of(std::vector{3.0, 4.0}), 3.5);
  EXPECT_EQ(tool::median_of(std::vector{3.0, 4.0, 7.0}), 4);
  EXPECT_EQ(tool::median_of(std::vector{3.0, 4.0, 7.0, 8.0}), 5.5);
}

TEST(Command, MeasuresWhatItIsAskedTo) {
  const ScratchFolder folder;
  const std::string json = folder / "bench.json";
  const CommandResult run =
      run_softcell("bench --rounds 3 --filter 'penguin150/w1/(spe|eigen|bullet)' --json " + json);
  EXPECT_EQ(run.status, 0) << run.output;
  const auto document = read_json(json);
  ASSERT_EQ(document.size(), 4u);
  for (const auto& entry : document) {
    EXPECT_EQ(entry["name"].get<std::string>().rfind("solver3d/penguin150/w1/", 0), 0u) << entry;
    EXPECT_GT(entry["ns_min"].get<double>(), 0) << entry;
    EXPECT_GE(entry["ns_median"].get<double>(), entry["ns_min"].get<double>()) << entry;
    EXPECT_GE(entry["items"].get<int>(), 100) << entry;
    EXPECT_EQ(entry["item"], "a particle");
    EXPECT_NE(entry["group"].get<std::string>().find("three dimensions"), std::string::npos) << entry;
    EXPECT_EQ(entry.contains("times_peer"), entry["name"] != "solver3d/penguin150/w1/spe") << entry;
  }
  EXPECT_NE(run.output.find("dimensions, one SPE: ns for a particle\n"), std::string::npos) << run.output;
}

TEST(Command, ComparesWithAnEarlierRunAndMarksWhatGotSlower) {
  const ScratchFolder folder;
  // As if dma/get16k had taken no time to speak of, and dma/put16k a second.
  write_file(folder / "old.json",
             R"([{"name":"dma/get16k","ns_min":0.001},{"name":"dma/put16k","ns_min":1e9}])");
  const std::string bench = "bench --rounds 2 --filter dma/...?.?.?.?16k --compare ";
  const CommandResult run = run_softcell(bench + (folder / "old.json") + " --json " + (folder / "new.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  const auto matches = [&](const char* pattern) {
    return std::regex_search(run.output, std::regex(pattern));
  };
  EXPECT_TRUE(matches("dma/get16k +[0-9.]+ +[0-9.]+ +[0-9.]+ x +[0-9.]+ x  slower\n")) << run.output;
  EXPECT_TRUE(matches("dma/put16k +[0-9.]+ +[0-9.]+ +[0-9.]+ x +0.00 x\n")) << run.output;
  EXPECT_TRUE(matches("dma/memcpy16k +[0-9.]+ +[0-9.]+ +peer +new\n")) << run.output;
  EXPECT_TRUE(run.output.ends_with("\n1 of 2 benchmarks took more than 5 % longer than in the old run\n"))
      << run.output;
  for (const auto& entry : read_json(folder / "new.json"))
    EXPECT_EQ(entry.contains("times_old"), entry["name"] != "dma/memcpy16k") << entry;

  EXPECT_EQ(run_softcell(bench + (folder / "new.json") + " --json " + (folder / "new.json")).status, 2);
  for (const char* text : {"{\"name\": 3}", "{}", "[]", "[3]", "null"}) {
    write_file(folder / "old.json", text);
    const CommandResult refused = run_softcell(bench + (folder / "old.json"));
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.output.find("old.json holds no figures of `softcell bench --json`"), std::string::npos)
        << refused.output;
    EXPECT_EQ(refused.output.find("json.exception"), std::string::npos) << refused.output;
  }
}

/// Bodies that have not moved are not skinned again: then a vertex would take less than a tenth of a nanosecond.
TEST(Command, ABenchmarkOfSkinningSkins) {
  const ScratchFolder folder;
  const std::string json = folder / "bench.json";
  const CommandResult run = run_softcell("bench --rounds 3 --filter '^skin/sphere/' --json " + json);
  EXPECT_EQ(run.status, 0) << run.output;
  std::map<std::string, double> least;
  for (const auto& entry : read_json(json))
    least[entry["name"].get<std::string>()] = entry["ns_min"].get<double>();
  ASSERT_EQ(least.size(), 2u);
  EXPECT_GT(least["skin/sphere/spe"], 0.01 * least["skin/sphere/scalar"]);
}

TEST(Command, ABenchmarkThatIsInterruptedLeavesNoFile) {
  const ScratchFolder folder;
  const CommandResult run = run_shell("timeout --signal=INT 2 " SOFTCELL_COMMAND
                                      " bench --filter dma/get16k --rounds 100000 --json " +
                                      (folder / "b.json"));
  EXPECT_NE(run.output.find("interrupted"), std::string::npos) << run.output;
  EXPECT_TRUE(files_in(folder.path()).empty());
}

}  // namespace
}  // namespace softcell::tests
