#include "compile.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "missing_headers.h"
#include "toolchain_settings.h"

namespace softcell::toolchain {
namespace {

constexpr std::string_view kStandardInput = "-";

void append(Words& to, const Words& words) { to.insert(to.end(), words.begin(), words.end()); }

/// The compiler with the flags of a language, including the headers of the SPU.
Words command_of(Language language, bool checked, const Options& options, const Places& places) {
  Words command{places.compiler};
  if (language == Language::kC) {
    append(command, {"-x", "c", "-std=gnu17"});
    append(command, flags_of(settings::kCFlags, places));
    command.push_back("-DSOFTCELL_VECTOR_CASTS");
    if (checked) append(command, flags_of(settings::kCCheckedFlags, places));
  } else {
    append(command, {"-x", "c++"});
    append(command, flags_of(settings::kCxxFlags, places));
    command.push_back(options.cxx_standard);
    if (options.older_cxx) command.push_back("-Wno-register");  // which older sources have
    if (checked) append(command, flags_of(settings::kCxxCheckedFlags, places));
    append(command, {"-isystem", (places.sdk / "..").lexically_normal().string()});
  }
  append(command, {"-isystem", (places.sdk / "host").string()});
  return command;
}

bool has(const Words& words, std::string_view option) {
  return std::ranges::any_of(words, [&](const std::string& word) { return word.starts_with(option); });
}

bool has_dependencies(const Words& words) { return has(words, "-MD") || has(words, "-MMD"); }

/// The file that the dependencies go to: that of -MF, else one beside what they are of.
std::filesystem::path dependency_file(const Words& words, const std::filesystem::path& dependent) {
  constexpr std::string_view kOption = "-MF";
  const auto found =
      std::ranges::find_if(words, [&](const std::string& word) { return word.starts_with(kOption); });
  if (found == words.end()) return std::filesystem::path(dependent).replace_extension(".d");
  if (found->size() > kOption.size()) return found->substr(kOption.size());
  return found + 1 == words.end() ? "" : *(found + 1);
}

/// The preprocessor's options.
Words preprocessor_options(const Options& options, const std::filesystem::path& dependent) {
  Words words = options.preprocessor;
  if (!has_dependencies(words)) return words;
  if (!has(words, "-MF")) append(words, {"-MF", dependency_file(words, dependent).string()});
  if (!has(words, "-MT") && !has(words, "-MQ")) append(words, {"-MQ", dependent.string()});
  return words;
}

/// The options without those of dependencies, which the other build has already written.
Words without_dependencies(const Words& options) {
  Words words;
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (!options[i].starts_with("-M")) {
      words.push_back(options[i]);
    } else if (options[i] == "-MF" || options[i] == "-MT" || options[i] == "-MQ") {
      ++i;
    }
  }
  return words;
}

/// Removes the folders of -isystem from the words and returns them.
Words extract_system_folders(Words& words) {
  constexpr std::string_view kOption = "-isystem";
  Words folders, others;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!words[i].starts_with(kOption)) {
      others.push_back(words[i]);
    } else if (words[i].size() > kOption.size()) {
      folders.push_back(words[i].substr(kOption.size()));
    } else if (++i < words.size()) {
      folders.push_back(words[i]);
    }
  }
  words = std::move(others);
  return folders;
}

void print_command(const Options& options, const Words& command) {
  if (!options.verbose) return;
  std::string text;
  for (const std::string& word : command) text += " " + word;
  std::fprintf(stderr, "%s\n", text.c_str());
}

/// Says why SPU programs do not have the headers that the preprocessor has not found. With -MG it names them as the sources do.
void explain_missing_headers(Words command, const std::string& source) {
  if (source == kStandardInput) return;
  append(command, {"-M", "-MG", source});
  std::string names;
  try {
    names = output_of(command, true);
  } catch (const Failed&) {
    return;  // there are other errors, which it has printed before
  }
  std::istringstream words(names);
  std::set<std::string> known;
  for (std::string name; words >> name;) {
    if (const auto why = why_missing(name); why && known.insert(name).second)
      std::fprintf(stderr, "%s: note: %s\n", source.c_str(), why->c_str());
  }
}

void compile_build(const Input& source, const std::filesystem::path& object, bool checked,
                   const Words& preprocessor, const Options& options, const Places& places,
                   ScratchFolder& scratch) {
  // The compiler's messages are only printed for one build.
  const auto go = [&](const Words& command) {
    print_command(options, command);
    if (source.file == kStandardInput) lseek(STDIN_FILENO, 0, SEEK_SET);
    if (const int status = run(command, checked); status != 0) throw Failed{status};
  };
  const bool is_cxx = *source.language == Language::kCxx;
  Words command = command_of(*source.language, checked, options, places);
  // A program's own system headers are rewritten as its other ones are. softcell's headers stay as they are.
  Words words = preprocessor;
  const Words system_folders = extract_system_folders(words);
  append(command, words);
  for (const std::string& folder : system_folders) append(command, {"-I", folder});
  append(command, options.compiler);
  // Between preprocessor and compiler, another program gives casts of vectors the meaning that they have on an SPU, and in C++ the spelling
  // of vectors that of the host.
  const std::string text = scratch.file("source.i"), rewritten = scratch.file("rewritten.i");
  Words preprocess = command;
  append(preprocess, {"-E", source.file, "-o", text});
  try {
    go(preprocess);
  } catch (const Failed&) {
    if (!checked) explain_missing_headers(without_dependencies(command), source.file);
    throw;
  }
  Words rewrite{places.vector_casts.string()};
  if (is_cxx) rewrite.push_back("--c++");
  append(rewrite, {text, rewritten});
  append(rewrite, system_folders);
  go(rewrite);
  command = command_of(*source.language, checked, options, places);
  command[2] = is_cxx ? "c++-cpp-output" : "cpp-output";
  append(command, options.compiler);
  append(command, flags_of(settings::kCRewrittenFlags, places));
  append(command, {"-c", rewritten, "-o", object.string()});
  try {
    go(command);
  } catch (const Failed&) {
    // What compiles, but not to an object, has instructions of its own.
    command[command.size() - 4] = "-S";
    command.back() = "/dev/null";
    if (run(command, true) != 0) throw;
    throw std::runtime_error(
        source.file +
        ": its inline assembly has SPU instructions, which cannot run on the PC's processor; "
        "write si_ai() for `ai` and so on");
  }
  if (!is_cxx && options.step != Step::kCheck)
    go({"objcopy", "--weaken-symbols=" + rewritten + ".inline", object.string()});
}

}  // namespace

void save_standard_input(const Options& options, ScratchFolder& scratch) {
  const bool is_read = std::ranges::any_of(
      options.inputs, [](const Input& input) { return input.file == kStandardInput && input.language; });
  if (!is_read) return;
  const auto kept = scratch.file("standard_input");
  std::ofstream(kept, std::ios::binary) << std::cin.rdbuf();
  const int file = open(kept.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || dup2(file, STDIN_FILENO) < 0)
    throw std::runtime_error("standard input cannot be kept for the checked image");
  close(file);
}

void Dependencies::join(const Options& options, const std::filesystem::path& dependent) {
  if (!has_dependencies(options.preprocessor)) return;
  const std::filesystem::path file = dependency_file(options.preprocessor, dependent);
  if (!std::filesystem::is_regular_file(file)) return;  // standard output, for example
  std::ostringstream of_one;
  of_one << std::ifstream(file, std::ios::binary).rdbuf();
  std::string& rules = rules_[file];
  rules += of_one.str();
  std::ofstream(file, std::ios::binary) << rules;
}

void compile(const Input& source, const std::filesystem::path& object, const std::filesystem::path& dependent,
             const Options& options, const Places& places, ScratchFolder& scratch) {
  compile_build(source, object, false, preprocessor_options(options, dependent), options, places, scratch);
  const auto checked = scratch.file("checked.o");
  compile_build(source, checked, true, without_dependencies(options.preprocessor), options, places, scratch);
  add_section(object, kCheckedSection, checked);
}

void preprocess(const Options& options, const Places& places) {
  for (const Input& input : options.inputs) {
    if (!input.language) continue;
    Words command = command_of(*input.language, false, options, places);
    append(command, options.preprocessor);
    append(command, options.compiler);
    if (options.step == Step::kPreprocess) append(command, options.macros);
    if (options.step == Step::kPreprocess) command.push_back("-E");
    command.push_back(input.file);
    if (options.output) append(command, {"-o", *options.output});
    run_or_fail(command);
  }
}

void add_section(const std::filesystem::path& object, const std::string& section,
                 const std::filesystem::path& file) {
  run_or_fail({"objcopy", "--remove-section", section, "--add-section", section + "=" + file.string(),
               "--set-section-flags", section + "=noload,readonly", object.string()});
}

}  // namespace softcell::toolchain
