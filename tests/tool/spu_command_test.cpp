// softcell spu run and spu explore as a user meets them, with the kernels of examples/saxpy.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/text_file.h"

namespace softcell::tests {
namespace {

constexpr std::size_t kCount = 10'000;

const std::string kSaxpy = SOFTCELL_SAXPY, kNoWait = SOFTCELL_SAXPY_NO_WAIT, kTalk = SOFTCELL_TALK;

nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

void write_floats(const std::string& path, const std::vector<float>& values) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(float)));
}

std::vector<float> read_floats(const std::string& path) {
  const std::string bytes = test::text_of(path);
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// The number of the first line of a file that holds some text.
std::string line_of(const std::string& text, const std::string& path) {
  std::ifstream file(path);
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.find(text) != std::string::npos) return std::to_string(number);
  }
  return "none";
}

bool exists(const std::string& path) { return std::filesystem::exists(path); }

/// A folder with x.bin and y.bin, and the options for y = 2 x + y on them.
class SpuCommand : public testing::Test {
 protected:
  SpuCommand() { make_inputs(kCount); }

  void make_inputs(std::size_t count) {
    std::vector<float> x(count), y(count);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = static_cast<float>(i % 100);
      y[i] = static_cast<float>(i % 7);
    }
    write_floats(folder_ / "x.bin", x);
    write_floats(folder_ / "y.bin", y);
    count_ = count;
  }

  std::string saxpy_options(int spes = 1) const {
    return " --in x=" + (folder_ / "x.bin") + " --inout y=" + (folder_ / "y.bin") + " --arg f32:2 @x @y " +
           std::to_string(count_) + " " + std::to_string(spes) + " 0 --spes " + std::to_string(spes) + " ";
  }

  void expect_result() const {
    const std::vector<float> y = read_floats(folder_ / "y.bin");
    ASSERT_EQ(y.size(), count_);
    for (std::size_t i = 0; i < count_; ++i)
      ASSERT_EQ(y[i], 2.f * static_cast<float>(i % 100) + static_cast<float>(i % 7)) << i;
  }

  ScratchFolder folder_;
  std::size_t count_ = 0;
};

TEST_F(SpuCommand, RunsAKernelOnFiles) {
  const CommandResult run =
      run_softcell("spu run " + kSaxpy + saxpy_options() + "--json " + (folder_ / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  expect_result();
  EXPECT_NE(run.output.find("get"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("local store: text"), std::string::npos) << run.output;

  const auto json = read_json(folder_ / "s.json");
  EXPECT_EQ(json["kernel"], "saxpy");
  EXPECT_EQ(json["exit_status"], 0);
  const std::uint64_t blocks = (kCount + 2047) / 2048, array = kCount * sizeof(float);
  EXPECT_EQ(json["dma"]["get"]["commands"], 2 * blocks + 1);
  EXPECT_EQ(json["dma"]["get"]["bytes"], 2 * array + 48);
  EXPECT_EQ(json["dma"]["put"]["commands"], blocks);
  EXPECT_EQ(json["dma"]["put"]["bytes"], array);
  EXPECT_EQ(json["dma"]["put_list"]["elements"], 0);
  ASSERT_EQ(json["spes"].size(), 1u);
  EXPECT_EQ(json["spes"][0]["status"], 0);
  EXPECT_TRUE(json["spes"][0]["fault"].is_null());
  EXPECT_GT(json["local_store"]["stack_used"], 0);
  EXPECT_LE(json["local_store"]["stack_used"], json["local_store"]["stack"]);
}

TEST_F(SpuCommand, ManySpesShareTheWorkByTheirNumber) {
  for (const char* schedule : {"eager", "lazy", "random:3"}) {
    make_inputs(kCount);
    const CommandResult run = run_softcell("spu run " + kSaxpy + saxpy_options(6) + "--dma " + schedule);
    ASSERT_EQ(run.status, 0) << run.output;
    expect_result();
  }
}

TEST_F(SpuCommand, ASimulatedClockGivesTheSameRunEveryTime) {
  const auto statistics = [&] {
    make_inputs(kCount);
    const CommandResult run = run_softcell("spu run " + kSaxpy + saxpy_options(3) +
                                           "--dma random:5 --clock simulated --json " + (folder_ / "s.json"));
    EXPECT_EQ(run.status, 0) << run.output;
    auto json = read_json(folder_ / "s.json");
    for (auto& spe : json["spes"]) {  // the host's time
      spe.erase("busy_ms");
      spe.erase("channel_waiting_ms");
    }
    return json;
  };
  const auto first = statistics();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(statistics(), first);
}

TEST_F(SpuCommand, WritesOutFilesOfTheSizeAskedFor) {
  const CommandResult run =
      run_softcell("spu run " + kSaxpy + " --in x=" + (folder_ / "x.bin") +
                   " --out y=" + (folder_ / "new.bin") + ":40000 --arg f32:2 @x @y 10000 1 0");
  ASSERT_EQ(run.status, 0) << run.output;
  const std::vector<float> y = read_floats(folder_ / "new.bin");
  ASSERT_EQ(y.size(), kCount);
  EXPECT_EQ(y[99], 198.f);
}

TEST_F(SpuCommand, WritesAllItsFilesOrNone) {
  const auto before = read_floats(folder_ / "y.bin");
  const std::set<std::string> files = test::files_in(folder_.path());
  for (const std::string option : {"--json /proc/s.json", "--trace /proc/t.json", "--json /dev/full",
                                   "--trace /dev/full", "--json /", "--out z=/proc/z.bin:64"}) {
    const CommandResult run = run_softcell("spu run " + kSaxpy + saxpy_options() + option);
    EXPECT_EQ(run.status, 1) << option << ": " << run.output;
    EXPECT_EQ(read_floats(folder_ / "y.bin"), before) << option;
    EXPECT_EQ(test::files_in(folder_.path()), files) << option;
  }
}

TEST_F(SpuCommand, RefusesTwoOutputsInOneFile) {
  const std::string file = folder_ / "y.bin";
  for (const std::string& option : {"--json " + file, "--trace " + file, "--out z=" + file + ":64",
                                    "--trace " + (folder_ / "same") + " --json " + (folder_ / "./same")}) {
    const CommandResult run = run_softcell("spu run " + kSaxpy + saxpy_options() + option);
    EXPECT_EQ(run.status, 2) << option << ": " << run.output;
    EXPECT_NE(run.output.find("are one file"), std::string::npos) << run.output;
    EXPECT_EQ(read_floats(file)[1], 1.f) << option;
  }
  EXPECT_EQ(run_softcell("spu explore " + kSaxpy + saxpy_options() + "--json " + file).status, 2);
}

TEST_F(SpuCommand, RefusesToReplaceWhatItReads) {
  for (const char* name : {"k.spu.elf", "k.checked.spu.elf"})
    std::filesystem::copy_file(kSaxpy, folder_ / name);
  const std::string image = folder_ / "k.spu.elf", checked = folder_ / "k.checked.spu.elf",
                    x = folder_ / "x.bin";
  const auto size_before = std::filesystem::file_size(image);
  const auto refusal = [&](const std::string& options) {
    const std::string arguments = image + saxpy_options() + options;
    const CommandResult run = run_softcell("spu run " + arguments);
    EXPECT_EQ(run.status, 2) << options << ": " << run.output;
    EXPECT_EQ(run_softcell("spu explore " + arguments).status, 2) << options;
    EXPECT_EQ(std::filesystem::file_size(image), size_before) << options;
    EXPECT_EQ(read_floats(x).size(), kCount) << options;
    return run.output;
  };
  EXPECT_NE(refusal("--out z=" + image + ":64").find("the kernel image and --out z "), std::string::npos);
  EXPECT_NE(refusal("--json " + image).find("the kernel image and --json "), std::string::npos);
  EXPECT_NE(refusal("--checked --json " + image).find("the kernel image and --json "), std::string::npos);
  EXPECT_NE(refusal("--checked --json " + checked).find("the kernel image and --json "), std::string::npos);
  EXPECT_NE(refusal("--json " + x).find("--in x and --json "), std::string::npos);
  EXPECT_NE(refusal("--out z=" + x + ":64").find("--in x and --out z "), std::string::npos);
  EXPECT_NE(refusal("--inout z=" + x).find("--in x and --inout z "), std::string::npos);
  EXPECT_EQ(run_softcell("spu run " + image + saxpy_options() + "--trace " + x).status, 2);
}

TEST_F(SpuCommand, TheImageMayStandBehindTheBuffers) {
  const CommandResult run =
      run_softcell("spu run --in x=" + (folder_ / "x.bin") + " --inout y=" + (folder_ / "y.bin") + " " +
                   kSaxpy + " --arg f32:2 @x @y 10000 1 0");
  ASSERT_EQ(run.status, 0) << run.output;
  expect_result();
}

TEST_F(SpuCommand, ReadsOnlyFilesThatFit) {
  const auto refusal = [&](const std::string& file) {
    const CommandResult run =
        run_shell("timeout 20 " SOFTCELL_COMMAND " spu run " + kTalk + " --in x=" + file);
    EXPECT_EQ(run.status, 1) << run.output;
    return run.output;
  };
  std::ofstream(folder_ / "empty.bin").close();
  EXPECT_NE(refusal(folder_ / "empty.bin").find("is empty"), std::string::npos);
  std::ofstream(folder_ / "huge.bin").close();
  std::filesystem::resize_file(folder_ / "huge.bin", std::uintmax_t{1} << 40);  // of holes
  EXPECT_NE(refusal(folder_ / "huge.bin").find("of 1099511627776 bytes does not fit"), std::string::npos);
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal(folder_ / "pipe").find("pipe: it is not a regular file"), std::string::npos);
}

TEST_F(SpuCommand, WritesATrace) {
  const CommandResult run =
      run_softcell("spu run " + kSaxpy + saxpy_options(2) + "--trace " + (folder_ / "t.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  const auto trace = read_json(folder_ / "t.json");
  EXPECT_FALSE(trace["traceEvents"].empty());
}

TEST_F(SpuCommand, PassesMailboxesBothWays) {
  const CommandResult run = run_softcell("spu run " + kTalk + " --spes 2 --in-mbox 0x40 --arg 1 2 3 --json " +
                                         (folder_ / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("SPE 1 left 0x00000041 in its outbound mailbox"), std::string::npos)
      << run.output;
  const auto json = read_json(folder_ / "s.json");
  EXPECT_EQ(json["spes"][0]["out_mbox"], 0x40);
  EXPECT_EQ(json["spes"][1]["out_mbox"], 0x41);
  EXPECT_EQ(json["spes"][1]["out_intr_mbox"], 3) << "envp is the number of arguments";
}

TEST_F(SpuCommand, WordsAtTheEndLeaveTheLastForTheImage) {
  const CommandResult run =
      run_softcell("spu run --in-mbox 0x40 --arg 1 2 3 " + kTalk + " --json " + (folder_ / "s.json"));
  EXPECT_EQ(run.status, 2) << "an option follows, so that --arg has taken all";
  EXPECT_NE(run.output.find("softcell spu run needs IMAGE"), std::string::npos) << run.output;
  const CommandResult last =
      run_softcell("spu run --json " + (folder_ / "s.json") + " --in-mbox 0x40 --arg 1 2 3 " + kTalk);
  ASSERT_EQ(last.status, 0) << last.output;
  EXPECT_EQ(read_json(folder_ / "s.json")["spes"][0]["out_intr_mbox"], 3);
}

TEST_F(SpuCommand, TheImagesNameReachesTheTerminalWithoutControlCharacters) {
  const std::string image = folder_ / "\x1b[31m.spu.elf";
  std::filesystem::copy_file(kTalk, image);
  const CommandResult run = run_softcell("spu run '" + image + "' --in-mbox 1");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("softcell: SPE 0, kernel \\x1b[31m: ended with status 7"), std::string::npos)
      << run.output;
}

TEST_F(SpuCommand, AFaultIsOneSentenceWithItsPlaceAndLeavesNoOutput) {
  const CommandResult run =
      run_softcell("spu run " + kTalk + " --in-mbox 2 --in x=" + (folder_ / "x.bin") +
                   " --out y=" + (folder_ / "new.bin") + ":64 --arg @x --json " + (folder_ / "s.json"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("softcell: SPE 0, kernel talk, talk.cpp:"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("ea-alignment"), std::string::npos) << run.output;
  EXPECT_FALSE(exists(folder_ / "new.bin"));
  const auto json = read_json(folder_ / "s.json");
  EXPECT_EQ(json["exit_status"], 1);
  EXPECT_EQ(json["spes"][0]["fault"]["rule"], "ea-alignment");
}

TEST_F(SpuCommand, SaysWhatTheKernelDidWhenAFileCannotBeWritten) {
  for (const std::string verb : {"spu run ", "spu explore --seeds 3 "}) {
    const CommandResult fault = run_softcell(verb + kTalk + " --in-mbox 2 --in x=" + (folder_ / "x.bin") +
                                             " --arg @x --json /dev/full");
    EXPECT_EQ(fault.status, 1) << fault.output;
    EXPECT_NE(fault.output.find("ea-alignment"), std::string::npos) << fault.output;
    EXPECT_NE(fault.output.find("softcell: cannot write /dev/full: No space left"), std::string::npos)
        << fault.output;
  }
  const CommandResult good = run_softcell("spu run " + kSaxpy + saxpy_options() + "--json /dev/full");
  EXPECT_EQ(good.status, 1) << good.output;
  EXPECT_NE(good.output.find("local store: text"), std::string::npos) << good.output;
}

TEST_F(SpuCommand, AStatusThatIsNotZeroIsAFailure) {
  const CommandResult status = run_softcell("spu run " + kTalk + " --in-mbox 1");
  EXPECT_EQ(status.status, 1);
  EXPECT_NE(status.output.find("softcell: SPE 0, kernel talk: ended with status 7"), std::string::npos)
      << status.output;
  const CommandResult stop = run_softcell("spu run " + kTalk + " --in-mbox 4");
  EXPECT_EQ(stop.status, 1);
  EXPECT_NE(stop.output.find("ended with stop code 0x0123"), std::string::npos) << stop.output;
}

TEST_F(SpuCommand, NothingHangs) {
  const CommandResult deadlock = run_softcell("spu run " + kTalk + " --spes 2 --in-mbox 3");
  EXPECT_EQ(deadlock.status, 1);
  EXPECT_NE(deadlock.output.find("deadlock"), std::string::npos) << deadlock.output;
  const CommandResult endless = run_softcell("spu run " + kTalk + " --in-mbox 5 --deadline 0.2");
  EXPECT_EQ(endless.status, 1);
  EXPECT_NE(endless.output.find("deadline-exceeded"), std::string::npos) << endless.output;
}

TEST_F(SpuCommand, CheckedHasNothingToSayAboutACorrectKernel) {
  for (const char* schedule : {"eager", "lazy", "random:3"}) {
    make_inputs(kCount);
    const CommandResult run =
        run_softcell("spu run " + kSaxpy + saxpy_options(2) + "--checked --dma " + schedule);
    ASSERT_EQ(run.status, 0) << run.output;
    expect_result();
  }
}

TEST_F(SpuCommand, WritesJsonAboutAFileWhoseNameIsNotUtf8) {
  const std::string kernel = folder_ / "talk\xff.spu.elf";
  std::filesystem::copy_file(kTalk, kernel);
  const CommandResult run = run_softcell("spu budget '" + kernel + "' --json " + (folder_ / "b.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(read_json(folder_ / "b.json")[0]["kernel"], "talk\xEF\xBF\xBD") << "the replacement character";
}

TEST_F(SpuCommand, BudgetTakesKernelsOfTheUsersOwn) {
  const CommandResult run =
      run_softcell("spu budget " + kSaxpy + " skin " + kTalk + " --json " + (folder_ / "b.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("\nsaxpy "), std::string::npos) << run.output;
  const auto rows = read_json(folder_ / "b.json");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["kernel"], "saxpy");
  EXPECT_EQ(rows[0]["stack"], 1024);
  EXPECT_EQ(rows[0]["budget"], 40960);
  EXPECT_GT(rows[0]["text"], 0);
  EXPECT_TRUE(rows[0]["stack_used"].is_null()) << "nobody knows its work";
  EXPECT_EQ(rows[1]["kernel"], "skin");
  if (SOFTCELL_HAS_SAMPLES)
    EXPECT_GT(rows[1]["stack_used"], 0);
  else
    EXPECT_TRUE(rows[1]["stack_used"].is_null()) << "without demos there is no work for it";
  EXPECT_EQ(rows[2]["budget"], 8192);

  // Of the same name as one of softcell's own.
  std::filesystem::copy_file(kSaxpy, folder_ / "skin.spu.elf");
  ASSERT_EQ(
      run_softcell("spu budget " + (folder_ / "skin.spu.elf") + " --json " + (folder_ / "b.json")).status, 0);
  EXPECT_TRUE(read_json(folder_ / "b.json")[0]["stack_used"].is_null());
  EXPECT_EQ(run_softcell("spu budget " + (folder_ / "skin.spu.elf") + " --json " + (folder_ / "skin.spu.elf"))
                .status,
            2);
}

TEST_F(SpuCommand, SaysHowMuchOfACheckedStackIsForTheChecks) {
  const CommandResult run =
      run_softcell("spu run " + kSaxpy + saxpy_options() + "--checked --json " + (folder_ / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find(" of 2048 declared (the kernel's 1024 and 1024 for the checks);"),
            std::string::npos)
      << run.output;
  EXPECT_EQ(read_json(folder_ / "s.json")["local_store"]["stack_for_checks"], 1024);

  const CommandResult on_spu =
      run_softcell("spu budget --checked " SOFTCELL_SPU_PROGRAMS "/scale_stream.O2.elf");
  EXPECT_EQ(on_spu.status, 0) << on_spu.output;
  EXPECT_EQ(on_spu.output.find("checked image"), std::string::npos)
      << "a program built for the SPU has no checked image: " << on_spu.output;
  const CommandResult budget =
      run_softcell("spu budget --checked " + kSaxpy + " --json " + (folder_ / "b.json"));
  ASSERT_EQ(budget.status, 0) << budget.output;
  EXPECT_NE(budget.output.find("The stack of a checked image is 1024 bytes larger than the kernel declares"),
            std::string::npos)
      << budget.output;
  const auto row = read_json(folder_ / "b.json")[0];
  EXPECT_EQ(row["checked"], true);
  EXPECT_EQ(row["stack"], 2048);
  EXPECT_EQ(row["stack_for_checks"], 1024);
}

TEST_F(SpuCommand, WritesABufferToStandardOutput) {
  const CommandResult run =
      run_shell(SOFTCELL_COMMAND " spu run " + kSaxpy + " --in x=" + (folder_ / "x.bin") +
                " --out y=-:" + std::to_string(4 * kCount) + " --arg f32:2 @x @y " + std::to_string(kCount) +
                " 1 0 2>/dev/null");
  ASSERT_EQ(run.status, 0);
  ASSERT_EQ(run.output.size(), 4 * kCount) << "nothing but the buffer";
  float third = 0;
  std::memcpy(&third, run.output.data() + 12, sizeof third);
  EXPECT_EQ(third, 6);
}

TEST_F(SpuCommand, ATraceOfACheckedRunHasAMistakeOnce) {
  make_inputs(1024);
  const CommandResult run =
      run_softcell("spu run " + kNoWait + saxpy_options() + "--checked --trace " + (folder_ / "t.json"));
  ASSERT_EQ(run.status, 3) << run.output;
  const auto trace = read_json(folder_ / "t.json");
  std::set<std::string> seen;
  std::int64_t most = 0;
  for (const auto& event : trace["traceEvents"]) {
    if (event.value("cat", "") != "finding") continue;
    const auto& args = event["args"];
    EXPECT_TRUE(seen.insert(event["name"].get<std::string>() + args["place"].get<std::string>()).second)
        << event;
    most = std::max(most, args["count"].get<std::int64_t>());
  }
  EXPECT_FALSE(seen.empty());
  EXPECT_GT(most, 1);
}

TEST_F(SpuCommand, CheckedNamesTheLineThatDoesNotWait) {
  make_inputs(1024);
  const std::string line = line_of("too early", SOFTCELL_SAXPY_NO_WAIT_SOURCE);
  const CommandResult run =
      run_softcell("spu run " + kNoWait + saxpy_options() + "--checked --json " + (folder_ / "s.json"));
  EXPECT_EQ(run.status, 3) << run.output;
  EXPECT_NE(run.output.find("saxpy_no_wait.cpp:" + line + ": load-in-flight"), std::string::npos)
      << run.output;
  EXPECT_EQ(read_floats(folder_ / "y.bin")[1], 1.f) << "a run with findings writes no buffers";
  const auto findings = read_json(folder_ / "s.json")["findings"];
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0]["rule"], "load-in-flight");
  EXPECT_EQ(findings[0]["place"], "saxpy_no_wait.cpp:" + line);
  EXPECT_GT(findings[0]["count"], 1);
}

TEST_F(SpuCommand, CheckedNeedsTheNeighbourFile) {
  std::filesystem::copy_file(kSaxpy, folder_ / "alone.spu.elf");
  const CommandResult run = run_softcell("spu run --checked " + (folder_ / "alone.spu.elf"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("alone.checked.spu.elf does not exist"), std::string::npos) << run.output;
}

TEST_F(SpuCommand, ExploreIsContentWithACorrectKernel) {
  const CommandResult run =
      run_softcell("spu explore " + kSaxpy + saxpy_options(2) + "--seeds 20 --json " + (folder_ / "e.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("the same outcome under 20 seeds"), std::string::npos) << run.output;
  EXPECT_EQ(read_floats(folder_ / "y.bin")[1], 1.f) << "exploring writes no buffers";
  const auto json = read_json(folder_ / "e.json");
  EXPECT_EQ(json["differs"], false);
  EXPECT_EQ(json["seeds_tried"], 20);
  const CommandResult quiet = run_softcell("spu explore --quiet " + kSaxpy + saxpy_options(2) + "--seeds 2");
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.output, "");
}

TEST_F(SpuCommand, ExploreFindsAKernelThatDoesNotWaitAndSaysHowToSeeItAgain) {
  make_inputs(1024);
  const CommandResult run =
      run_softcell("spu explore " + kNoWait + saxpy_options() + "--json " + (folder_ / "e.json"));
  ASSERT_EQ(run.status, 1) << run.output;
  EXPECT_NE(run.output.find("buffer y, byte "), std::string::npos) << run.output;
  const auto json = read_json(folder_ / "e.json");
  ASSERT_EQ(json["differs"], true);
  const auto difference = json["differences"].back();
  EXPECT_EQ(difference["what"], "buffer y");
  EXPECT_LT(difference["offset"], 4096);

  // The two commands that it prints give just these two results.
  std::vector<std::vector<float>> results;
  for (const std::string command : json["reproduce"]) {
    make_inputs(1024);
    ASSERT_TRUE(command.starts_with("softcell ")) << command;
    const CommandResult again = run_softcell(command.substr(std::strlen("softcell ")));
    ASSERT_EQ(again.status, 0) << again.output;
    results.push_back(read_floats(folder_ / "y.bin"));
  }
  ASSERT_EQ(results.size(), 2u);
  const std::size_t first = difference["offset"].get<std::size_t>() / sizeof(float);
  for (std::size_t i = 0; i < first; ++i) ASSERT_EQ(results[0][i], results[1][i]) << i;
  EXPECT_NE(std::memcmp(&results[0][first], &results[1][first], sizeof(float)), 0);
}

TEST_F(SpuCommand, ExploreOfACheckedKernelNamesTheReasonToo) {
  make_inputs(1024);
  const CommandResult run = run_softcell("spu explore --checked " + kNoWait + saxpy_options());
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("buffer y, byte "), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("load-in-flight"), std::string::npos) << run.output;
}

TEST_F(SpuCommand, ExploreReportsAFaultThatEverySeedHas) {
  const CommandResult run = run_softcell(
      "spu explore " + kTalk + " --in-mbox 2 --seeds 3 --in x=" + (folder_ / "x.bin") + " --arg @x");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("ea-alignment"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("under 3 seeds"), std::string::npos) << run.output;
}

TEST_F(SpuCommand, ExploreComparesNothingOfARunThatDoesNotEnd) {
  const CommandResult run =
      run_softcell("spu explore " + kTalk + " --in-mbox 5 --deadline 0.2 --json " + (folder_ / "e.json"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("deadline-exceeded"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("nothing to compare"), std::string::npos) << run.output;
  EXPECT_EQ(read_json(folder_ / "e.json")["differs"], false);
}

TEST_F(SpuCommand, RunSaysWhenItIsInterrupted) {
  for (const std::string signal : {"INT", "TERM", "HUP"}) {
    const auto begin = std::chrono::steady_clock::now();
    const CommandResult run =
        run_shell("timeout --preserve-status -s " + signal + " 0.5 " SOFTCELL_COMMAND " spu run " + kTalk +
                  " --in-mbox 5 --deadline 30 --json " + (folder_ / "i.json"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20)) << signal;
    EXPECT_EQ(run.status, 130) << signal << ": " << run.output;
    EXPECT_NE(run.output.find("softcell: interrupted; no file is written\n"), std::string::npos)
        << run.output;
    EXPECT_NE(run.output.find("\n0    interrupted  "), std::string::npos) << run.output;
    EXPECT_EQ(run.output.find("deadline-exceeded"), std::string::npos) << run.output;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "i.json")) << signal;
  }
}

TEST_F(SpuCommand, ExploreEndsAtCtrlCWithinARun) {
  const auto begin = std::chrono::steady_clock::now();
  const CommandResult run =
      run_shell("timeout --preserve-status -s INT 0.5 " SOFTCELL_COMMAND " spu explore " + kTalk +
                " --in-mbox 5 --deadline 30");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  EXPECT_EQ(run.status, 130) << run.output;
  EXPECT_NE(run.output.find("interrupted; 0 of"), std::string::npos) << run.output;
}

struct Refusal {
  std::string arguments;
  int status;
  const char* part;
};

void PrintTo(const Refusal& r, std::ostream* out) { *out << r.arguments; }

class SpuCommandRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(SpuCommandRefuses, WithOneSentenceAndItsStatus) {
  const CommandResult run = run_softcell(GetParam().arguments);
  EXPECT_EQ(run.status, GetParam().status) << run.output;
  EXPECT_NE(run.output.find(GetParam().part), std::string::npos) << run.output;
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  EXPECT_EQ(run.output.rfind("softcell: ", 0), 0u) << run.output;
}

INSTANTIATE_TEST_SUITE_P(
    WrongUsage, SpuCommandRefuses,
    testing::Values(Refusal{"spu run", 2, "IMAGE"}, Refusal{"spu explore", 2, "IMAGE"},
                    Refusal{"spu run " + kTalk + " --spes 7", 2, "--spes"},
                    Refusal{"spu run " + kTalk + " --dma never", 2, "random:SEED"},
                    Refusal{"spu run " + kTalk + " --clock wall", 2, "--clock"},
                    Refusal{"spu run " + kTalk + " --in x", 2, "NAME=FILE"},
                    Refusal{"spu run " + kTalk + " --out y=f", 2, "NAME=FILE:SIZE"},
                    Refusal{"spu run " + kTalk + " --arg @x", 2, "no --in, --out or --inout has that name"},
                    Refusal{"spu run " + kTalk + " --arg 1.5", 2, "f32:VALUE"},
                    Refusal{"spu run " + kTalk + " --in-mbox 1 2 3 4 5", 2, "at most four"},
                    Refusal{"spu run " + kTalk + " --deadline soon", 2, "seconds"},
                    Refusal{"spu explore " + kTalk + " --seeds 0", 2, "--seeds"}));

INSTANTIATE_TEST_SUITE_P(
    BadInput, SpuCommandRefuses,
    testing::Values(Refusal{"spu run no_such_kernel", 1, "transfers"},
                    Refusal{"spu run " SOFTCELL_COMMAND, 1, "kernel image"},
                    Refusal{"spu run /", 1, "it is a directory"},
                    Refusal{"spu run --checked " SOFTCELL_COMMAND, 1, ".spu.elf"},
                    Refusal{"spu run " + kTalk + " --in x=/no/such/file", 1, "/no/such/file"},
                    Refusal{"spu run " + kTalk + " --in x=/dev/zero", 1,
                            "cannot read /dev/zero: it is not a regular file"},
                    Refusal{"spu run " + kTalk + " --inout x=/dev/null", 1, "it is not a regular file"},
                    Refusal{"spu run /dev/zero", 1, "/dev/zero: it is not a regular file"},
                    Refusal{"spu run " + kTalk + " --out x=f:300M", 1, "does not fit"}));

}  // namespace
}  // namespace softcell::tests
