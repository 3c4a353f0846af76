// The files that the command writes: whole or not at all, each under one name, and none that it reads.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "command_support.h"
#include "softcell/render/png_io.h"
#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"

namespace softcell::tests {
namespace {

using test::files_in;

TEST(Command, OtherOutputsMayLieInTheFoldersOfPictures) {
  const ScratchFolder folder;
  const std::string out = folder / "new/frames";
  const CommandResult run = run_softcell(kDrop + ("--frames 2 --out " + out) + " --json " + out +
                                         "/s.json --record " + out + "/r.rec --trace " + out + "/t.json");
  ASSERT_EQ(run.status, 0) << run.output;
  for (const char* file : {"/s.json", "/r.rec", "/t.json", "/frame_00001.png"})
    EXPECT_TRUE(std::filesystem::exists(out + file)) << file;
}

TEST(Command, ARunThatIsRefusedLeavesNoFolders) {
  const ScratchFolder folder;
  write_file(folder / "bad.toml", "title = 3\n");
  std::filesystem::create_directory(folder / "mine");
  const std::string scene = "demo 3d --headless --scene " + (folder / "bad.toml");
  for (const std::string& outputs :
       {"--out " + (folder / "a/b"), "--out " + (folder / "a/b/") + " --json " + (folder / "a/b/s.json"),
        "--video " + (folder / "c/d.mp4"), "--out " + (folder / "mine")}) {
    const CommandResult run = run_softcell(scene + " " + outputs);
    EXPECT_EQ(run.status, 1) << run.output;
    EXPECT_NE(run.output.find("it must be a text"), std::string::npos) << run.output;
    EXPECT_EQ(files_in(folder / ""), (std::set<std::string>{"bad.toml", "mine"})) << outputs;
  }
}

TEST(Command, ASecondRunReplacesTheFramesOfTheFirst) {
  const ScratchFolder folder;
  ASSERT_EQ(run_softcell(kDrop + std::string("--frames 4 --out ") + (folder / "out")).status, 0);
  write_file(folder / "out/mine.txt", "keep");
  ASSERT_EQ(run_softcell(kDrop + std::string("--frames 2 --out ") + (folder / "out")).status, 0);
  EXPECT_EQ(files_in(folder / "out"),
            (std::set<std::string>{"frame_00000.png", "frame_00001.png", "mine.txt"}));
}

/// Starts a demo that writes everything there is, and ends it by the signal after some frames.
/// @return  its exit status, and how long it took to end
std::pair<int, std::chrono::steady_clock::duration> interrupt_demo(const ScratchFolder& folder, int signal) {
  const pid_t child = fork();
  EXPECT_GE(child, 0);
  if (child == 0) {
    std::freopen("/dev/null", "w", stdout);
    std::freopen("/dev/null", "w", stderr);
    const rlimit no_core{};
    setrlimit(RLIMIT_CORE, &no_core);
    const std::string out = folder / "out", video = folder / "v.mp4", recording = folder / "r.rec",
                      trace = folder / "t.json", json = folder / "s.json";
    execl(SOFTCELL_COMMAND, "softcell", "demo", "3d", "--headless", "--scene", "drop", "--frames", "100000",
          "--size", "320x240", "--out", out.c_str(), "--video", video.c_str(), "--record", recording.c_str(),
          "--trace", trace.c_str(), "--json", json.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  const auto frames = [&] {
    return std::filesystem::exists(folder / "out") ? files_in(folder / "out").size() : std::size_t{0};
  };
  for (int i = 0; i < 3000 && frames() < 3; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto begin = std::chrono::steady_clock::now();
  kill(child, signal);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          std::chrono::steady_clock::now() - begin};
}

TEST(Command, StopsWithinASecondOfASignalAndKeepsWholeWhatItHasSoFar) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (kSlowBuild && signal != SIGTERM) continue;
    SCOPED_TRACE(strsignal(signal));
    const ScratchFolder folder;
    const auto [status, took] = interrupt_demo(folder, signal);
    EXPECT_EQ(status, 130);
    EXPECT_LT(took, std::chrono::seconds(kSlowBuild ? 10 : 1));
    EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"out", "r.rec", "v.mp4"}))
        << "no part of a file is left";
    const std::set<std::string> frames = files_in(folder / "out");
    EXPECT_GE(frames.size(), 3u);
    for (const std::string& name : frames) {
      EXPECT_TRUE(name.ends_with(".png")) << name;
      EXPECT_NO_THROW(render::read_png(folder / "out/" + name)) << name;
    }
    const CommandResult film =
        run_shell("ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 " +
                  (folder / "v.mp4"));
    EXPECT_EQ(film.output, std::to_string(frames.size()) + "\n");
    const CommandResult replay =
        run_softcell("demo 3d --headless --quiet --size 32x32 --replay " + (folder / "r.rec"));
    EXPECT_EQ(replay.status, 0) << replay.output;
  }
}

TEST(Command, LeavesNoPartOfAFileWhenASignalEndsItAtOnce) {
  for (const int signal : {SIGQUIT, SIGPIPE}) {
    if (kSlowBuild && signal != SIGQUIT) continue;
    SCOPED_TRACE(strsignal(signal));
    const ScratchFolder folder;
    EXPECT_EQ(interrupt_demo(folder, signal).first, 128 + signal);
    EXPECT_EQ(files_in(folder.path()), std::set<std::string>{"out"});
    for (const std::string& name : files_in(folder / "out")) EXPECT_TRUE(name.ends_with(".png")) << name;
  }
}

TEST(Command, GoesOnWithoutItsTerminalUnderNohup) {
  const CommandResult run = run_shell(
      "trap '' HUP; " SOFTCELL_COMMAND
      " demo 2d --headless --quiet --frames 60 --size 32x32 & child=$!; sleep 0.2; kill -HUP $child; "
      "wait $child");
  EXPECT_EQ(run.status, 0) << run.output;
}

TEST(Command, RefusesTwoOutputsInOneFile) {
  const ScratchFolder folder;
  write_file(folder / "t.json", "a trace");
  const std::string demo = "demo 2d --headless --frames 1 --size 32x32 ",
                    here = "cd " + folder.path().string();
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run = run_shell(here + " && " SOFTCELL_COMMAND " " + arguments);
    EXPECT_EQ(run.status, 2) << arguments << ": " << run.output;
    EXPECT_EQ(files_in(folder.path()), std::set<std::string>{"t.json"}) << arguments;
    return run.output;
  };
  EXPECT_EQ(refusal(demo + "--json same --trace ./same")
                .rfind("softcell: --trace and --json are one file, same", 0),
            0u);
  EXPECT_NE(refusal(demo + "--record same --json " + (folder / "same")).find("--record and --json"),
            std::string::npos);
  EXPECT_NE(refusal(demo + "--video same.mp4 --json same.mp4").find("--video and --json"), std::string::npos);
  EXPECT_NE(refusal("report t.json --out ./t.json").find("the trace and --out are one file"),
            std::string::npos);
  EXPECT_EQ(run_softcell(demo + "--quiet --json /dev/null --trace /dev/null").status, 0) << "nothing is lost";
}

/// What the command writes to standard output alone, and its status.
CommandResult standard_output_of(const std::string& arguments) {
  return run_shell(SOFTCELL_COMMAND " " + arguments + " 2>/dev/null");
}

TEST(Command, WritesToStandardOutputWhereADashIsTheFile) {
  const ScratchFolder folder;
  const std::string demo = "demo 2d --headless --frames 2 --size 32x32 ";
  const auto parsed = [&](const std::string& arguments) {
    const CommandResult run = standard_output_of(arguments);
    EXPECT_EQ(run.status, 0) << arguments;
    nlohmann::json document;
    EXPECT_NO_THROW(document = nlohmann::json::parse(run.output)) << arguments << ": " << run.output;
    return document;
  };
  EXPECT_EQ(parsed(demo + "--json -")["frames"], 2);
  EXPECT_TRUE(parsed(demo + "--trace - --json " + (folder / "s.json")).contains("traceEvents"));
  EXPECT_EQ(parsed("spu budget match skin --json -").size(), 2u);
  EXPECT_EQ(parsed("bench --rounds 1 --filter dma/memcpy16k --json -").size(), 1u);
  ASSERT_EQ(run_softcell(demo + "--trace " + (folder / "t.json")).status, 0);
  const CommandResult page = standard_output_of("report " + (folder / "t.json") + " --out -");
  EXPECT_EQ(page.output.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_TRUE(page.output.ends_with("</html>\n")) << page.output.substr(page.output.size() - 100);
  // What is there already stays, and a file of that name is not meant.
  const CommandResult appended = run_shell("cd " + folder.path().string() +
                                           " && echo before > a && " SOFTCELL_COMMAND
                                           " spu budget skin --json - >> a 2>/dev/null && head -1 a && ls");
  EXPECT_EQ(appended.output, "before\na\ns.json\nt.json\n");
}

TEST(Command, TheSummaryGoesToStandardErrorWhereStandardOutputIsAFile) {
  const CommandResult run =
      run_shell(SOFTCELL_COMMAND " demo 2d --headless --frames 2 --size 32x32 --json - 2>&1 >/dev/null");
  EXPECT_NE(run.output.find("\nfigures:   standard output\n"), std::string::npos) << run.output;
}

TEST(Command, KeepsTheFilesThatASceneNames) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "part");
  write_file(folder / "part/l.lua", "return { rows = { '##', '##' } }");
  write_file(folder / "m.obj", kCube);
  write_file(folder / "2.toml", "dimension = 2\n[[soft_body]]\ncell_size = 0.5\nlattice = \"part/l.lua\"\n");
  write_file(folder / "3.toml", "[[soft_body]]\ncell_size = 0.25\nmesh = \"m.obj\"\n");
  const auto before = files_in(folder.path());
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run = run_shell("cd " + folder.path().string() + " && " SOFTCELL_COMMAND " demo " +
                                        arguments + " --headless --frames 1 --size 32x32");
    EXPECT_EQ(run.status, 2) << run.output;
    EXPECT_EQ(files_in(folder.path()), before);
    return run.output;
  };
  for (const std::string output : {"--json", "--trace", "--record"}) {
    EXPECT_NE(refusal("2d --scene 2.toml " + output + " part/../part/l.lua")
                  .find("a file of the scene and " + output + " are one file, part/../part/l.lua"),
              std::string::npos);
    EXPECT_NE(refusal("3d --scene 3.toml " + output + " m.obj").find("a file of the scene and " + output),
              std::string::npos);
  }
}

TEST(Command, RefusesToReplaceWhatItReads) {
  const ScratchFolder folder;
  const std::string scene = "dimension = 2\n";
  write_file(folder / "f.toml", scene);
  write_file(folder / "m.obj", kCube);
  write_file(folder / "r.rec", "a recording");
  const auto before = files_in(folder.path());
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run =
        run_shell("cd " + folder.path().string() + " && timeout 20 " SOFTCELL_COMMAND " " + arguments);
    EXPECT_EQ(run.status, 2) << arguments << ": " << run.output;
    EXPECT_EQ(files_in(folder.path()), before) << arguments;
    return run.output;
  };
  const std::string demo = "demo 2d --headless --frames 1 --size 32x32 ";
  for (const std::string output : {"--record", "--trace", "--json"}) {
    EXPECT_NE(refusal(demo + "--scene f.toml " + output + " ./f.toml")
                  .find("the scene and " + output + " are one file, ./f.toml; give each a file of its own"),
              std::string::npos);
    EXPECT_NE(refusal("demo 3d --headless --mesh m.obj " + output + " m.obj")
                  .find("--mesh and " + output + " are one file, m.obj"),
              std::string::npos);
  }
  for (const std::string output : {"--trace", "--json"}) {
    EXPECT_NE(refusal(demo + "--replay r.rec " + output + " r.rec").find("--replay and " + output),
              std::string::npos);
  }
  // A built-in scene is no file.
  const CommandResult named = run_shell("cd " + folder.path().string() + " && " SOFTCELL_COMMAND " " + demo +
                                        "--scene man --json man");
  EXPECT_EQ(named.status, 0) << named.output;
}

TEST(Command, KeepsStatisticsAndTraceOfARunWhoseSceneCannotBeSaved) {
  const ScratchFolder folder;
  write_file(folder / "br.toml",
             "dimension = 2\n[framework]\n[[soft_body]]\nname = 'b'\ncell_size = 0.3\n"
             "shape = { kind = 'ring' }\nposition = [0, 2]\nfracture = { stretch = 0.05 }\n");
  const CommandResult run = run_shell("cd " + folder.path().string() +
                                      " && timeout 60 " SOFTCELL_COMMAND
                                      " demo 2d --headless --size 32x32 --quiet --scene br.toml --frames 120"
                                      " --save-scene s.toml --json j.json --trace t.json --record r.rec");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("the scene br cannot be saved or changed: 'b' has broken"), std::string::npos)
      << run.output;
  EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"br.toml", "j.json", "t.json", "r.rec"}));
  EXPECT_EQ(read_json(folder / "j.json").at("frames"), 120);
}

// The folder above the one that a link stands for is not the folder that the link is in.
TEST(Command, KnowsOneFileThroughALinkedFolder) {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder / "other/sub");
  std::filesystem::create_directory_symlink(folder / "other/sub", folder / "link");
  const std::string demo = "cd " + folder.path().string() +
                           " && " SOFTCELL_COMMAND
                           " demo 2d --headless --quiet --frames 1 --size 32x32 --trace link/../x.json ";
  EXPECT_EQ(run_shell(demo + "--json other/x.json").status, 2);
  EXPECT_EQ(run_shell(demo + "--json x.json").status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "x.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "other/x.json"));
}

TEST(Command, KnowsOneFileThroughALinkToWhatIsStillToBeMade) {
  const ScratchFolder folder;
  std::filesystem::create_symlink("made.json", folder / "link.json");
  const std::string demo =
      "demo 2d --headless --quiet --frames 1 --size 32x32 --json " + (folder / "link.json");
  EXPECT_EQ(run_softcell(demo + " --trace " + (folder / "made.json")).status, 2);
  EXPECT_EQ(run_softcell(demo).status, 0);
  EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"link.json", "made.json"}));
}

TEST(Command, LeavesNothingWhenInterruptedBeforeTheFirstFrame) {
  const ScratchFolder folder;
  const CommandResult run =
      run_shell("cd " + folder.path().string() +
                " && " SOFTCELL_COMMAND
                " demo 3d --headless --scene big --frames 1 --json j --trace t --record r & child=$!; "
                "while [ -z \"$(ls -A " +
                folder.path().string() + ")\" ]; do sleep 0.01; done; kill -TERM $child; wait $child");
  EXPECT_EQ(run.status, 130) << run.output;
  EXPECT_EQ(run.output, "softcell: interrupted before the first frame\n");
  EXPECT_TRUE(files_in(folder.path()).empty());
}

TEST(Command, SaysHowFarItCameWhenInterrupted) {
  const ScratchFolder folder;
  const CommandResult run = run_shell(
      "cd " + folder.path().string() + " && timeout --preserve-status --signal=INT " +
      std::to_string(kSlowBuild ? 8 : 3) +
      " " SOFTCELL_COMMAND " demo 2d --headless --frames 100000 --size 32x32 --out frames --json j");
  EXPECT_EQ(run.status, 130);
  EXPECT_TRUE(std::regex_match(
      run.output,
      std::regex(
          "softcell: interrupted after [0-9]+ of 100000 frames; every frame that was written is whole; "
          "only a run to its end leaves a trace, statistics or a saved scene\n")))
      << run.output;
  EXPECT_EQ(files_in(folder.path()), std::set<std::string>{"frames"});
}

// A pipe's opening waits for its reader, and this one reads the second behind the first's end.
TEST(Command, WritesIntoPipesOneAfterTheOther) {
  const ScratchFolder folder;
  const CommandResult run =
      run_shell("cd " + folder.path().string() +
                " && mkfifo p q && (cat p >trace; cat q >json) & "
                "cd " +
                folder.path().string() +
                "; while [ ! -p q ]; do sleep 0.01; done; timeout 60 " SOFTCELL_COMMAND
                " demo 2d --headless --quiet --frames 1 --size 32x32 --trace p --json q && wait");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_GT(std::filesystem::file_size(folder / "trace"), 100u);
  EXPECT_GT(std::filesystem::file_size(folder / "json"), 100u);
}

TEST(Command, SaysThatAFileWouldBeLargerThanTheLimit) {
  for (const std::string option : {"--trace", "--json"}) {
    const ScratchFolder folder;
    const CommandResult run =
        run_shell("cd " + folder.path().string() +
                  "; ulimit -f 0; " SOFTCELL_COMMAND " demo 2d --headless --quiet --frames 1 --size 32x32 " +
                  option + " f 2>&1 | cat");
    EXPECT_EQ(run.output, "softcell: cannot write f: File too large\n") << option;
    EXPECT_EQ(files_in(folder.path()), std::set<std::string>{}) << "a partial file is left";
  }
}

TEST(Command, RefusesWhatItCannotWriteBeforeALongRun) {
  for (const std::string run :
       {"demo 2d --headless --frames 1000000 --record /proc/a.rec", "bench --json /proc/bench.json",
        "demo 3d --headless --frames 1000000 --trace /proc/t.json",
        "demo 2d --headless --frames 1000000 --json /proc/s.json"}) {
    const CommandResult refused = run_shell("timeout 20 " SOFTCELL_COMMAND " " + run);
    EXPECT_EQ(refused.status, 1) << run << ": " << refused.output;
    EXPECT_EQ(refused.output.rfind("softcell: cannot write /proc/", 0), 0u) << refused.output;
  }
}

TEST(Command, ReplacesTheRecordingThatItReplays) {
  const ScratchFolder folder;
  const std::string recording = folder / "run.rec";
  const std::string demo = "demo 2d --headless --quiet --frames 2 --size 32x32 --record " + recording;
  ASSERT_EQ(run_softcell(demo).status, 0);
  const CommandResult again = run_softcell(demo + " --replay " + recording);
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_EQ(files_in(folder.path()), std::set<std::string>{"run.rec"});
}

TEST(Command, SaysWhenTheDiskIsFullBeforeAVideosEnd) {
  const ScratchFolder folder;
  const auto on_small_disk = [&](const std::string& line) {
    return run_shell("unshare --map-root-user --mount sh -c 'mount -t tmpfs -o size=32k tmpfs " +
                     folder.path().string() + " && cd " + folder.path().string() + " && { " + line + "; }'");
  };
  if (on_small_disk("true").status != 0) GTEST_SKIP() << "here nobody may mount a disk";
  const CommandResult run = on_small_disk(SOFTCELL_COMMAND
                                          " demo 3d --headless --scene drop --size 640x360 --frames 60 "
                                          "--quiet --video v.mp4; echo status $?; ls -A");
  EXPECT_EQ(run.output.rfind("softcell: cannot write the video v.mp4: ffmpeg: ", 0), 0u) << run.output;
  EXPECT_TRUE(run.output.ends_with(" v.mp4: No space left on device\nstatus 1\n")) << run.output;
}

}  // namespace
}  // namespace softcell::tests
