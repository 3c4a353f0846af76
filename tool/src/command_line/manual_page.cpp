#include "help_texts.h"

#include <string>
#include <vector>
#include "softcell/base/assert.h"

#include <fmt/format.h>

namespace softcell::tool {
namespace {

/// Writes text literally: no escape, no macro at the start of a line, and dashes that can be copied.
std::string plain(const std::string& text) {
  const bool like_a_macro = text.starts_with('.') || text.starts_with('\'');
  std::string result(like_a_macro ? "\\&" : "");
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '`') {
      result += "\\(ga";
    } else {
      result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) { return fmt::format("\\fB{}\\fR", plain(text)); }
std::string italic(const std::string& text) { return fmt::format("\\fI{}\\fR", plain(text)); }

std::string option_heading(const CommandOption& option) {
  std::string text;
  for (const std::string& name : option.names) {
    if (!text.empty()) text += ", ";
    text += option.positional ? italic(name) : bold(name);
  }
  if (!option.positional && !option.value.empty()) text += fmt::format(" {}", italic(option.value));
  if (option.repeated) text += " ...";
  return text;
}

/// The options that this option needs, and those that it excludes.
std::string conditions(const CommandOption& option) {
  std::string text;
  for (const std::string& name : option.needs) text += fmt::format("; needs {}", name);
  for (const std::string& name : option.excludes) text += fmt::format("; not with {}", name);
  return text;
}

std::string option_paragraphs(const std::vector<CommandOption>& options) {
  std::string text;
  for (const CommandOption& option : options)
    text +=
        fmt::format(".TP\n{}\n{}.\n", option_heading(option), plain(option.description + conditions(option)));
  return text;
}

std::string synopsis_of(const CommandLeaf& leaf) {
  SC_ASSERT(leaf.verb != nullptr, "no verb is at '{}'", leaf.path);
  std::string text = fmt::format("{} [options]", bold(fmt::format("softcell {}", leaf.path)));
  for (const CommandOption& option : leaf.verb->options) {
    if (!option.positional) continue;
    const std::string name = italic(option.names.front()) + (option.repeated ? "..." : "");
    text += option.required ? " " + name : fmt::format(" [{}]", name);
  }
  return text;
}

constexpr const char* kStatus =
    ".SH EXIT STATUS\n"
    ".TP\n0\nEverything asked for was done.\n"
    ".TP\n1\nA file, a kernel or the machine is at fault; one sentence on standard error says what was wrong "
    "and what was expected.\n"
    ".TP\n2\nWrong usage.\n"
    ".TP\n3\nA checked kernel has findings.\n"
    ".TP\n130\nInterrupted.\n";

constexpr const char* kExamples =
    ".SH EXAMPLES\n"
    ".TP\nThe 3D demo as a film\nsoftcell demo 3d \\-\\-headless \\-\\-scene arena \\-\\-video arena.mp4\n"
    ".TP\nYour own kernel on your own data\n"
    "softcell spu run saxpy.spu.elf \\-\\-in x=x.bin \\-\\-inout y=y.bin \\-\\-arg f32:2 @x @y 1024 1 0\n"
    ".TP\nWhat each SPE did when\n"
    "softcell demo 3d \\-\\-headless \\-\\-trace run.json && softcell report run.json \\-\\-out run.html\n";

}  // namespace

std::string manual_page(const CommandVerb& top, const std::string& version) {
  std::string page = fmt::format(".TH SOFTCELL 1 \"\" \"softcell {}\" \"User Commands\"\n", version);
  page += ".SH NAME\nsoftcell \\- run and check Cell/PS3 SPU kernels on a PC\n.SH SYNOPSIS\n";
  const std::vector<CommandLeaf> leaves = leaves_of(top);
  for (std::size_t i = 0; i < leaves.size(); ++i)
    page.append(i == 0 ? "" : ".br\n").append(synopsis_of(leaves[i])).append("\n");
  page += fmt::format(".SH DESCRIPTION\n{}\n", plain(top.description));
  page += fmt::format(".SH OPTIONS\n{}", option_paragraphs(top.options));
  page += ".SH COMMANDS\n";
  for (const CommandLeaf& leaf : leaves) {
    page += fmt::format(".SS softcell {}\n{}.\n{}", plain(leaf.path), plain(leaf.verb->description),
                        option_paragraphs(leaf.verb->options));
  }
  return page + kStatus + kExamples;
}

}  // namespace softcell::tool
