// softcell-spu-gcc, -g++, -ld, -ar, ... and softcell-embedspu: one program, whose name determines what it does.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "compile.h"
#include "embed.h"
#include "link.h"
#include "options.h"
#include "places.h"
#include "process.h"
#include "toolchain_settings.h"

namespace {

using namespace softcell::toolchain;

constexpr int kWrongUsage = 2;

constexpr const char kHelp[] =
    "Compiles and links SPU programs in C and C++ for softcell, with the options of spu-gcc.\n"
    "\n"
    "  softcell-spu-gcc -O2 -c kernel.c -o kernel.o     -c, -E, -M, -I, -D, -W..., -std=, -l, -L, -r as "
    "usual\n"
    "  softcell-spu-gcc kernel.o -o kernel.elf          a program: softcell spu run, spe_image_open(), "
    "embedspu\n"
    "  softcell-embedspu kernel kernel.elf kernel_elf.o an object with spe_program_handle_t kernel\n"
    "\n"
    "  -Wl,-z,stack-size=BYTES   the stack; without it, half of what the program leaves free, at most 128 "
    "KB\n"
    "  SOFTCELL_CXX              another host compiler;  SOFTCELL_QUIET: no notes about options without "
    "meaning\n";

/// Answers the questions that build systems ask compilers. @return  whether the words were such a question
bool answer_question(const Words& words) {
  constexpr std::string_view kPrintFile = "-print-file-name=";
  if (words.size() != 1) return false;
  if (words[0] == "--version") {
    std::printf("softcell-spu-gcc (softcell) %s\n", settings::kVersion);
  } else if (words[0] == "-dumpversion") {
    std::printf("%s\n", settings::kVersion);
  } else if (words[0] == "-print-libgcc-file-name") {
    std::printf("libgcc.a\n");  // as GCC does with a file that it does not find: programs need none
  } else if (words[0].starts_with(kPrintFile)) {
    std::printf("%s\n", words[0].c_str() + kPrintFile.size());
  } else if (words[0] == "-dumpmachine") {
    std::printf("spu\n");
  } else if (words[0] == "-v") {
    std::fprintf(stderr, "softcell-spu-gcc (softcell) version %s\n", settings::kVersion);
  } else if (words[0] == "--help") {
    std::printf("%s", kHelp);
  } else {
    return false;
  }
  return true;
}

int link_inputs(const Words& files, const Options& options, const Places& places, ScratchFolder& scratch) {
  link(files, options.output.value_or("a.out"), options, places, scratch);
  return 0;
}

int gcc(const std::string& command, const Words& words, Language language) {
  if (answer_question(words)) return 0;
  const Options options = parse_compiler_options(words, language);
  report_meaningless(command, options);
  const Places places = find_places();
  if (options.step == Step::kDependencies || options.step == Step::kPreprocess) {
    preprocess(options, places);
    return 0;
  }
  ScratchFolder scratch;
  save_standard_input(options, scratch);
  Words files;
  Dependencies dependencies;
  for (const Input& input : options.inputs) {
    if (!input.language) {
      files.push_back(input.file);
      continue;
    }
    const auto stem = std::filesystem::path(input.file).stem().string() + ".o";
    const bool keeps = options.step == Step::kCompile && !options.relocatable;
    const std::filesystem::path object =
        keeps ? std::filesystem::path(options.output.value_or(stem)) : scratch.file(stem);
    // Who links at once knows of no object.
    const std::filesystem::path dependent =
        keeps ? object : std::filesystem::path(options.output.value_or(stem));
    compile(input, object, dependent, options, places, scratch);
    dependencies.join(options, dependent);
    files.push_back(object);
  }
  if (options.step == Step::kCheck) return 0;
  return options.step == Step::kCompile && !options.relocatable
             ? 0
             : link_inputs(files, options, places, scratch);
}

int ld(const std::string& command, const Words& words) {
  if (answer_question(words)) return 0;
  const Options options = parse_linker_options(words);
  report_meaningless(command, options);
  Words files;
  for (const Input& input : options.inputs) files.push_back(input.file);
  ScratchFolder scratch;
  return link_inputs(files, options, find_places(), scratch);
}

int run_command(const std::string& command, Words words) {
  if (command == "softcell-spu-gcc") return gcc(command, words, Language::kC);
  if (command == "softcell-spu-g++") return gcc(command, words, Language::kCxx);
  if (command == "softcell-spu-ld") return ld(command, words);
  if (command == "softcell-embedspu") return embedspu(words);
  if (command == "softcell-bin2s") return bin2s(words);
  // Objects and programs are ELF files of the host.
  static const std::map<std::string, std::string> kTools{
      {"softcell-spu-ar", "ar"},     {"softcell-spu-ranlib", "ranlib"},
      {"softcell-spu-size", "size"}, {"softcell-spu-objdump", "objdump"},
      {"softcell-spu-nm", "nm"},     {"softcell-spu-strip", "strip"}};
  const auto tool = kTools.find(command);
  if (tool == kTools.end())
    throw std::invalid_argument("call it by one of its names, softcell-spu-gcc for example");
  if (command == "softcell-spu-strip") {
    // A program has few symbols, and softcell reads them, so they stay; strip keeps both builds.
    words.insert(words.begin(), {"--strip-debug", "--keep-section=.softcell.*"});
    std::erase(words, "-s");
    std::erase(words, "--strip-all");
  }
  words.insert(words.begin(), tool->second);
  become(words);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = std::filesystem::path(argv[0]).filename();
  catch_signals();
  try {
    return run_command(command, Words(argv + 1, argv + argc));
  } catch (const Ended& ended) {
    end_by(ended.signal);
  } catch (const Failed& failed) {
    return failed.status;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s: %s\n", command.c_str(), error.what());
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", command.c_str(), error.what());
    return 1;
  }
}
