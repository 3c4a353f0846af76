#include "options.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace softcell::toolchain {
namespace {

template <class... Texts>
bool is_any(std::string_view text, const Texts&... texts) {
  return ((text == texts) || ...);
}
template <class... Texts>
bool starts_with_any(std::string_view text, const Texts&... texts) {
  return (text.starts_with(texts) || ...);
}

/// Libraries of a Cell toolchain that need not be linked: softcell's own library has their functions, or they have nothing to link.
bool is_in_library(std::string_view name) {
  return is_any(name, "c", "m", "gcc", "gloss", "stdc++", "supc++", "misc", "sync", "simdmath", "sputhread",
                "spuatomic", "spudma", "ea", "profile", "gmath", "spu_timer", "sputimer");
}

/// Reads the words of a file: they are separated by spaces, and quotes keep spaces within a word. [GCC, @file] documented
Words words_of_file(const std::string& name) {
  std::ifstream file(name);
  if (!file) throw std::invalid_argument("the file of options " + name + " cannot be read");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  Words words;
  std::string word;
  char quote = 0;
  bool within = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && (c == ' ' || c == '\n' || c == '\t' || c == '\r')) {
      if (within) words.push_back(std::exchange(word, {}));
      within = false;
      continue;
    }
    within = true;
    if (c == '\\' && i + 1 < text.size()) {
      word += text[++i];
    } else if (quote == c) {
      quote = 0;
    } else if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else {
      word += c;
    }
  }
  if (within) words.push_back(word);
  return words;
}

Words with_files_expanded(const Words& words) {
  Words all;
  for (const std::string& word : words) {
    if (word.size() > 1 && word.front() == '@') {
      const Words more = words_of_file(word.substr(1));
      all.insert(all.end(), more.begin(), more.end());
    } else {
      all.push_back(word);
    }
  }
  return all;
}

std::optional<Language> language_by_name(std::string_view name) {
  if (is_any(name, "c", "cpp-output", "c-header")) return Language::kC;
  if (is_any(name, "c++", "c++-cpp-output", "c++-header")) return Language::kCxx;
  return std::nullopt;
}

class Parser {
 public:
  Parser(const Words& words, Language language) : words_(with_files_expanded(words)), language_(language) {}

  Options compiler_options() {
    for (; at_ < words_.size(); ++at_) parse_compiler_option(words_[at_]);
    finish();
    return std::move(options_);
  }
  Options linker_options() {
    for (; at_ < words_.size(); ++at_) parse_linker_option(words_[at_]);
    finish();
    return std::move(options_);
  }

 private:
  /// The value of an option: the rest of its word, or the next word.
  std::string value(std::string_view word, std::string_view option) {
    if (word.size() > option.size()) return std::string(word.substr(option.size()));
    if (++at_ == words_.size()) throw std::invalid_argument(std::string(option) + " needs a value");
    return words_[at_];
  }
  void add_with_value(Words& to, const std::string& word, std::string_view option) {
    to.push_back(word);
    if (word == option) to.push_back(value(word, option));
  }

  void parse_compiler_option(const std::string& word) {
    if (word == "-" || !word.starts_with('-')) return add_input(word);
    for (const std::string_view option : {"-isystem", "-iquote", "-idirafter", "-include", "-imacros", "-I",
                                          "-D", "-U", "-MF", "-MT", "-MQ"}) {
      if (word.starts_with(option)) return add_with_value(options_.preprocessor, word, option);
    }
    if (is_any(word, "-MD", "-MMD", "-MP", "-MG", "-C", "-P", "-undef"))
      return options_.preprocessor.push_back(word);
    if (is_any(word, "-M", "-MM")) {
      options_.step = Step::kDependencies;
      return options_.preprocessor.push_back(word);
    }
    if (word.starts_with("-o")) {
      options_.output = value(word, "-o");
    } else if (word.starts_with("-x")) {
      set_language(value(word, "-x"));
    } else if (word == "-c") {
      options_.step = std::min(options_.step, Step::kCompile);
    } else if (word == "-E") {
      if (options_.step != Step::kDependencies) options_.step = Step::kPreprocess;
    } else if (word == "-fsyntax-only") {
      options_.step = std::min(options_.step, Step::kCheck);
    } else if (is_any(word, "-dM", "-dD", "-dN", "-dI", "-dU")) {
      options_.macros.push_back(word);
    } else if (word == "-S") {
      throw std::invalid_argument(
          "-S: there are no SPU instructions here, the program runs on the PC's processor; a real spu-gcc "
          "writes them");
    } else if (starts_with_any(word, "-l", "-L")) {
      add_library(word);
    } else if (word.starts_with("-Wl,")) {
      parse_linker_list(word.substr(4));
    } else if (word == "-Xlinker") {
      parse_linker_list(value(word, "-Xlinker"));
    } else if (word.starts_with("-Wp,")) {
      add_preprocessor_list(word.substr(4));
    } else if (word == "-Xpreprocessor") {
      options_.preprocessor.push_back(value(word, word));
    } else if (word == "-T" || word == "-Xassembler" || word == "--param") {
      options_.meaningless.push_back(word + " " + value(word, word));
    } else if (word == "-r") {
      options_.relocatable = true;
    } else if (word == "-v" || word == "-###") {
      options_.verbose = true;
    } else if (word.starts_with("-std=")) {
      set_standard(word);
    } else if (word == "-ansi") {
      if (language_ == Language::kC) options_.compiler.push_back("-std=gnu90");
      options_.cxx_standard = "-std=c++17";
    } else if (is_any(word, "-pipe", "-static", "-O", "-O1", "-O2", "-O3", "-Os", "-pthread", "-s") ||
               starts_with_any(word, "-g", "-mtune=", "-march=", "-mcpu=")) {
      // These options do not change a program's speed here, nor what a debugger knows of it.
    } else if (word == "-w" || starts_with_any(word, "-W", "-pedantic")) {
      if (word.starts_with("-Wa,")) {
        options_.meaningless.push_back(word);
      } else {
        options_.compiler.push_back(word);
      }
    } else if (is_of_language(word)) {
      options_.compiler.push_back(word);
    } else if (is_any(word, "-fexceptions", "-frtti")) {
      options_.notes.push_back(word + ": programs have no exceptions and no RTTI here");
    } else if (is_any(word, "-pg", "-p") ||
               starts_with_any(word, "-f", "-m", "-O", "--param=", "-save-temps", "--save-temps", "-nost",
                               "-nodef", "-shared-libgcc", "-static-lib", "-no-")) {
      options_.meaningless.push_back(word);
    } else {
      throw std::invalid_argument("unknown option " + word);
    }
  }

  /// Whether the option changes the meaning of a source, and is supported here.
  static bool is_of_language(std::string_view word) {
    return is_any(word, "-fsigned-char", "-funsigned-char", "-fno-strict-aliasing", "-fstrict-aliasing",
                  "-fwrapv", "-fpermissive", "-fcommon", "-fno-common", "-fgnu89-inline", "-fms-extensions",
                  "-fplan9-extensions", "-fshort-enums", "-fno-short-enums", "-fsigned-bitfields",
                  "-funsigned-bitfields", "-fsingle-precision-constant", "-fshort-wchar") ||
           starts_with_any(word, "-fpack-struct", "-fmax-errors", "-fdiagnostics", "-ftemplate-depth");
  }

  /// Words that are separated by commas. `-MD` and `-MMD` have the file that they write as their value there.
  void add_preprocessor_list(std::string_view list) {
    const Words words = split(list);
    for (std::size_t i = 0; i < words.size(); ++i) {
      options_.preprocessor.push_back(words[i]);
      if (is_any(words[i], "-MD", "-MMD") && i + 1 < words.size() && !words[i + 1].starts_with('-'))
        options_.preprocessor.push_back("-MF");
    }
  }

  void parse_linker_option(const std::string& word) {
    if (!word.starts_with('-')) return add_input(word);
    if (word.starts_with("-o")) {
      options_.output = value(word, "-o");
    } else if (starts_with_any(word, "-l", "-L")) {
      add_library(word);
    } else if (is_any(word, "-r", "-i", "--relocatable")) {
      options_.relocatable = true;
    } else if (word.starts_with("-Map=") || is_any(word, "-M", "--print-map", "--trace", "-t", "--verbose")) {
      options_.linker.push_back(word);
    } else if (word == "-Map") {
      options_.linker.insert(options_.linker.end(), {word, value(word, word)});
    } else if (word == "-z") {
      parse_linker_keyword(value(word, word));
    } else if (starts_with_any(word, "--defsym=", "--wrap=", "-wrap=")) {
      options_.symbols.push_back(word);
    } else if (is_ignored_with_value(word)) {
      options_.meaningless.push_back(word + " " + value(word, word));
    } else if (is_any(word, "--defsym", "-defsym", "--wrap", "-wrap")) {
      options_.symbols.insert(options_.symbols.end(), {word, value(word, word)});
    } else {
      options_.meaningless.push_back(word);
    }
  }

  /// What stands between commas.
  static Words split(std::string_view list) {
    Words words;
    for (std::size_t at = 0; at <= list.size();) {
      const auto comma = std::min(list.find(',', at), list.size());
      words.emplace_back(list.substr(at, comma - at));
      at = comma + 1;
    }
    return words;
  }
  /// Parses linker options that are separated by commas; some use the next word as their value.
  void parse_linker_list(std::string_view list) {
    const Words words = split(list);
    passed_on_.insert(passed_on_.end(), words.begin(), words.end());
    // The value may come with the next -Xlinker or -Wl.
    if (!needs_linker_value(passed_on_.back())) parse_passed_on();
  }
  void parse_passed_on() {
    const Words outer = std::exchange(words_, std::exchange(passed_on_, {}));
    const std::size_t outer_at = std::exchange(at_, 0);
    for (; at_ < words_.size(); ++at_) parse_linker_option(words_[at_]);
    words_ = outer;
    at_ = outer_at;
  }
  static bool needs_linker_value(std::string_view word) {
    return is_any(word, "-o", "-l", "-L", "-Map", "-z", "--defsym", "-defsym", "--wrap", "-wrap") ||
           is_ignored_with_value(word);
  }
  static bool is_ignored_with_value(std::string_view word) {
    return is_any(word, "-e", "-T", "-m", "-u", "-h", "-Ttext", "-Tdata", "-Tbss", "--script", "--entry");
  }

  void parse_linker_keyword(const std::string& keyword) {
    constexpr std::string_view kStack = "stack-size=";
    if (!keyword.starts_with(kStack)) return options_.meaningless.push_back("-z " + keyword);
    const std::string number = keyword.substr(kStack.size());
    char* end = nullptr;
    const unsigned long bytes = std::strtoul(number.c_str(), &end, 0);
    constexpr unsigned long kLocalStore = 0x40000;
    if (number.empty() || *end != '\0' || bytes < 16 || bytes > kLocalStore)
      throw std::invalid_argument("-z " + keyword + ": a stack has 16 to 262144 bytes");
    options_.stack_bytes = static_cast<std::uint32_t>((bytes + 15) / 16 * 16);
  }

  void set_language(const std::string& name) {
    forced_ = language_by_name(name);
    if (!forced_ && name != "none")
      throw std::invalid_argument("-x " + name + ": only C and C++ can be compiled here");
  }

  void set_standard(const std::string& word) {
    // The headers of the SPU are C++17.
    constexpr std::array kOld{"98", "03", "0x", "11", "1y", "14", "1z"};
    if (word.find("++") == word.npos) {
      options_.compiler.push_back(word);
    } else if (std::ranges::any_of(kOld, [&](const char* year) { return word.ends_with(year); })) {
      options_.notes.push_back(word + ": C++ is compiled as C++17 here");
      options_.older_cxx = true;
      if (word.find("gnu") == word.npos) options_.cxx_standard = "-std=c++17";
    } else {
      options_.compiler.push_back(word);
    }
  }

  void add_input(const std::string& file) {
    std::optional<Language> language = forced_;
    const std::string extension = std::filesystem::path(file).extension();
    if (!language && file != "-") {
      if (is_any(extension, ".c", ".i", ".h")) {
        language = language_;
      } else if (is_any(extension, ".cc", ".cpp", ".cxx", ".C", ".cp", ".c++", ".CPP", ".ii")) {
        language = Language::kCxx;
      } else if (is_any(extension, ".s", ".S", ".asm")) {
        throw std::invalid_argument(
            file +
            ": SPU instructions cannot run on the PC's processor; assemble it with a real "
            "spu-gcc, and run the whole program by softcell spu run");
      }
    } else if (!language) {
      language = language_;
    }
    options_.inputs.push_back({file, language});
  }

  void add_library(const std::string& word) {
    if (word.starts_with("-L")) return folders_.push_back(value(word, "-L"));
    libraries_.push_back({value(word, "-l"), options_.inputs.size()});
  }

  void finish() {
    parse_passed_on();
    // From the last to the first, so that the positions of the others do not change.
    for (auto library = libraries_.rbegin(); library != libraries_.rend(); ++library) {
      const auto& [name, place] = *library;
      const auto file = find_library(name);
      if (file)
        options_.inputs.insert(options_.inputs.begin() + static_cast<std::ptrdiff_t>(place),
                               Input{*file, {}});
    }
    if (options_.inputs.empty()) throw std::invalid_argument("there are no input files");
    for (const Input& input : options_.inputs) {
      std::error_code none_there;
      if (options_.output && std::filesystem::is_regular_file(input.file, none_there) &&
          std::filesystem::equivalent(input.file, *options_.output, none_there))
        throw std::invalid_argument("-o " + *options_.output + ": this file is an input, too");
    }
    const bool one_output = options_.output && options_.step != Step::kLink && !options_.relocatable;
    const auto sources =
        std::ranges::count_if(options_.inputs, [](const Input& i) { return i.language.has_value(); });
    if (one_output && sources > 1)
      throw std::invalid_argument("-o names one file, and there are several sources");
  }

  std::optional<std::string> find_library(const std::string& name) const {
    for (const std::string& folder : folders_) {
      // -l:NAME names the file itself.
      const std::filesystem::path file =
          std::filesystem::path(folder) / (name.starts_with(':') ? name.substr(1) : "lib" + name + ".a");
      if (std::filesystem::exists(file)) return file.string();
    }
    if (is_in_library(name)) return std::nullopt;
    if (options_.step != Step::kLink) return std::nullopt;
    if (name.starts_with(':'))
      throw std::invalid_argument("-l" + name + ": there is no file " + name.substr(1) +
                                  " in the folders of -L");
    throw std::invalid_argument("-l" + name + ": there is no lib" + name +
                                ".a in the folders of -L, and softcell's "
                                "library has no part of that name");
  }

  Words words_;
  std::size_t at_ = 0;
  const Language language_;
  std::optional<Language> forced_;
  Words folders_;
  Words passed_on_;  ///< words for the linker whose last one needs a value
  std::vector<std::pair<std::string, std::size_t>> libraries_;  ///< with the input that follows it
  Options options_;
};

}  // namespace

Options parse_compiler_options(const Words& words, Language language) {
  return Parser(words, language).compiler_options();
}

Options parse_linker_options(const Words& words) { return Parser(words, Language::kC).linker_options(); }

void report_meaningless(const std::string& command, const Options& options) {
  if (std::getenv("SOFTCELL_QUIET") != nullptr) return;
  for (const std::string& note : options.notes)
    std::fprintf(stderr, "%s: note: %s\n", command.c_str(), note.c_str());
  if (options.meaningless.empty()) return;
  std::string text;
  for (const std::string& option : options.meaningless) text += " " + option;
  std::fprintf(stderr, "%s: note: without meaning on a PC:%s\n", command.c_str(), text.c_str());
}

}  // namespace softcell::toolchain
