#include "places.h"

#include <cstdlib>
#include <stdexcept>

#include "toolchain_settings.h"

namespace softcell::toolchain {
namespace {

/// The path in a build or in an installation. `name` may be empty.
std::filesystem::path find(const std::filesystem::path& folder, const char* built, const char* installed,
                           const char* name) {
  for (const char* const place : {built, installed}) {
    const auto found = (folder / place / name).lexically_normal();
    if (std::filesystem::exists(found)) return found;
  }
  throw std::runtime_error(std::string(name) + " of softcell was not found in " +
                           (folder / installed).lexically_normal().string());
}

#ifdef __clang__
constexpr bool kByClang = true;
#else
constexpr bool kByClang = false;
#endif

/// The flags of kernels are those of the compiler that has built softcell.
void require_same_make(const std::string& compiler) {
  const bool is_clang = output_of({compiler, "--version"}).find("clang") != std::string::npos;
  if (is_clang == kByClang) return;
  throw std::runtime_error("SOFTCELL_CXX is " + compiler +
                           (kByClang
                                ? ", which is no Clang; this softcell was built with Clang: name a clang++"
                                : ", which is Clang; this softcell was built with GCC: name a g++"));
}

std::string find_compiler() {
  if (const char* const wanted = std::getenv("SOFTCELL_CXX"); wanted != nullptr && *wanted != '\0') {
    require_same_make(wanted);
    return wanted;
  }
  return std::filesystem::exists(settings::kCompiler) ? settings::kCompiler : settings::kCompilerName;
}

void replace(std::string& text, std::string_view what, const std::string& by) {
  if (const auto at = text.find(what); at != text.npos) text.replace(at, what.size(), by);
}

}  // namespace

Places find_places() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto library = [&](const char* name) {
    return find(folder, settings::kLibraryBuilt, settings::kLibraryInstalled, name);
  };
  // The program that rewrites casts is built in the same folder as the commands.
  const auto casts = find(folder, ".", settings::kLibraryInstalled, "softcell_vector_casts");
  Places places{.sdk = find(folder, settings::kSdkBuilt, settings::kSdkInstalled, "ls.ld").parent_path(),
                .library = library("libsoftcell_program_library.a"),
                .checked_library = library("libsoftcell_program_library_checked.a"),
                .access_reports = library("libsoftcell_report_accesses_library.a"),
                .vector_casts = casts,
                .compiler = find_compiler(),
                .compiler_headers = {}};
  places.compiler_headers = output_of({places.compiler, "-print-file-name=include"});
  return places;
}

Words flags_of(std::string_view lines, const Places& places) {
  Words flags;
  while (!lines.empty()) {
    const auto end = lines.find('\n');
    std::string flag(lines.substr(0, end));
    lines.remove_prefix(end == lines.npos ? lines.size() : end + 1);
    if (flag.empty()) continue;
    replace(flag, "{SDK}", places.sdk.string());
    replace(flag, "{HEADERS}", places.compiler_headers);
    constexpr std::string_view kShell = "SHELL:";  // several words, for CMake
    if (!flag.starts_with(kShell)) {
      flags.push_back(flag);
      continue;
    }
    flag.erase(0, kShell.size());
    for (std::size_t at = 0; at < flag.size();) {
      const auto space = std::min(flag.find(' ', at), flag.size());
      flags.push_back(flag.substr(at, space - at));
      at = space + 1;
    }
  }
  return flags;
}

}  // namespace softcell::toolchain
