// The command as a user meets it: what it prints, what it leaves, and how it refuses.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "bench/median.h"
#include "softcell/render/png_io.h"
#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"
#include "support/text_file.h"

namespace softcell::tests {
namespace {

using test::files_in;

constexpr const char* kDrop = "demo 3d --headless --scene drop --size 64x48 ";

nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(Command, LeavesNumberedFramesAndStatistics) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell(kDrop + std::string("--frames 3 --out ") + (folder / "out") +
                                         " --json " + (folder / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(files_in(folder / "out"),
            (std::set<std::string>{"frame_00000.png", "frame_00001.png", "frame_00002.png"}));
  const render::Image image = render::read_png(folder / "out/frame_00002.png");
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 48);

  const auto stats = read_json(folder / "s.json");
  for (const char* key : {"frames", "bodies", "particles", "vertices", "spes", "ppu_ms", "physics_ms",
                          "spe_busy", "dma_bytes", "dma_commands", "state_hash", "image_hash"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["frames"], 3);
  EXPECT_EQ(stats["spe_busy"].size(), 6u);
  for (const char* key : {"mean", "p50", "p99", "max"}) EXPECT_TRUE(stats["ppu_ms"].contains(key)) << key;
  EXPECT_EQ(stats["state_hash"].get<std::string>().size(), 16u);
  EXPECT_GT(stats["dma_bytes"].get<std::uint64_t>(), 0u);
}

TEST(Command, SkinsOnTheGpuFromTheParticlesAlone) {
  const ScratchFolder folder;
  const auto statistics_of = [&](const std::string& skin) {
    const std::string file = folder / (skin + ".json");
    const CommandResult run = run_softcell(kDrop + ("--frames 3 --skin " + skin) + " --json " + file);
    EXPECT_EQ(run.status, 0) << run.output;
    return read_json(file);
  };
  const auto spe = statistics_of("spe"), gpu = statistics_of("gpu");
  EXPECT_EQ(gpu["state_hash"], spe["state_hash"]);
  EXPECT_EQ(gpu["vertices"], spe["vertices"]);
  EXPECT_EQ(gpu["upload_bytes"], 16 * gpu["particles"].get<int>());
  EXPECT_GE(spe["upload_bytes"], 16 * spe["vertices"].get<int>());
  EXPECT_LT(gpu["spe_jobs"], spe["spe_jobs"]);
  EXPECT_LT(gpu["dma_bytes"], spe["dma_bytes"]);

  const CommandResult wrong = run_softcell(kDrop + std::string("--frames 1 --skin cpu"));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.output.find("--skin cpu: give spe or gpu"), std::string::npos) << wrong.output;
}

TEST(Command, TheLastPictureIsTheSameWithAndWithoutFiles) {
  const ScratchFolder folder;
  ASSERT_EQ(run_softcell(kDrop + std::string("--frames 4 --out ") + (folder / "out") + " --json " +
                         (folder / "a.json"))
                .status,
            0);
  ASSERT_EQ(run_softcell(kDrop + std::string("--frames 4 --json ") + (folder / "b.json")).status, 0);
  EXPECT_EQ(read_json(folder / "a.json")["image_hash"], read_json(folder / "b.json")["image_hash"]);
  EXPECT_EQ(read_json(folder / "a.json")["state_hash"], read_json(folder / "b.json")["state_hash"]);
}

/// Mesa keeps compiled shaders in a folder of the user's, which halves the time to the first picture.
TEST(Command, DrawsTheSameWithShadersFromTheCache) {
  const ScratchFolder folder;
  const auto image_hash = [&] {
    const CommandResult run =
        run_shell("MESA_SHADER_CACHE_DISABLE=false MESA_SHADER_CACHE_DIR=" + (folder / "cache") +
                  " " SOFTCELL_COMMAND " " + kDrop + "--frames 2 --json " + (folder / "s.json"));
    EXPECT_EQ(run.status, 0) << run.output;
    return read_json(folder / "s.json")["image_hash"].get<std::string>();
  };
  const std::string compiled = image_hash();
  ASSERT_TRUE(std::filesystem::exists(folder / "cache")) << "no shader was kept";
  EXPECT_EQ(image_hash(), compiled);
}

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

TEST(Command, DropsTheUsersOwnModel) {
  const ScratchFolder folder;
  write_file(folder / "cube.obj", kCube);
  const CommandResult run =
      run_softcell("demo 3d --headless --frames 2 --size 64x48 --mesh " + (folder / "cube.obj") +
                   " --cell 0.25 --json " + (folder / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(read_json(folder / "s.json")["scene"], "drop");
  EXPECT_EQ(read_json(folder / "s.json")["bodies"], 1);
}

TEST(Command, CountsCellsAlongTheUsersModelWhateverItsUnits) {
  const ScratchFolder folder;
  write_file(folder / "cube.obj", kCube);
  const auto particles = [&](const std::string& cells) {
    const CommandResult run = run_softcell("demo 3d --headless --frames 1 --size 64x48 --mesh " +
                                           (folder / "cube.obj") + cells + " --json " + (folder / "s.json"));
    EXPECT_EQ(run.status, 0) << run.output;
    return read_json(folder / "s.json")["particles"].get<int>();
  };
  EXPECT_EQ(particles(""), 9 * 9 * 9);
  EXPECT_EQ(particles(" --cells 4"), 5 * 5 * 5);
  EXPECT_EQ(particles(" --cell 0.2"), 6 * 6 * 6);
  write_file(folder / "own.toml",
             "[[soft_body]]\nname = \"without cell_size\"\nown_model_side = 2\nshape = { kind = \"box\" }\n");
  EXPECT_EQ(particles(" --cells 4 --scene " + (folder / "own.toml")), 5 * 5 * 5);
}

TEST(Command, TracesADemoAndMakesAPageOfIt) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell(kDrop + std::string("--frames 3 --spes 2 --trace ") +
                                         (folder / "t.json") + " --json " + (folder / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  const auto trace = read_json(folder / "t.json"), stats = read_json(folder / "s.json");
  std::size_t jobs = 0, commands = 0;
  std::uint64_t bytes = 0;
  for (const auto& event : trace["traceEvents"]) {
    const std::string category = event.value("cat", "");
    jobs += category == "job";
    commands += category == "dma";
    if (category == "dma") bytes += event["args"]["bytes"].get<std::uint64_t>();
  }
  EXPECT_GT(jobs, 0u);
  EXPECT_EQ(jobs, stats["spe_jobs"]);
  EXPECT_EQ(commands, stats["dma_commands"]);
  EXPECT_EQ(bytes, stats["dma_bytes"]);
  std::vector<std::string> images;
  for (const auto& image : trace["softcell"]["images"]) images.push_back(image["name"]);
  std::sort(images.begin(), images.end());
  EXPECT_EQ(images, (std::vector<std::string>{"match", "skin"}));

  const CommandResult report =
      run_softcell("report " + (folder / "t.json") + " --out " + (folder / "t.html"));
  EXPECT_EQ(report.status, 0) << report.output;
  EXPECT_NE(report.output.find(std::to_string(jobs) + " jobs"), std::string::npos) << report.output;
  EXPECT_GT(std::filesystem::file_size(folder / "t.html"), 20'000u);
}

TEST(Command, HelpOfAVerbIsWhatItsHelpOptionPrints) {
  for (const std::string verb : {"", "demo", "demo 3d", "spu run", "bench", "help"}) {
    const CommandResult help = run_softcell("help " + verb), option = run_softcell(verb + " --help");
    EXPECT_EQ(help.status, 0) << verb;
    EXPECT_EQ(help.output, option.output) << verb;
    EXPECT_NE(help.output.find("Usage: softcell"), std::string::npos) << help.output;
  }
}

TEST(Command, HelpNamesTheRangesOfNumbers) {
  const std::string of_3d = run_softcell("demo 3d --help").output,
                    of_2d = run_softcell("demo 2d --help").output;
  const auto joined = [](const std::string& text) {
    return std::regex_replace(text, std::regex("\\s+"), " ");
  };
  for (const char* range :
       {"longest side, 2 to 256", "many cells, 0.125 to 100", "video, 1 to 60", "pictures 1 to 8 times"})
    EXPECT_NE(joined(of_3d).find(range), std::string::npos) << of_3d;
  EXPECT_NE(joined(of_2d).find("painted, 2 to 256"), std::string::npos) << of_2d;
  EXPECT_NE(joined(run_softcell("spu run --help").output).find("0.001 to 86400"), std::string::npos);
}

TEST(Command, ListsItsScenes) {
  const CommandResult run = run_softcell("scenes");
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.output.find("arena "), std::string::npos);
  EXPECT_NE(run.output.find("drop "), std::string::npos);
  EXPECT_TRUE(std::regex_search(run.output, std::regex("\nman +2d ")));
}

TEST(Command, RunsTheUsersOwnScene) {
  const ScratchFolder folder;
  write_file(folder / "mine.lua",
             "return { soft_body = { { cell_size = 0.2, shape = { kind = 'sphere' } } } }");
  const CommandResult run = run_softcell("demo 3d --headless --frames 2 --size 64x48 --scene " +
                                         (folder / "mine.lua") + " --json " + (folder / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(read_json(folder / "s.json")["scene"], "mine");
}

TEST(Command, RunsAnEmptyScene) {
  const ScratchFolder folder;
  for (const std::string dimension : {"2", "3"}) {
    write_file(folder / "empty.toml", "dimension = " + dimension + "\n");
    const CommandResult run = run_softcell(
        "demo " + dimension + "d --headless --frames 2 --size 64x48 --scene " + (folder / "empty.toml"));
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("0 soft bodies and 0 rigid ones"), std::string::npos) << run.output;
    EXPECT_EQ(run.output.rfind("softcell: the scene empty has no bodies\n", 0), 0u) << run.output;
  }
}

TEST(Command, RefusesABadSceneInOneLineWithItsPlace) {
  const ScratchFolder folder;
  write_file(folder / "bad.toml", "[world]\ngravitty = 3\n");
  const CommandResult run = run_softcell("demo 3d --headless --scene " + (folder / "bad.toml"));
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.output, "softcell: " + (folder / "bad.toml") +
                            ":2:1: world has no field 'gravitty'; did you mean 'gravity'?\n");
}

/// What the command says about a scene that it refuses.
std::string refusal_of(const std::string& name, const std::string& text) {
  const ScratchFolder folder;
  write_file(folder / name, text);
  const CommandResult run = run_shell("cd " + folder.path().string() +
                                      " && " SOFTCELL_COMMAND " demo 3d --headless --scene ./" + name);
  EXPECT_EQ(run.status, 1) << run.output;
  return run.output;
}

TEST(Command, ControlCharactersOfAFileDoNotReachTheTerminal) {
  EXPECT_EQ(refusal_of("a.lua", "error('\\27[31mred\\127\\r\\u{9b}31m\\x9b \u00e9\\tt')"),
            "softcell: ./a.lua:1: \\x1b[31mred\\x7f\\x0d\\xc2\\x9b31m\\x9b \u00e9 t\n");
  const std::string title = "\\u001b]0;owned\\u0007", shown = "\\x1b]0;owned\\x07";
  EXPECT_NE(refusal_of("a.toml", "[[soft_body]]\nname = \"" + title + "\"\ncell_size = \"x\"\n").find(shown),
            std::string::npos);
  EXPECT_NE(refusal_of("b.toml", "\"" + title + "\" = 1\n").find(shown), std::string::npos);
}

TEST(Command, ALongSentenceLosesItsMiddle) {
  const std::string said = refusal_of(
      "a.toml", "[[soft_body]]\nname = \"" + std::string(600'000, 'n') + "\"\ncell_size = \"x\"\n");
  EXPECT_LT(said.size(), 2050u);
  EXPECT_EQ(said.rfind("softcell: ./a.toml:3:1: cell_size of soft body 1 ('nnn", 0), 0u) << said;
  EXPECT_NE(said.find("n ... n"), std::string::npos) << said;
  EXPECT_NE(said.find("n') is 'x'; it must be a number"), std::string::npos) << said;
}

TEST(Command, ThePpuStepsBodiesInTwoDimensionsThatNoLocalStoreHolds) {
  const ScratchFolder folder;
  const auto state_hash = [&](int cells, const std::string& options) {
    const std::string scene = folder / "body.toml", json = folder / "run.json", side = std::to_string(cells);
    write_file(scene,
               "dimension = 2\n[[soft_body]]\ncell_size = 0.05\nshape = { kind = \"rectangle\", width = " +
                   side + ", height = " + side + " }\n");
    const CommandResult run =
        run_softcell("demo 2d --headless --quiet --frames " + std::string(kSlowBuild ? "5" : "30") +
                     " --size 32x32 --scene " + scene + " --json " + json + options);
    EXPECT_EQ(run.status, 0) << run.output;
    return read_json(json).at("state_hash").get<std::string>();
  };
  // 1,369 and 1,521 particles. The solvers of SPEs and PPU differ in last bits.
  EXPECT_NE(state_hash(36, ""), state_hash(36, " --engine reference"));
  EXPECT_EQ(state_hash(38, ""), state_hash(38, " --engine reference"));
  EXPECT_EQ(state_hash(36, ""), state_hash(36, " --engine interpreter"));
}

TEST(Command, DrawsTheFiguresOverAPictureWhereItIsAsked) {
  const ScratchFolder folder;
  const std::string run = "demo 2d --headless --quiet --frames 1 --size 640x360 --out ";
  ASSERT_EQ(run_softcell(run + (folder / "plain")).status, 0);
  ASSERT_EQ(run_softcell(run + (folder / "figures") + " --statistics").status, 0);
  const render::Image plain = render::read_png(folder / "plain/frame_00000.png");
  const render::Image figures = render::read_png(folder / "figures/frame_00000.png");
  ASSERT_EQ(plain.rgba.size(), figures.rgba.size());
  // They stand in the upper left corner, and are as wide as their text: some hundred pixels.
  const auto same_rows = [&](int top, int bottom) {
    return std::equal(plain.pixel(0, top), plain.pixel(0, bottom), figures.pixel(0, top));
  };
  EXPECT_FALSE(same_rows(20, 160));
  EXPECT_TRUE(same_rows(200, 359));
  EXPECT_NE(0, std::memcmp(plain.pixel(150, 100), figures.pixel(150, 100), 4)) << "the box is whole";
}

TEST(Command, RefusesAReplayOfAnotherVersionOrSceneInOneSentence) {
  const ScratchFolder folder;
  const auto scene = [&](const char* gravity) {
    write_file(folder / "mine.toml", "dimension = 2\n[world]\ngravity = " + std::string(gravity) +
                                         "\n[framework]\n[[soft_body]]\ncell_size = 0.4\nrows = [\"##\"]\n");
    return "--scene " + (folder / "mine.toml");
  };
  const std::string demo = "demo 2d --headless --quiet --size 32x32 ", recording = folder / "run.rec";
  const auto refusal = [&](const std::string& arguments) {
    const CommandResult run = run_softcell(arguments);
    EXPECT_EQ(run.status, 1) << arguments;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    return run.output;
  };
  ASSERT_EQ(run_softcell(demo + scene("3") + " --frames 2 --record " + recording).status, 0);
  ASSERT_EQ(run_softcell(demo + scene("3") + " --replay " + recording).status, 0);
  const std::string begin = "softcell: " + recording + ": ";
  EXPECT_EQ(refusal(demo + scene("4") + " --replay " + recording),
            begin +
                "a recording of another version of the scene mine; give the one that was recorded with "
                "--scene\n");
  EXPECT_EQ(refusal(demo + "--scene man --replay " + recording),
            begin +
                "a recording of the scene mine, and this is man; give the one that was recorded with "
                "--scene\n");
  EXPECT_EQ(
      refusal(demo + "--replay " + recording),
      begin +
          "a recording of the scene mine, which does not come with softcell; give its file with --scene\n");
  EXPECT_EQ(
      refusal(demo + scene("3") + " --contacts spheres --replay " + recording),
      begin +
          "a recording in which bodies touch with --contacts surface, and here they touch with spheres; "
          "give --contacts surface\n");
  EXPECT_EQ(refusal("demo 3d --headless --replay " + recording),
            begin + "line 2: this is a recording of demo 2d, and this is demo 3d\n");
  write_file(recording, "softcell recording 2\ndimension 2\n");
  EXPECT_EQ(refusal(demo + "--replay " + recording),
            begin +
                "line 1: a recording of another version, 'softcell recording 2'; this softcell reads "
                "'softcell recording 1'\n");
}

TEST(Command, DoesNotPutAModelIntoASceneWithoutAPlaceForIt) {
  const ScratchFolder folder;
  write_file(folder / "cube.obj", kCube);
  const CommandResult run =
      run_softcell("demo 3d --headless --scene arena --mesh " + (folder / "cube.obj") + " --cell 0.25");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.output.find("--mesh cannot be used with scene arena"), std::string::npos) << run.output;
}

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

/// A row of docs/notes/ps3.md by its cells.
std::vector<std::string> row_of_scene(const std::string& scene, const std::string& contacts) {
  std::istringstream page(test::text_of(SOFTCELL_PS3_PAGE));
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `" + scene + "` | " + contacts + " |")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(2));
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    return cells;
  }
  ADD_FAILURE() << "docs/notes/ps3.md has no row of " << scene;
  return std::vector<std::string>(11);
}

/// The figures are the same in every run and on every host.
TEST(Command, SaysWhatTheWorkOfTheSpesTakesOnAPs3) {
  if (kSlowBuild)
    GTEST_SKIP() << "a sanitizer takes a minute for it; SpeRuntime.CountsTheCyclesOfAPs3 runs there";
  const ScratchFolder folder;
  for (const auto& [scene, dimension, contacts] :
       {std::tuple{"cell", "3d", "surface"}, std::tuple{"two_way", "2d", "surface"}}) {
    const std::string json = folder / "run.json";
    const CommandResult run =
        run_softcell(std::string("demo ") + dimension + " --scene " + scene +
                     " --headless --frames 120 --size 64x64 --engine interpreter --json " + json);
    ASSERT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("\non a PS3:  0.0"), std::string::npos) << run.output;
    const auto on_ps3 = read_json(json).at("on_ps3");
    const std::vector<std::string> row = row_of_scene(scene, contacts);
    EXPECT_NEAR(std::stod(row.at(5)), on_ps3["ms"]["mean"].get<double>(), 0.0051) << scene;
    EXPECT_NEAR(std::stod(row.at(6)), on_ps3["ms"]["p99"].get<double>(), 0.0051) << scene;
    EXPECT_NEAR(std::stod(row.at(8)), 100 * on_ps3["busy"].get<double>(), 0.51) << scene;
    EXPECT_NEAR(std::stod(row.at(9)), 100 * on_ps3["waits"].get<double>(), 0.51) << scene;
    double jobs = 0;
    for (const auto& kernel : on_ps3["kernels"]) jobs += kernel["ms"].get<double>();
    EXPECT_NEAR(jobs / (6 * on_ps3["ms"]["mean"].get<double>()), on_ps3["busy"].get<double>(), 0.1) << scene;
  }
  // A trace then has the clocks of the SPEs.
  const std::string trace = folder / "run.trace";
  ASSERT_EQ(
      run_softcell(
          "demo 2d --scene two_way --headless --frames 2 --size 64x64 --engine interpreter --trace " + trace)
          .status,
      0);
  EXPECT_NE(test::text_of(trace).find("simulated clocks of the SPEs"), std::string::npos);
  ASSERT_EQ(run_softcell("demo 2d --scene two_way --headless --frames 2 --size 64x64 --json " +
                         (folder / "native.json"))
                .status,
            0);
  EXPECT_FALSE(read_json(folder / "native.json").contains("on_ps3"));
}

TEST(Command, PrintsTheBudgetOfEveryKernel) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell("spu budget --json " + (folder / "b.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  const auto table = read_json(folder / "b.json");
  ASSERT_FALSE(table.empty());
  // Cycles for a piece of work, as spu_kernels/spu_elf has the kernels now, and a fiftieth. They are the same on every host: what is
  // above has become slower.
  const std::map<std::string, double> most_cycles{
      {"attach", 673}, {"contact_find", 910'000}, {"contact_solve", 14'330}, {"job_loop", 520},
      {"match", 908},  {"match_2d", 507},         {"match_tiles", 1'796},    {"rotations", 8'442},
      {"skin", 42},    {"strain", 118},           {"transfers", 179}};
  bool has_skin = false;
  for (const auto& row : table) {
    for (const char* key :
         {"kernel", "text", "rodata", "data", "bss", "stack", "stack_used", "total", "budget"}) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
    EXPECT_LE(row["total"], row["budget"]) << row["kernel"];
    EXPECT_LE(row["stack_used"], row["stack"]) << row["kernel"];
    EXPECT_GT(row["stack_used"], 0) << row["kernel"];
    const auto& spu = row["spu"];
    EXPECT_EQ(spu["budget"], row["budget"]) << row["kernel"];
    EXPECT_LE(spu["total"], spu["budget"]) << row["kernel"];
    EXPECT_LE(spu["stack_used"], spu["stack"]) << row["kernel"];
    EXPECT_GT(spu["stack_used"], 0) << row["kernel"];
    EXPECT_GT(spu["text"], 0) << row["kernel"];
    const auto limit = most_cycles.find(row["kernel"]);
    ASSERT_NE(limit, most_cycles.end()) << row["kernel"] << " has no limit of cycles: " << spu;
    EXPECT_LE(spu["cycles"], limit->second) << row["kernel"];
    double by_function = 0;
    for (const auto& function : spu["functions"]) by_function += function["cycles"].get<double>();
    EXPECT_NEAR(by_function / spu["pieces"].get<double>(), spu["cycles"].get<double>(), 1) << row["kernel"];
    if (row["kernel"] != "skin") continue;
    has_skin = true;
    EXPECT_LE(row["total"], 96 * 1024);
  }
  EXPECT_TRUE(has_skin);
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

TEST(Command, SavesASceneThatBeginsWithWhatThereIs) {
  const ScratchFolder folder;
  const auto run = [&](const std::string& arguments) {
    return run_shell("cd " + folder.path().string() +
                     " && timeout 60 " SOFTCELL_COMMAND " demo 3d --headless --size 32x32 --quiet " +
                     arguments);
  };
  EXPECT_EQ(run("--scene drop --frames 30 --save-scene s.toml").status, 0);
  EXPECT_EQ(files_in(folder.path()), (std::set<std::string>{"s.toml", "s.state"}));
  const CommandResult again = run("--scene s.toml --frames 1 --json -");
  EXPECT_EQ(again.status, 0) << again.output;
  const auto before = files_in(folder.path());
  const auto refusal = [&](const std::string& arguments, int status) {
    const CommandResult refused = run(arguments);
    EXPECT_EQ(refused.status, status) << arguments << ": " << refused.output;
    EXPECT_EQ(files_in(folder.path()), before) << arguments;
    return refused.output;
  };
  EXPECT_NE(refusal("--frames 1 --save-scene s.lua", 2).find("give a file name that ends in .toml"),
            std::string::npos);
  EXPECT_NE(
      refusal("--frames 1 --save-scene s.state", 2).find("--save-scene s.state: give a file name that ends"),
      std::string::npos);
  EXPECT_NE(refusal("--frames 1 --save-scene $(printf 'x\\377.toml')", 2)
                .find("--save-scene x\\xff.toml: give a file name in UTF-8"),
            std::string::npos);
  EXPECT_NE(refusal("--frames 1 --save-scene -", 2).find("cannot write to standard output"),
            std::string::npos);
  EXPECT_NE(refusal("--frames 1 --scene s.toml --save-scene s.toml", 2).find("and --save-scene are one file"),
            std::string::npos);
  EXPECT_NE(refusal("--frames 1 --save-scene x.toml --json x.state", 2).find("the state of --save-scene"),
            std::string::npos);
  EXPECT_NE(refusal("--frames 1000 --save-scene none/x.toml", 1).find("none/x.toml"), std::string::npos);
  EXPECT_NE(refusal("--ui-scale 2", 2).find("--ui-scale is for text and menus in a window"),
            std::string::npos);
  EXPECT_NE(refusal("--ui-scale 9", 2).find("--ui-scale 9: give a number from 0.5 to 4"), std::string::npos);
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

TEST(Command, PrintsItsSummaryInColumns) {
  const ScratchFolder folder;
  const CommandResult run =
      run_softcell("demo 2d --headless --frames 3 --size 32x32 --record " + (folder / "r.rec"));
  EXPECT_NE(run.output.find("\nrecording: " + (folder / "r.rec") + "\n"), std::string::npos) << run.output;
  EXPECT_NE(run.output.find("\na picture: "), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("pictures 0"), std::string::npos) << run.output;
  std::istringstream lines(run.output);
  std::string line;
  for (std::getline(lines, line); std::getline(lines, line);) {
    ASSERT_GT(line.size(), 11u) << run.output;
    EXPECT_EQ(line[10], ' ') << line;
    EXPECT_NE(line[11], ' ') << line;
  }
}

// 41 x 41 particles fit no local store; 9 do.
TEST(Command, TheSummarySaysWhoSteppedTheBodies) {
  const ScratchFolder folder;
  std::string rows;
  for (int i = 0; i < 40; ++i) rows += "'" + std::string(40, '#') + "',";
  write_file(folder / "large.lua", "return { rows = { " + rows + " } }");
  write_file(folder / "small.lua", "return { rows = { '##', '##' } }");
  write_file(folder / "both.toml",
             "dimension = 2\n[[soft_body]]\ncell_size = 0.05\nlattice = \"large.lua\"\n"
             "[[soft_body]]\ncell_size = 0.05\nlattice = \"small.lua\"\nposition = [3, 0]\n");
  const auto who = [&](const std::string& options) {
    const CommandResult run = run_softcell("demo 2d --headless --frames 1 --size 32x32 --json " +
                                           (folder / "f.json") + " " + options);
    EXPECT_EQ(run.status, 0) << run.output;
    const std::size_t line = run.output.find("stepped:   ");
    return run.output.substr(line, run.output.find('\n', line) - line);
  };
  const std::string both = "--scene " + (folder / "both.toml");
  EXPECT_EQ(who(both), "stepped:   1 by the SPEs, 1 by the PPU because it does not fit a local store");
  EXPECT_EQ(read_json(folder / "f.json")["bodies_on_ppu"], 1);
  EXPECT_EQ(who(both + " --checked"),
            "stepped:   1 by the SPEs, 1 by the PPU because it does not fit a local store, where checked "
            "kernels have less room");
  EXPECT_EQ(who(both + " --engine reference"), "stepped:   by the PPU, as --engine reference asks");
  EXPECT_EQ(who(""), "stepped:   by the SPEs");
  EXPECT_EQ(read_json(folder / "f.json")["bodies_on_ppu"], 0);
}

TEST(Command, TheSummaryBeginsWithWhatBinds) {
  const ScratchFolder folder;
  const CommandResult run = run_softcell(kDrop + std::string("--frames 2 --json ") + (folder / "s.json"));
  ASSERT_EQ(run.status, 0) << run.output;
  std::smatch first;
  ASSERT_TRUE(std::regex_search(
      run.output, first,
      std::regex("^[0-9.]+ frames a second; (contacts and rigid bodies|shape matching|skinning|copying "
                 "particles) ([0-9]+) %\n")))
      << run.output;
  const auto shares = read_json(folder / "s.json")["time_shares"];
  double most = 0, sum = 0;
  for (const auto& share : shares) {
    most = std::max(most, share.get<double>());
    sum += share.get<double>();
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_NEAR(std::stod(first[2]), 100 * most, 0.51);
  EXPECT_EQ(shares["pictures"], 0) << "only one at the end";
  const CommandResult film = run_softcell(kDrop + std::string("--frames 3 --out ") + (folder / "out"));
  EXPECT_NE(film.output.find("frames a second; pictures "), std::string::npos) << film.output;
  EXPECT_NE(film.output.find(" frames a second without pictures\n"), std::string::npos) << film.output;
}

TEST(Command, CountsOneInTheSingular) {
  const ScratchFolder folder;
  write_file(
      folder / "one.toml",
      "dimension = 2\n[[soft_body]]\ncell_size = 0.5\nrows = [\"#\"]\n[[circle]]\nradius = 0.3\nmass = 1\n"
      "position = [3, 0]\n");
  const CommandResult one =
      run_softcell("demo 2d --headless --frames 1 --size 32x32 --scene " + (folder / "one.toml"));
  EXPECT_NE(
      one.output.find("\nscene:     one: 1 frame, 1 soft body and 1 rigid one, 4 particles, 4 vertices\n"),
      std::string::npos)
      << one.output;
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

TEST(Command, SaysWhenWhatItPrintsIsLost) {
  for (const char* verb : {"scenes", "man", "spu budget", "bench --list", "completion bash", "--help"}) {
    const CommandResult run = run_shell(std::string(SOFTCELL_COMMAND) + " " + verb + " 2>&1 >/dev/full");
    EXPECT_EQ(run.status, 1) << verb;
    EXPECT_EQ(run.output, "softcell: cannot write standard output: No space left on device\n") << verb;
  }
}

struct Refusal {
  const char* arguments;  ///< %s is a scratch folder with cube.obj and some broken files
  int status;
  const char* part;  ///< of the one line that is printed
};

void PrintTo(const Refusal& r, std::ostream* out) { *out << r.arguments; }

class CommandRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(CommandRefuses, WithOneSentenceAndItsStatus) {
  const std::string_view wanted = GetParam().arguments;
  if (kSlowBuild && (wanted.ends_with("--cell 0.005") || wanted.ends_with("--cells 200")))
    GTEST_SKIP() << "it takes half a minute with sanitizers, which run it with --cell 0.01";
  const ScratchFolder folder;
  write_file(folder / "cube.obj", kCube);
  write_file(folder / "empty.obj", "");
  write_file(folder / "truncated.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n");
  write_file(folder / "nan.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n");
  write_file(folder / "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  write_file(folder / "file", "not a folder");
  render::Image picture(4, 4);
  render::write_png(folder / "clear.png", picture);
  std::fill(picture.rgba.begin(), picture.rgba.end(), std::uint8_t{255});
  render::write_png(folder / "cat.png", picture);
  std::string arguments = GetParam().arguments;
  for (std::size_t at; (at = arguments.find("%s")) != std::string::npos;)
    arguments.replace(at, 2, folder.path().string());
  const auto before = files_in(folder.path());

  const CommandResult run = run_softcell(arguments);
  EXPECT_EQ(run.status, GetParam().status) << run.output;
  EXPECT_NE(run.output.find(GetParam().part), std::string::npos) << run.output;
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  EXPECT_EQ(run.output.rfind("softcell: ", 0), 0u) << run.output;
  EXPECT_EQ(files_in(folder.path()), before) << "nothing half written is left";
}

#define SC_DEMO "demo 3d --headless --frames 1 --size 32x32 "

INSTANTIATE_TEST_SUITE_P(
    WrongUsage, CommandRefuses,
    testing::Values(
        Refusal{"", 2, "say what to do: demo 2d, demo 3d, spu run"},
        Refusal{"demo", 2, "say what to do: demo 2d, demo 3d ("},
        Refusal{"spu", 2,
                "say what to do: spu run, spu explore, spu timing, spu disasm, spu debug, spu budget ("},
        Refusal{"dance", 2, "softcell has no command 'dance'; there are: demo, spu, run, scenes,"},
        Refusal{"dmeo", 2, "softcell has no command 'dmeo'; did you mean demo? ("},
        Refusal{"spu bugdet", 2, "softcell spu has no command 'bugdet'; did you mean budget? ("},
        Refusal{"help spu rnu", 2, "softcell spu has no command 'rnu'; did you mean run? ("},
        Refusal{"help bench x", 2, "softcell bench has no commands below it, and no 'x' ("},
        Refusal{"help dance", 2, "softcell has no command 'dance'; there are: demo, "},
        Refusal{SC_DEMO "--json - --trace -", 2, "--trace and --json are one file, -;"},
        Refusal{SC_DEMO "--record -", 2, "--record -: it cannot write to standard output"},
        Refusal{SC_DEMO "--out -", 2, "--out -: it cannot write to standard output"},
        Refusal{"spu run saxpy --inout x=-", 2, "a buffer is filled from a file, not from standard input"},
        Refusal{"bench --list --compare %s/file", 2, "--list measures nothing that --compare"},
        Refusal{"demo 4d", 2, "softcell demo has no command '4d'; there are: 2d, 3d ("},
        Refusal{"demo 3d 2d", 2, "the argument '2d' is one too many"},
        Refusal{"scenes x", 2, "'x' is one too many: softcell scenes takes nothing but options"},
        Refusal{"spu run a b", 2, "'b' is one too many: softcell spu run takes IMAGE and options"},
        Refusal{SC_DEMO "--bogus", 2, "softcell demo 3d has no option --bogus ("},
        Refusal{SC_DEMO "-x", 2, "softcell demo 3d has no option -x ("},
        Refusal{"demo 3d --fram 3", 2, "has no option --fram; did you mean --frames?"},
        Refusal{"report --outt a b", 2, "has no option --outt; did you mean --out?"},
        Refusal{"demo 3d --frames 3 --frames 4", 2, "--frames is given 2 times; give it once"},
        Refusal{"demo 3d --frames 3 --frames 4 --headless", 2, "--frames is given 2 times; give it once"},
        Refusal{"demo 3d --frames", 2, "--frames needs a value: FRAMES"},
        Refusal{"demo 3d --headless --frames", 2, "--frames needs a value: FRAMES"},
        Refusal{"demo 3d --headless --quiet --frames 1 --scene", 2, "--scene needs a value: SCENE"},
        Refusal{"demo 3d -headless --json %s/x", 2,
                "softcell demo 3d has no option -headless; did you mean --headless?"},
        Refusal{"demo 3d -hx", 2, "softcell demo 3d has no option -hx ("},
        Refusal{"-help", 2, "softcell has no option -help; did you mean --help?"},
        Refusal{SC_DEMO "-frames", 2, "has no option -frames; did you mean --frames?"},
        Refusal{"spu budget --jsn", 2, "(softcell spu budget --help lists what is allowed)"},
        Refusal{"demo 2d --size 0x0", 2, "(softcell demo 2d --help lists what is allowed)"},
        Refusal{SC_DEMO "--spes 7", 2, "1"}, Refusal{SC_DEMO "--spes 0", 2, "6"},
        Refusal{SC_DEMO "--spes two", 2, "--spes"},
        Refusal{"demo 3d --headless --size 0x0", 2, "WIDTHxHEIGHT"},
        Refusal{"demo 3d --headless --size 99999x20", 2, "8192"},
        Refusal{"demo 3d --headless --size big", 2, "WIDTHxHEIGHT"},
        Refusal{SC_DEMO "--dma sometimes", 2, "random:SEED"},
        Refusal{SC_DEMO "--dma random:", 2, "random:SEED"},
        Refusal{SC_DEMO "--dma random:x", 2, "random:SEED"},
        Refusal{"demo 3d --headless --size ''", 2, "--size needs a value: WIDTHxHEIGHT"},
        Refusal{SC_DEMO "--engine ''", 2, "--engine needs a value: native|interpreter|reference"},
        Refusal{SC_DEMO "--skin ''", 2, "--skin needs a value: spe|gpu"},
        Refusal{SC_DEMO "--view ''", 2, "--view needs a value: mesh|lattice"},
        Refusal{SC_DEMO "--json ''", 2, "--json needs a value: FILE"},
        Refusal{"demo 2d --headless --frames 1e3", 2,
                "--frames 1e3: give a whole number from 1 to 1000000 ("},
        Refusal{"demo 2d --headless --frames 1.5", 2,
                "--frames 1.5: give a whole number from 1 to 1000000 ("},
        Refusal{"demo 2d --headless --frames nan", 2, "--frames nan: give a whole number"},
        Refusal{"demo 2d --headless --frames 1000001", 2, "--frames 1000001: give a whole number"},
        Refusal{"demo 2d --headless --frames 010", 2, "--frames 010: give a whole number"},
        Refusal{"spu explore --seeds 1e3 saxpy", 2,
                "--seeds 1e3: give a whole number from 1 to 1000000000 ("},
        Refusal{"spu run --spes 1.5 saxpy", 2, "--spes 1.5: give a whole number from 1 to 6 ("},
        Refusal{"bench --rounds 2k", 2, "--rounds 2k: give a whole number from 1 to 100000 ("},
        Refusal{"demo 3d --headless --frames -3", 2, "--frames"},
        Refusal{"demo 3d --headless --frames 0", 2, "--frames"},
        Refusal{"demo 3d --frames 1 --out %s/f", 2, "--headless"},
        Refusal{SC_DEMO "--video %s/v.avi", 2,
                "v.avi: give a file name that ends in .mp4, .webm, .gif or .apng"},
        Refusal{SC_DEMO "--video %s/v.gif --fps 60", 2, "--fps 60: .gif shows at most 50 frames a second"},
        Refusal{SC_DEMO "--video %s/v.mp4 --fps 61", 2, "--fps 61: give a whole number from 1 to 60"},
        Refusal{SC_DEMO "--fps 30", 2, "--video"},
        Refusal{SC_DEMO "--supersample 9", 2, "--supersample 9: give a whole number from 1 to 8"},
        Refusal{"demo 3d --headless --supersample 4 --size 8192x16", 2, "more than 16384 pixels a side"},
        Refusal{"demo 2d --supersample 2", 2, "--headless"},
        Refusal{"demo 2d --headless --cells 4", 2, "--image"},
        Refusal{"demo 2d --headless --scene man --image %s/cat.png", 2, "it has no body with own_image_side"},
        Refusal{SC_DEMO "--video ''", 2, "--video needs a value"},
        Refusal{"demo 2d --statistics", 2, "--headless"},
        Refusal{"demo 2d --headless --statistics", 2,
                "--statistics shows in pictures only: give --out or --video too"},
        Refusal{"demo 3d --headless --turntable 6", 2,
                "--turntable shows in pictures only: give --out or --video too"},
        Refusal{"demo 2d --headless --replay %s/cube.obj", 1, "line 1"},
        Refusal{SC_DEMO "--scene arena --mesh %s/cube.obj", 2, "--mesh"},
        Refusal{SC_DEMO "--cell 0.1", 2, "--mesh"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell wide", 2, "--cell"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0.2 --cells 4", 2, "--cells"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0", 2, "--cell 0: give a length above 0"},
        Refusal{SC_DEMO "--unit 0.01", 2, "--mesh"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --unit 0", 2, "--unit 0: give what one of the model's units is"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --unit -1", 2, "--unit -1: give what"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --unit nan", 2, "--unit nan: give what"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --unit 1e-6", 1, "--unit 1e-06: a lattice cell would be"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --unit 1e9", 1,
                "--unit 1000000000: the model would be 1e+09 m long"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell -1", 2, "--cell -1: give a length"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell nan", 2, "--cell nan: give a length"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell inf", 2, "--cell inf: give a length"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cells 1", 2, "256"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --tessellate 0", 2, "--tessellate 0: give a number of cells"},
        Refusal{SC_DEMO "--tessellate 1", 2, "--tessellate"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --up x", 2, "--up x: give y or z"},
        Refusal{SC_DEMO "--up z", 2, "--up"}, Refusal{"report", 2, "softcell report needs TRACE"},
        Refusal{"report %s/file", 2, "--out"}, Refusal{"bench --filter [", 2, "regular expression"},
        Refusal{"bench --rounds 0", 2, "--rounds"},
        Refusal{"bench --list --json %s/l.json", 2, "--list measures nothing"},
        Refusal{"bench --filter nothing-is-called-so", 2, "--list"}));

INSTANTIATE_TEST_SUITE_P(
    BadInput, CommandRefuses,
    testing::Values(
        Refusal{SC_DEMO "--scene nowhere", 1, "there are: arena, "},
        Refusal{SC_DEMO "--scene jelies", 1, "unknown scene 'jelies'; did you mean 'jellies'?"},
        Refusal{SC_DEMO "--scene %s/file", 1, "/file' is no scene: a scene file ends in .toml or .lua"},
        Refusal{SC_DEMO "--scene x.txt", 1, "'x.txt' is no scene: a scene file ends in .toml or .lua"},
        Refusal{"bench --compare %s/file", 1, "file holds no figures of `softcell bench --json`"},
        Refusal{"bench --compare %s/none", 1, "none"},
        Refusal{"spu budget nowhere.spu.elf", 1,
                "there is no file nowhere.spu.elf, and no kernel of softcell"},
        Refusal{"spu budget %s/cube.obj", 1,
                "cube.obj is not an ELF file; a kernel is the file NAME.spu.elf"},
        Refusal{"spu timing skin --static", 1, "or --engine interpreter for softcell's own build"},
        Refusal{"spu budget --checked job_loop", 1, "has no checked image"},
        Refusal{"report /dev/zero --out %s/r.html", 1, "/dev/zero: it is not a regular file"},
        Refusal{"demo 2d --headless --image %s/none.png", 1, "none.png"},
        Refusal{"demo 2d --headless --image /dev/zero", 1, "/dev/zero: it is not a regular file"},
        Refusal{"demo 2d --headless --image %s/cube.obj", 1, "cube.obj"},
        Refusal{"demo 2d --headless --image %s/clear.png", 1, "the picture is transparent"},
        Refusal{SC_DEMO "--mesh %s/none.obj", 1, "none.obj"}, Refusal{SC_DEMO "--mesh %s", 1, "softcell_"},
        Refusal{SC_DEMO "--mesh %s/empty.obj", 1, "empty.obj"},
        Refusal{SC_DEMO "--mesh %s/truncated.ply", 1, "truncated.ply"},
        Refusal{SC_DEMO "--mesh %s/nan.obj", 1, "nan.obj"},
        Refusal{SC_DEMO "--mesh %s/range.obj", 1, "range.obj"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 3", 1, "--cell 3: one cell would hold"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 1e-9", 1, "give 0.00391 or more"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0.001", 1, "--cell 0.001: the model is 1 long"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0.005", 1, "--cell 0.005: the lattice would have"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cells 200", 1,
                "--cells 200: the lattice would have more than 300000 particles; 55 are few enough"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0.01", 1, "--cell 0.01: the lattice would have"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --cell 0.9999", 1, "--cell 0.9999: one cell would hold"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --out %s/file", 1, "file"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --out /proc/frames", 1, "/proc/frames"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --trace /proc/t.json", 1, "/proc/t.json"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --json /dev/full", 1, "No space left"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --json /proc/stats.json", 1, "/proc/stats.json"},
        Refusal{SC_DEMO "--mesh %s/cube.obj --video /proc/v.mp4", 1, "/proc/v.mp4"}));

}  // namespace
}  // namespace softcell::tests
