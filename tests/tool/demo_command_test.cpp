// What `softcell demo` draws, prints and leaves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "command_support.h"
#include "softcell/render/png_io.h"
#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"
#include "support/text_file.h"

namespace softcell::tests {
namespace {

using test::files_in;

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

}  // namespace
}  // namespace softcell::tests
