#include "link.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "compile.h"
#include "toolchain_settings.h"

namespace softcell::toolchain {
namespace {

constexpr std::uint32_t kLocalStoreBytes = 0x40000;
constexpr std::uint32_t kNoBudget = 0x7FFF'FFFF;
constexpr std::uint32_t kLeastStack = 4096, kMostStack = 0x20000;

void append(Words& to, const Words& words) { to.insert(to.end(), words.begin(), words.end()); }

/// Extracts the checked build of an object. @return  false: the object has none
bool extract_checked(const std::string& object, const std::filesystem::path& to) {
  const Words command{"objcopy", "--dump-section", std::string(kCheckedSection) + "=" + to.string(), object,
                      "/dev/null"};
  return run(command, true) == 0 && std::filesystem::exists(to);
}

/// Makes an archive of the checked builds of an archive's members.
bool extract_checked_archive(const std::filesystem::path& archive, const std::filesystem::path& to,
                             ScratchFolder& scratch) {
  const std::filesystem::path members = scratch.file("members");
  std::filesystem::create_directory(members);
  run_or_fail({"ar", "x", "--output=" + members.string(), archive.string()});
  Words command{"ar", "rcs", to.string()};
  for (const auto& member : std::filesystem::directory_iterator(members)) {
    const auto checked = scratch.file(member.path().filename());
    if (!extract_checked(member.path(), checked)) return false;
    command.push_back(checked);
  }
  run_or_fail(command);
  return true;
}

/// The files replaced by their checked builds. @return  none: `missing` has no checked build
Words checked_files(const Words& files, ScratchFolder& scratch, std::string& missing) {
  Words checked;
  for (const std::string& file : files) {
    const std::filesystem::path path(file);
    const auto to = scratch.file(path.filename());
    const bool found =
        path.extension() == ".a" ? extract_checked_archive(path, to, scratch) : extract_checked(file, to);
    if (!found) {
      missing = file;
      return {};
    }
    checked.push_back(to);
  }
  return checked;
}

/// Links one build. @param quiet  drops the linker's messages. @param budget  for image and stack. @return  the linker's status.
int link_build(const Words& files, const std::filesystem::path& output, bool checked, std::uint32_t stack,
               const Options& options, const Places& places, bool quiet,
               std::uint32_t budget = kLocalStoreBytes) {
  Words command{settings::kLinker,
                "-m",
                "elf32_x86_64",
                "-pie",
                "--no-dynamic-linker",
                "-T",
                (places.sdk / "ls.ld").string()};
  const auto define = [&](const std::string& symbol, std::uint32_t value) {
    append(command, {"--defsym", symbol + "=" + std::to_string(value)});
  };
  define("softcell_stack_bytes", stack);
  define("softcell_budget_bytes", budget);
  define("softcell_is_checked", checked ? 1 : 0);
  define("softcell_is_program", 1);
  define("softcell_image_begin", 0x80);
  append(command, {"--emit-relocs", "--build-id=none", "-z", "noexecstack", "--no-warn-rwx-segments", "-z",
                   "max-page-size=128"});
  append(command, options.symbols);
  if (!checked) append(command, options.linker);
  append(command, files);
  append(command, {"-e", "softcell_start", "--gc-sections", "-z", "muldefs", "-u", "softcell_start"});
  if (checked) {
    // Only the library may need the reports: a program may be one that accesses nothing itself.
    append(command, {"--start-group", places.access_reports, places.checked_library, "--end-group"});
  } else {
    command.push_back(places.library);
  }
  append(command, {"-o", output.string()});
  return run(command, quiet);
}

/// The address at which the image ends and the free space begins.
std::uint32_t end_of(const std::filesystem::path& image) {
  const std::string symbols = output_of({"nm", image.string()});
  std::istringstream lines(symbols);
  for (std::string line; std::getline(lines, line);) {
    if (!line.ends_with(" _end")) continue;
    return static_cast<std::uint32_t>(std::strtoul(line.c_str(), nullptr, 16));
  }
  throw std::runtime_error(image.string() + " has no symbol _end");
}

/// The size of the stack: stack and heap get half each of the space that the image leaves free.
std::uint32_t stack_beside(const std::filesystem::path& image) {
  const std::uint32_t free = kLocalStoreBytes - std::min(end_of(image), kLocalStoreBytes);
  return std::clamp(free / 2 / 16 * 16, kLeastStack, kMostStack);
}

/// Call it after a link that has failed. If the program is too large, it says so with numbers; else the linker says what is wrong.
void refuse_if_too_large(const Words& files, const std::filesystem::path& output, std::uint32_t stack,
                         const Options& options, const Places& places) {
  if (link_build(files, output, false, stack, options, places, true, kNoBudget) != 0) return;
  const std::uint64_t image = end_of(output), all = image + stack;
  std::filesystem::remove(output);
  if (all <= kLocalStoreBytes) return;
  throw std::runtime_error("the program does not fit into the local store: code and data take " +
                           std::to_string(image) + " bytes and the stack " + std::to_string(stack) + ", " +
                           std::to_string(all - kLocalStoreBytes) + " more than its " +
                           std::to_string(kLocalStoreBytes));
}

std::uint32_t least_stack(bool checked, const Options& options) {
  return options.stack_bytes.value_or(kLeastStack) + (checked ? settings::kCheckedStackBytes : 0);
}

/// Links a build with the largest stack for which there is room. @return  the linker's status.
int link_with_stack(const Words& files, const std::filesystem::path& output, bool checked,
                    const Options& options, const Places& places, bool quiet) {
  const std::uint32_t least = least_stack(checked, options);
  // Quiet, because the link that follows prints the linker's messages.
  const int status = link_build(files, output, checked, least, options, places, true);
  if (status != 0 && !quiet) refuse_if_too_large(files, output, least, options, places);
  if (status != 0 || options.stack_bytes)
    return link_build(files, output, checked, least, options, places, quiet);
  const std::uint32_t stack = stack_beside(output);
  return link_build(files, output, checked, stack, options, places, quiet);
}

void link_object(const Words& files, const std::filesystem::path& output) {
  Words command{settings::kLinker, "-m", "elf32_x86_64", "-r", "--no-warn-execstack", "-o", output.string()};
  append(command, files);
  run_or_fail(command);
}

}  // namespace

void link(const Words& files, const std::filesystem::path& output, const Options& options,
          const Places& places, ScratchFolder& scratch) {
  std::string missing;
  const Words checked = checked_files(files, scratch, missing);
  const auto checked_output = scratch.file("checked.elf");
  if (options.relocatable) {
    link_object(files, output);
    if (missing.empty()) {
      link_object(checked, checked_output);
      add_section(output, kCheckedSection, checked_output);
    }
    return;
  }
  // A program's functions win over those of the library that have the same name, so the linker lets names be defined twice. What the
  // program itself defines twice shows when its files are linked alone.
  link_object(files, scratch.file("alone.o"));
  const auto whole = scratch.file("program.elf");
  if (const int status = link_with_stack(files, whole, false, options, places, false); status != 0)
    throw Failed{status};
  const bool has_checked =
      missing.empty() && link_with_stack(checked, checked_output, true, options, places, true) == 0;
  if (has_checked) {
    add_section(whole, kCheckedSection, checked_output);
  } else {
    std::string why = missing + " has none";
    if (missing.empty()) {
      // Where it does not link without a budget either, the linker says why.
      const bool links = link_build(checked, checked_output, true, least_stack(true, options), options,
                                    places, false, kNoBudget) == 0;
      why = links ? "it does not fit into a local store" : "it does not link";
    }
    std::fprintf(stderr, "softcell-spu-ld: note: %s gets no checked image: %s\n", output.c_str(),
                 why.c_str());
  }
  const auto name = scratch.file("name");
  std::ofstream(name) << output.stem().string();
  add_section(whole, ".softcell.name", name);
  std::error_code error;
  std::filesystem::copy_file(whole, output, std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw std::runtime_error("cannot write " + output.string() + ": " + error.message());
  std::filesystem::permissions(output, std::filesystem::status(whole).permissions());
}

}  // namespace softcell::toolchain
