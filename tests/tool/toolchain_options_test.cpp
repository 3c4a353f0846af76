// The command lines of softcell-spu-gcc and its kin.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include "support/scratch_folder.h"
#include "toolchain/options.h"

namespace softcell::toolchain {
namespace {

Options parsed(const Words& words, Language language = Language::kC) {
  return parse_compiler_options(words, language);
}

/// What is said of words that cannot be followed; empty if they can.
std::string refusal(const Words& words) {
  try {
    parse_compiler_options(words, Language::kC);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(ToolchainOptions, SayHowFarTheCompilerGoes) {
  EXPECT_EQ(parsed({"a.c"}).step, Step::kLink);
  EXPECT_EQ(parsed({"-c", "a.c"}).step, Step::kCompile);
  EXPECT_EQ(parsed({"-E", "a.c"}).step, Step::kPreprocess);
  EXPECT_EQ(parsed({"-M", "a.c"}).step, Step::kDependencies);
  EXPECT_EQ(parsed({"-MM", "-c", "a.c"}).step, Step::kDependencies);
  EXPECT_EQ(parsed({"-MD", "-c", "a.c"}).step, Step::kCompile);
  EXPECT_EQ(parsed({"-fsyntax-only", "-c", "a.c"}).step, Step::kCheck);
  EXPECT_EQ(parsed({"-c", "-fsyntax-only", "a.c"}).step, Step::kCheck);
  EXPECT_EQ(parsed({"-E", "-fsyntax-only", "a.c"}).step, Step::kPreprocess);
  EXPECT_EQ(parsed({"-dM", "-E", "a.c"}).macros, Words{"-dM"});
  EXPECT_EQ(parsed({"-oprogram", "a.c"}).output, "program");
  EXPECT_EQ(parsed({"-o", "program", "a.c"}).output, "program");
  EXPECT_TRUE(parsed({"-r", "a.o", "b.o"}).relocatable);
  EXPECT_TRUE(parsed({"-v", "a.c"}).verbose);
}

TEST(ToolchainOptions, KnowLanguagesByNameOptionAndCommand) {
  const Options options =
      parsed({"a.c", "b.cpp", "d.o", "-x", "c++", "e.c", "-xc", "f.cpp", "-x", "none", "g.C", "h.cc"});
  ASSERT_EQ(options.inputs.size(), 7u);
  const std::optional<Language> expected[] = {Language::kC, Language::kCxx, std::nullopt,  Language::kCxx,
                                              Language::kC, Language::kCxx, Language::kCxx};
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(options.inputs[i].language, expected[i]) << options.inputs[i].file;
  EXPECT_EQ(parsed({"a.c"}, Language::kCxx).inputs[0].language, Language::kCxx);
  EXPECT_EQ(parsed({"-"}).inputs[0].language, Language::kC);
}

TEST(ToolchainOptions, GoToTheStepThatTheyAreFor) {
  const Options options =
      parsed({"-Iinclude", "-I", "more", "-DONE", "-D", "TWO=2", "-UX", "-include", "first.h", "-MMD", "-MF",
              "a.d", "-Wall", "-w", "-std=c99", "-fwrapv", "-Wl,-Map=a.map,-z,stack-size=5000", "a.c"});
  EXPECT_EQ(options.preprocessor, (Words{"-Iinclude", "-I", "more", "-DONE", "-D", "TWO=2", "-UX", "-include",
                                         "first.h", "-MMD", "-MF", "a.d"}));
  EXPECT_EQ(options.compiler, (Words{"-Wall", "-w", "-std=c99", "-fwrapv"}));
  EXPECT_EQ(options.linker, Words{"-Map=a.map"});
  EXPECT_EQ(options.stack_bytes, 5008u) << "whole quadwords";
  EXPECT_TRUE(options.meaningless.empty());
}

TEST(ToolchainOptions, ThatChangeResultsGoToTheCompiler) {
  const Options options = parsed({"-fsingle-precision-constant", "-fshort-wchar", "-fshort-enums", "a.c"});
  EXPECT_EQ(options.compiler, (Words{"-fsingle-precision-constant", "-fshort-wchar", "-fshort-enums"}));
  EXPECT_TRUE(options.meaningless.empty());
}

TEST(ToolchainOptions, WithoutMeaningAreKeptForOneNote) {
  const Options options =
      parsed({"-O3", "-g", "-pipe", "-funroll-loops", "-mfixed-range=80-127", "-std=c++98", "-T", "script.ld",
              "-Wl,--gc-sections,-e,_start", "-Xassembler", "-x", "-Wa,-a", "a.c"});
  EXPECT_EQ(options.meaningless, (Words{"-funroll-loops", "-mfixed-range=80-127", "-T script.ld",
                                        "--gc-sections", "-e _start", "-Xassembler -x", "-Wa,-a"}));
  EXPECT_TRUE(options.compiler.empty());
}

TEST(ToolchainOptions, HaveTheStandardOfTheHeadersInPlaceOfAnOlderOne) {
  EXPECT_EQ(parsed({"a.cc"}).cxx_standard, "-std=gnu++17");
  EXPECT_EQ(parsed({"-std=c++98", "a.cc"}).cxx_standard, "-std=c++17");
  EXPECT_EQ(parsed({"-std=gnu++98", "a.cc"}).cxx_standard, "-std=gnu++17");
  EXPECT_EQ(parsed({"-std=c++98", "a.cc"}).notes, Words{"-std=c++98: C++ is compiled as C++17 here"});
  EXPECT_TRUE(parsed({"-std=c++98", "a.cc"}).older_cxx);
  EXPECT_EQ(parsed({"-fexceptions", "a.cc"}).notes,
            Words{"-fexceptions: programs have no exceptions and no RTTI here"});
  EXPECT_EQ(parsed({"--param=a=1", "-pg", "-save-temps", "a.cc"}).meaningless,
            (Words{"--param=a=1", "-pg", "-save-temps"}));
  EXPECT_EQ(parsed({"-std=gnu++20", "a.cc"}).compiler, Words{"-std=gnu++20"});
  EXPECT_EQ(parsed({"-std=gnu90", "a.c"}).compiler, Words{"-std=gnu90"});
  EXPECT_EQ(parsed({"-ansi", "a.cc"}, Language::kCxx).cxx_standard, "-std=c++17");
}

TEST(ToolchainOptions, ReachTheLinkerOneByOne) {
  EXPECT_EQ(parsed({"-Xlinker", "-Map", "-Xlinker", "a.map", "a.o"}).linker, (Words{"-Map", "a.map"}));
  EXPECT_EQ(parsed({"-Wl,-Map", "a.o", "-Wl,a.map"}).linker, (Words{"-Map", "a.map"}));
  EXPECT_EQ(parsed({"-Xlinker", "-z", "-Xlinker", "stack-size=64", "a.o"}).stack_bytes, 64u);
  EXPECT_EQ(refusal({"a.o", "-Xlinker", "-Map"}), "-Map needs a value");
}

TEST(ToolchainOptions, NameNoInputAsTheOutput) {
  const tests::ScratchFolder scratch;
  const std::string source = scratch.path().string() + "/a.c";
  std::ofstream(source) << "int main(void) { return 0; }\n";
  EXPECT_EQ(refusal({source, "-o", scratch.path().string() + "/./a.c"}),
            "-o " + scratch.path().string() + "/./a.c: this file is an input, too");
  EXPECT_EQ(refusal({"-c", source, "-o", scratch.path().string() + "/a.o"}), "");
  EXPECT_EQ(refusal({"-x", "c", "-c", "/dev/null", "-o", "/dev/null"}), "") << "as scripts ask for an option";
}

TEST(ToolchainOptions, TakeLibrariesWhereTheyStand) {
  const tests::ScratchFolder scratch;
  const std::string folder = scratch.path().string();
  std::ofstream(scratch.path() / "libown.a") << "";
  const Options options = parsed({"a.o", "-L" + folder, "-lown", "b.o", "-lm", "-lsimdmath"});
  ASSERT_EQ(options.inputs.size(), 3u) << "-lm is in softcell's own";
  EXPECT_EQ(options.inputs[1].file, folder + "/libown.a");
  EXPECT_EQ(refusal({"a.o", "-lmissing"}),
            "-lmissing: there is no libmissing.a in the folders of -L, and softcell's library has no part of "
            "that name");
  EXPECT_EQ(refusal({"-c", "a.c", "-lmissing"}), "") << "nothing is linked";
  EXPECT_EQ(parsed({"a.o", "-L" + folder, "-l:libown.a"}).inputs[1].file, folder + "/libown.a");
  EXPECT_EQ(refusal({"a.o", "-l:own.a"}), "-l:own.a: there is no file own.a in the folders of -L");
}

TEST(ToolchainOptions, ComeFromFilesToo) {
  const tests::ScratchFolder scratch;
  const std::string file = (scratch.path() / "options").string();
  std::ofstream(file) << "-c  'a b.c'\n-D\"TEXT=x y\"\t-o out\\ put.o";
  const Options options = parsed({"@" + file});
  EXPECT_EQ(options.step, Step::kCompile);
  EXPECT_EQ(options.inputs[0].file, "a b.c");
  EXPECT_EQ(options.preprocessor, Words{"-DTEXT=x y"});
  EXPECT_EQ(options.output, "out put.o");
  EXPECT_EQ(refusal({"@" + file + ".no"}), "the file of options " + file + ".no cannot be read");
}

TEST(ToolchainOptions, AreRefusedInASentence) {
  EXPECT_EQ(refusal({}), "there are no input files");
  EXPECT_EQ(refusal({"a.c", "-o"}), "-o needs a value");
  EXPECT_EQ(refusal({"--unknown", "a.c"}), "unknown option --unknown");
  EXPECT_EQ(refusal({"-x", "fortran", "a.f"}), "-x fortran: only C and C++ can be compiled here");
  EXPECT_EQ(refusal({"-c", "a.c", "b.c", "-o", "c.o"}), "-o names one file, and there are several sources");
  for (const char* const bytes : {"", "x", "8", "262145", "-1", "16x"})
    EXPECT_EQ(refusal({"a.c", "-Wl,-z,stack-size=" + std::string(bytes)}),
              "-z stack-size=" + std::string(bytes) + ": a stack has 16 to 262144 bytes");
  EXPECT_NE(refusal({"-S", "a.c"}).find("a real spu-gcc writes them"), std::string::npos);
  EXPECT_NE(refusal({"a.s"}).find("assemble it with a real spu-gcc"), std::string::npos);
}

TEST(ToolchainOptions, OfTheLinkerAreItsOwn) {
  const Options options = parse_linker_options({"-r", "-o", "out.o", "a.o", "-Map", "map", "--defsym", "x=1",
                                                "-T", "script", "--gc-sections", "-z", "relro"});
  EXPECT_TRUE(options.relocatable);
  EXPECT_EQ(options.output, "out.o");
  EXPECT_EQ(options.inputs.size(), 1u);
  EXPECT_EQ(options.linker, (Words{"-Map", "map"}));
  EXPECT_EQ(options.symbols, (Words{"--defsym", "x=1"}));
  EXPECT_EQ(options.meaningless, (Words{"-T script", "--gc-sections", "-z relro"}));
}

TEST(ToolchainOptions, ForTheLinkerHoldForBothBuildsIfTheyMakeSymbols) {
  const Options options = parse_compiler_options(
      {"a.c", "-Wl,--wrap=malloc,--defsym", "-Xlinker", "x=1", "-Wl,-wrap,free"}, Language::kC);
  EXPECT_EQ(options.symbols, (Words{"--wrap=malloc", "--defsym", "x=1", "-wrap", "free"}));
  EXPECT_TRUE(options.meaningless.empty());
}

TEST(ToolchainOptions, ForThePreprocessorComeInListsToo) {
  const Options options = parse_compiler_options(
      {"a.c", "-Wp,-MMD,a.d,-DX=1", "-Xpreprocessor", "-U", "-Xpreprocessor", "Y", "-Wp,-MD"}, Language::kC);
  EXPECT_EQ(options.preprocessor, (Words{"-MMD", "-MF", "a.d", "-DX=1", "-U", "Y", "-MD"}));
  EXPECT_TRUE(options.meaningless.empty());
}

}  // namespace
}  // namespace softcell::toolchain
