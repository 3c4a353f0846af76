// The manual page and the shell completions: made of the parser's own description, so that no option is
// missing.

#include "command_line/command_tree.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "command_line/help_texts.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"
#include "verb/progress_bar.h"

namespace softcell::tests {
namespace {

using namespace tool;

CommandVerb small_tree() {
  CommandOption help{{"-h", "--help"}, "", "Print help"};
  CommandOption clock{{"--clock"}, "host|random:SEED", "What time is"};
  CommandOption image{{"IMAGE"}, "FILE", "A kernel", true, true};
  return {"softcell",
          "Runs kernels",
          {help},
          {{"spu", "Kernels", {help}, {{"run", "Run one", {help, clock, image}, {}}}},
           {"scenes", ".hidden \\ text", {help}, {}}}};
}

TEST(CommandTree, LeavesAreTheVerbsThatDoSomething) {
  const CommandVerb top = small_tree();
  const auto leaves = leaves_of(top);
  ASSERT_EQ(leaves.size(), 2u);
  EXPECT_EQ(leaves[0].path, "spu run");
  EXPECT_EQ(leaves[1].path, "scenes");
  EXPECT_EQ(leaves[0].verb->description, "Run one");
}

TEST(CommandTree, ChoicesAreTheWordsOfAValue) {
  const CommandVerb top = small_tree();
  const auto& options = top.verbs[0].verbs[0].options;
  EXPECT_EQ(choices_of(options[1]), (std::vector<std::string>{"host", "random:"}));
  EXPECT_TRUE(choices_of(options[0]).empty());
  EXPECT_TRUE(choices_of(options[2]).empty());
}

TEST(ManualPage, TextIsNeverTakenForMacros) {
  const std::string page = manual_page(small_tree(), "1.2");
  EXPECT_NE(page.find("\\&.hidden \\e text."), std::string::npos) << page;
  EXPECT_NE(page.find("\\fB\\-\\-clock\\fR \\fIhost|random:SEED\\fR"), std::string::npos) << page;
  EXPECT_NE(page.find("softcell 1.2"), std::string::npos);
}

/// Every `--option` that the help of a verb prints.
std::vector<std::string> options_in_help(const std::string& verb) {
  const std::string help = run_softcell(verb + " --help").output;
  static const std::regex option("--[a-z-]+");
  std::vector<std::string> names;
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at)
    names.push_back(at->str());
  return names;
}

std::string without_escapes(std::string text) {
  static const std::regex escape(R"(\\f[BIR]|\\(?=-))");
  return std::regex_replace(text, escape, "");
}

/// All verbs that do something, as the help names them: "spu run".
std::set<std::string> verbs_in_help(const std::string& verb = {}) {
  const std::string help = run_softcell(verb + " --help").output;
  const std::size_t begin = help.find("\nSubcommands:\n");
  if (begin == std::string::npos) return {verb};
  static const std::regex line("\n  ([a-z0-9]+) ");
  std::set<std::string> verbs;
  for (std::sregex_iterator at(help.begin() + static_cast<std::ptrdiff_t>(begin), help.end(), line), end;
       at != end; ++at)
    verbs.merge(verbs_in_help((verb.empty() ? "" : verb + " ") + at->str(1)));
  return verbs;
}

/// The sections of a manual page's commands, by their verbs.
std::map<std::string, std::string> sections_of(const std::string& page) {
  static const std::regex heading("\n\\.S[SH] (softcell )?([^\n]*)");
  std::map<std::string, std::string> sections;
  std::string* section = nullptr;
  std::size_t begin = 0;
  const auto add_up_to = [&](std::size_t end) {
    if (section != nullptr) *section = page.substr(begin, end - begin);
  };
  for (std::sregex_iterator at(page.begin(), page.end(), heading), end; at != end; ++at) {
    add_up_to(static_cast<std::size_t>(at->position()));
    begin = static_cast<std::size_t>(at->position() + at->length());
    section = (*at)[1].matched ? &sections[at->str(2)] : nullptr;
  }
  add_up_to(page.size());
  return sections;
}

TEST(ManualPage, OfTheCommandNamesEveryOptionOfEveryVerb) {
  const std::map<std::string, std::string> sections =
      sections_of(without_escapes(run_softcell("man").output));
  std::set<std::string> verbs;
  for (const auto& [verb, section] : sections) {
    verbs.insert(verb);
    const std::vector<std::string> options = options_in_help(verb);
    ASSERT_FALSE(options.empty()) << "softcell " << verb << " --help names not even --help";
    for (const std::string& option : options)
      EXPECT_TRUE(std::regex_search(section, std::regex(option + "(?![a-z-])"))) << verb << " " << option;
  }
  EXPECT_EQ(verbs, verbs_in_help());
  EXPECT_TRUE(verbs.contains("spu run"));
}

TEST(ManualPage, SaysWhatMayBeLeftOutAndWhatMayBeRepeated) {
  const std::string page = without_escapes(run_softcell("man").output);
  for (const char* line :
       {"softcell spu run [options] IMAGE\n", "softcell spu budget [options] [KERNELS...]\n",
        "softcell help [options] [VERB...]\n", "softcell run [options] PROGRAM...\n", "--in NAME=FILE ...\n",
        "--arg WORD ...\n", "--trace FILE\n"})
    EXPECT_NE(page.find(line), std::string::npos) << line;
}

TEST(ManualPage, SaysWhichOptionsGoTogether) {
  const std::string page = without_escapes(run_softcell("man").output);
  EXPECT_NE(page.find("longest side, 2 to 256 (default: 8); needs --mesh; not with --cell.\n"),
            std::string::npos);
  EXPECT_NE(page.find("in place of --cells; needs --mesh; not with --cells.\n"), std::string::npos);
  EXPECT_NE(page.find("(with --headless); those of an earlier run in it are removed.\n"), std::string::npos);
}

/// What bash offers behind these words in the folder; the last one is begun and not yet whole.
/// @param script  the completion's, or what loads it
/// @param format  of an offer, for printf   @param then  what the offers go through
std::string offered(const ScratchFolder& folder, const std::string& script, const std::string& words,
                    const std::string& format = "%s ", const std::string& then = "") {
  std::ofstream(folder / "try.sh") << "PATH=$(dirname " << SOFTCELL_COMMAND << "):$PATH\n"
                                   << script << "\nCOMP_WORDS=(" << words << ")\n"
                                   << "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_softcell\n"
                                   << "printf '" << format << "' \"${COMPREPLY[@]}\"\n";
  return run_shell("cd " + folder.path().string() + " && bash --norc try.sh" + then).output;
}

constexpr const char* kCommandsScript = "source <(softcell completion bash)";

std::string completed(const std::string& words) {
  return offered(ScratchFolder(), bash_completion(small_tree()), words);
}

TEST(BashCompletion, OffersVerbsOptionsAndValues) {
  EXPECT_EQ(completed("softcell s"), "spu scenes ");
  EXPECT_EQ(completed("softcell spu ''"), "run -h --help ");
  EXPECT_EQ(completed("softcell spu run --c"), "--clock ");
  EXPECT_EQ(completed("softcell spu run --clock h"), "host ");
  EXPECT_EQ(completed("softcell spu run --clock ra"), "random: ");
  EXPECT_EQ(completed("softcell spu run --clock host --"), "--help --clock ");
  EXPECT_EQ(completed("softcell spu run --clock = ra"), "random: ");
}

TEST(BashCompletion, OfTheCommandKnowsItsScenes) {
  EXPECT_EQ(offered(ScratchFolder(), kCommandsScript, "softcell demo 3d --headless --scene ar"), "arena ");
}

TEST(BashCompletion, KeepsNamesWithSpacesWhole) {
  const ScratchFolder folder;
  std::ofstream(folder / "my kernel.elf") << "";
  std::filesystem::create_directory(folder / "my folder");
  const auto sorted = [&](const std::string& words) {
    return offered(folder, kCommandsScript, "softcell " + words, "<%s>\\n", " | sort | tr -d '\\n'");
  };
  EXPECT_EQ(sorted("demo 3d --json my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("demo 3d --out my"), "<my folder>");
  EXPECT_EQ(sorted("demo 3d --scene my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("report my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("spu run my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("spu run --in x = m"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("run my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("run --checked -- my"), "<my folder><my kernel.elf>");
  EXPECT_EQ(sorted("spu run --host-calls --folder my"), "<my folder>");
}

TEST(BashCompletion, OfHelpKnowsTheVerbs) {
  const ScratchFolder folder;
  EXPECT_EQ(offered(folder, kCommandsScript, "softcell help de"), "demo ");
  EXPECT_EQ(offered(folder, kCommandsScript, "softcell help spu di"), "disasm ");
  EXPECT_EQ(offered(folder, kCommandsScript, "softcell hel"), "help ");
}

TEST(BashCompletion, OffersNothingThatIsRefused) {
  const ScratchFolder folder;
  std::ofstream(folder / "matches.txt") << "";
  std::ofstream(folder / "--scenes") << "";
  const auto offered_for = [&](const std::string& words) {
    return offered(folder, kCommandsScript, "softcell " + words);
  };
  EXPECT_EQ(offered_for("spu disasm match"), "matches.txt ")
      << "softcell's own kernels are built for the host";
  EXPECT_EQ(offered_for("help spu run match"), " ") << "help takes verbs only";
  EXPECT_EQ(offered_for("help demo 2d --he"), " ");
  EXPECT_EQ(offered_for("help --he"), "--help ");
  EXPECT_EQ(offered_for("run --ch"), "--checked ");
  EXPECT_EQ(offered_for("run -- ./p --ch"), " ") << "the program's own options are unknown";
  EXPECT_EQ(offered_for("run -- ./p --sc"), "--scenes ");
  EXPECT_EQ(offered_for("run -- ./p --dma ea"), " ");
}

TEST(BashCompletion, OfTheCommandKnowsItsKernels) {
  const ScratchFolder folder;
  std::ofstream(folder / "matches.txt") << "";
  EXPECT_EQ(offered(folder, kCommandsScript, "softcell spu run match"),
            "match match_2d match_tiles matches.txt ");
}

/// What fish offers for a line. Skips the test where there is no fish.
std::string offered_by_fish(const ScratchFolder& folder, const std::string& script, const std::string& line) {
  std::ofstream(folder / "try.fish") << "set -x PATH (dirname " << SOFTCELL_COMMAND << ") $PATH\n"
                                     << script << "\ncomplete -C '" << line
                                     << "' | string replace -r '\\t.*' ''\n";
  return run_shell("cd " + folder.path().string() +
                   " && HOME=$PWD fish --no-config try.fish | sort | tr '\\n' ' '")
      .output;
}

bool has_shell(const char* shell) { return run_shell(std::string("command -v ") + shell).status == 0; }

TEST(FishCompletion, OffersVerbsOptionsAndValues) {
  if (!has_shell("fish")) GTEST_SKIP() << "fish is not installed";
  const auto completed_by_fish = [](const std::string& line) {
    return offered_by_fish(ScratchFolder(), fish_completion(small_tree()), line);
  };
  EXPECT_EQ(completed_by_fish("softcell s"), "scenes spu ");
  EXPECT_EQ(completed_by_fish("softcell spu "), "run ");
  EXPECT_EQ(completed_by_fish("softcell spu run --c"), "--clock ");
  EXPECT_EQ(completed_by_fish("softcell spu run --clock h"), "host ");
  EXPECT_EQ(completed_by_fish("softcell spu run --clock=ra"), "--clock=random: ");
  EXPECT_EQ(completed_by_fish("softcell scenes --"), "--help ");
}

TEST(FishCompletion, OfTheCommandKnowsScenesKernelsAndFiles) {
  if (!has_shell("fish")) GTEST_SKIP() << "fish is not installed";
  const ScratchFolder folder;
  std::ofstream(folder / "matches.txt") << "";
  std::filesystem::create_directory(folder / "my folder");
  const auto completed_by_fish = [&](const std::string& line) {
    return offered_by_fish(folder, "softcell completion fish | source", line);
  };
  EXPECT_EQ(completed_by_fish("softcell demo 3d --headless --scene ar"), "arena ");
  EXPECT_EQ(completed_by_fish("softcell spu run match"), "match match_2d match_tiles matches.txt ");
  EXPECT_EQ(completed_by_fish("softcell report ma"), "matches.txt ");
  EXPECT_EQ(completed_by_fish("softcell demo 3d --out m"), "my folder/ ");
  EXPECT_EQ(completed_by_fish("softcell completion "), "bash fish zsh ");
  EXPECT_EQ(completed_by_fish("softcell run ma"), "matches.txt ");
  EXPECT_EQ(completed_by_fish("softcell help spu di"), "disasm ");
  EXPECT_EQ(completed_by_fish("softcell help spu run match"), "");
  EXPECT_EQ(completed_by_fish("softcell help demo 2d --he"), "");
  EXPECT_EQ(completed_by_fish("softcell spu disasm match"), "matches.txt ");
  EXPECT_EQ(completed_by_fish("softcell spu run --host-calls --folder m"), "my folder/ ");
  EXPECT_EQ(completed_by_fish("softcell run -- ./p --ch"), "");
}

TEST(ZshCompletion, OffersWhatBashDoes) {
  if (!has_shell("zsh")) GTEST_SKIP() << "zsh is not installed";
  const ScratchFolder folder;
  // Completion works on a terminal only: zpty is one. What is between the marks is what the line became.
  std::ofstream(folder / "try.zsh") << "zmodload zsh/zpty\nPATH=$(dirname " << SOFTCELL_COMMAND << "):$PATH\n"
                                    << R"zsh(
zpty shell zsh -f -i
zpty -w shell "PS1= PS2= RPS1=; autoload -Uz compinit && compinit -u -d $PWD/dump; source <(softcell completion zsh)"
zpty -w shell "show() { print -r -- \"<\$BUFFER>\"; zle .kill-whole-line; }; zle -N show; bindkey '^X' show; print rea''dy"
zpty -r shell text '*ready*'
for line in "$@"; do
  zpty -w -n shell "$line"$'\t\x18'
  zpty -r shell text '*<*>*' && print -rn -- "${${text##*<}%%>*}|"
done
zpty -d shell
)zsh";
  const auto run = run_shell(
      "cd " + folder.path().string() +
      " && timeout 30 zsh -f try.zsh 'softcell sce' 'softcell spu exp' 'softcell demo 3d --scene are'"
      " 'softcell completion fi'");
  EXPECT_EQ(run.output,
            "softcell scenes|softcell spu explore|softcell demo 3d --scene arena|softcell completion fish|");
}

TEST(Completion, OfAnUnknownShellIsRefused) {
  const CommandResult run = run_softcell("completion tcsh");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.output.find("completion tcsh: give bash, zsh or fish"), std::string::npos) << run.output;
}

TEST(Quiet, PrintsNothing) {
  const CommandResult run = run_softcell("demo 3d --headless --scene drop --size 64x48 --frames 2 --quiet");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, "");
}

TEST(ProgressBar, SaysHowMuchTimeIsLeft) {
  using std::chrono::seconds;
  EXPECT_EQ(progress_line("demo 2d", 0, 10, seconds(0), 80), "demo 2d [" + std::string(40, ' ') + "]   0%");
  EXPECT_EQ(progress_line("x", 10, 40, seconds(0), 80),
            "x [" + std::string(10, '=') + std::string(30, ' ') + "]  25%")
      << "the first second says too little";
  EXPECT_TRUE(progress_line("x", 10, 40, seconds(20), 80).ends_with("]  25%  1:00 left"));
  EXPECT_TRUE(progress_line("x", 20, 40, seconds(9), 80).ends_with("]  50%  0:09 left"));
  EXPECT_TRUE(progress_line("x", 1, 1000, seconds(11), 80).ends_with("]   0%  3:03:09 left"));
  EXPECT_TRUE(progress_line("x", 40, 40, seconds(80), 80).ends_with("] 100%"));
  EXPECT_TRUE(progress_line("x", 0, 0, seconds(1), 80).ends_with("] 100%"));
}

TEST(ProgressBar, FitsIntoANarrowTerminal) {
  using std::chrono::seconds;
  EXPECT_EQ(progress_line("demo 2d", 10, 20, seconds(30), 39), "demo 2d [====     ]  50%  0:30 left");
  EXPECT_EQ(progress_line("demo 2d", 10, 20, seconds(30), 20), "demo 2d  50%");
  EXPECT_EQ(progress_line("demo 2d", 10, 20, seconds(30), 9), "demo 2d  ");
  for (std::size_t columns = 0; columns < 90; ++columns)
    EXPECT_LE(progress_line("spu explore", 1, 1000, seconds(300), columns).size(), columns);
}

}  // namespace
}  // namespace softcell::tests
