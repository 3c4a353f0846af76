// The command as a user meets it: what it prints, and how it refuses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <regex>
#include <string>
#include <string_view>

#include "command_support.h"
#include "softcell/render/png_io.h"
#include "support/files_in.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "support/slow_build.h"

namespace softcell::tests {
namespace {

using test::files_in;

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
