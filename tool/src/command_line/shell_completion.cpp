#include "help_texts.h"

#include <algorithm>
#include <string>
#include <vector>

#include "softcell/base/assert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace softcell::tool {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

std::string offer_words(const std::string& words) {
  return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", words);
}

/// The verb's name and those below it, without options.
CommandVerb names_only(const CommandVerb& verb) {
  CommandVerb names{verb.name, verb.description, {}, {}};
  for (const CommandVerb& below : verb.verbs) names.verbs.push_back(names_only(below));
  return names;
}

/// The tree with all verbs below `help` too: behind it their names are allowed, and nothing else.
CommandVerb with_verbs_behind_help(const CommandVerb& top) {
  const CommandVerb names = names_only(top);
  CommandVerb tree = top;
  for (CommandVerb& verb : tree.verbs) {
    if (verb.name != "help") continue;
    std::erase_if(verb.options, [](const CommandOption& option) { return option.positional; });
    verb.verbs = names.verbs;
  }
  return tree;
}

/// Whether the value is the name of a file. Nothing but the placeholder shows this.
bool is_file(const CommandOption& option) {
  return option.value == "PROGRAM" || option.value.find("FILE") != std::string::npos;
}

/// The shell commands with which bash finds the words for a value.
std::string value_action(const CommandOption& option) {
  const auto choices = choices_of(option);
  if (!choices.empty()) return offer_words(joined(choices));
  if (option.value == "DIR") return "_softcell_files -d \"$word\"";
  if (option.value == "SCENE") return "_softcell_scenes \"$word\" \"${verbs##* }\"";
  if (option.value == "KERNEL") return "_softcell_kernels \"$word\"";
  if (is_file(option)) return "_softcell_files -f \"$word\"";
  return "COMPREPLY=()";
}

/// One arm of the case over the path: first the values of the option before, then positional values, then options.
std::string leaf_arm(const CommandLeaf& leaf) {
  SC_ASSERT(leaf.verb != nullptr && !leaf.path.empty(), "no verb is at '{}'", leaf.path);
  std::string values, alone;
  std::vector<std::string> words;
  for (const CommandOption& option : leaf.verb->options) {
    if (option.positional) {
      const auto choices = choices_of(option);
      if (choices.empty()) alone = value_action(option);
      words.insert(words.end(), choices.begin(), choices.end());
      continue;
    }
    words.insert(words.end(), option.names.begin(), option.names.end());
    if (!option.value.empty())
      values += fmt::format("        {}) {}; return ;;\n", joined(option.names, "|"), value_action(option));
  }
  std::string text = fmt::format("    '{}')\n", leaf.path);
  if (!alone.empty()) text += fmt::format("      if [[ -n $positional ]]; then {}; return; fi\n", alone);
  if (!values.empty()) text += fmt::format("      case \"$before\" in\n{}      esac\n", values);
  if (!alone.empty()) text += fmt::format("      if [[ $word != -* ]]; then {}; return; fi\n", alone);
  return text + fmt::format("      {} ;;\n", offer_words(joined(words)));
}

/// Adds arms for paths that are not a whole verb yet: they offer the next words.
void add_branch_arms(const CommandVerb& verb, const std::string& path, std::string& text) {
  if (verb.verbs.empty()) return;
  std::vector<std::string> next;
  for (const CommandVerb& below : verb.verbs) next.push_back(below.name);
  for (const CommandOption& option : verb.options)
    next.insert(next.end(), option.names.begin(), option.names.end());
  text += fmt::format("    '{}') {} ;;\n", path, offer_words(joined(next)));
  for (const CommandVerb& below : verb.verbs)
    add_branch_arms(below, path.empty() ? below.name : fmt::format("{} {}", path, below.name), text);
}

/// Adds patterns of the words that extend a path, for the loop that reads it.
void add_paths(const CommandVerb& verb, const std::string& path, std::vector<std::string>& patterns) {
  for (const CommandVerb& below : verb.verbs) {
    const std::string longer = path.empty() ? below.name : fmt::format("{} {}", path, below.name);
    patterns.push_back(fmt::format("'{}'", longer));
    add_paths(below, longer, patterns);
  }
}

constexpr const char* kBashScript =
    R"bash(# Completion of softcell for bash: source it, or put it where bash-completion looks.
_softcell_files() {{
  local IFS=$'\n'
  COMPREPLY+=($(compgen "$1" -- "$2"))
}}
_softcell_names_and_files() {{
  COMPREPLY=($(compgen -W "$1" -- "$2"))
  _softcell_files -f "$2"
}}
_softcell_scenes() {{
  _softcell_names_and_files \
    "$(softcell scenes 2>/dev/null | awk -v dimension="$2" '$2 == dimension {{ print $1 }}')" "$1"
}}
_softcell_kernels() {{
  _softcell_names_and_files "$(softcell spu budget 2>/dev/null | awk 'NR > 1 {{ print $1 }}')" "$1"
}}
_softcell() {{
  # $verbs is not called $path: that is the search path of zsh, which runs this script, too.
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" verbs='' positional='' longer i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    longer="${{verbs:+$verbs }}${{COMP_WORDS[i]}}"
    case "$longer" in
      {}) verbs="$longer" ;;
      *) break ;;
    esac
  done
  for (( ; i < COMP_CWORD; ++i)); do
    if [[ ${{COMP_WORDS[i]}} == -- ]]; then positional=1; fi  # no option is behind it
  done
  if [[ $before == '=' ]]; then  # bash makes three words of --scene=arena, and of x=x.bin
    before="${{COMP_WORDS[COMP_CWORD-2]}}"
    if [[ $before != -* ]]; then _softcell_files -f "$word"; return; fi
  fi
  case "$verbs" in
{}  esac
}}
complete -o filenames -F _softcell softcell
)bash";

/// The text in single quotes, in fish's syntax.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\\' || c == '\'') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

/// The options of `complete` that state which words are allowed as a value. Where a command makes the words of -a, files are allowed as
/// well.
std::string fish_values(const CommandOption& option) {
  const auto choices = choices_of(option);
  if (!choices.empty()) return fmt::format(" -f -a {}", fish_quoted(joined(choices)));
  if (option.value == "DIR") return " -f -a '(__fish_complete_directories)'";
  if (option.value == "SCENE") return " -F -a '(__softcell_scenes)'";
  if (option.value == "KERNEL") return " -F -a '(__softcell_kernels)'";
  if (is_file(option)) return " -F";
  return " -f";
}

/// One line for an option or a positional argument of the verb at a path.
std::string fish_line(const std::string& path, const CommandOption& option) {
  std::string line = fmt::format("complete -c softcell -n \"__softcell_at {}\"", fish_quoted(path));
  if (option.positional) return line + fish_values(option) + "\n";
  for (const std::string& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  SC_ASSERT(std::ranges::all_of(option.names, [](const std::string& name) { return name.starts_with('-'); }),
            "an option of '{}' has a name without a dash", path);
  if (!option.value.empty()) line += " -r" + fish_values(option);
  return fmt::format("{} -d {}\n", line, fish_quoted(option.description));
}

void add_fish_lines(const CommandVerb& verb, const std::string& path, std::string& text) {
  for (const CommandVerb& below : verb.verbs)
    text += fmt::format("complete -c softcell -n \"__softcell_at {}\" -a {} -d {}\n", fish_quoted(path),
                        fish_quoted(below.name), fish_quoted(below.description));
  for (const CommandOption& option : verb.options) text += fish_line(path, option);
  for (const CommandVerb& below : verb.verbs)
    add_fish_lines(below, path.empty() ? below.name : fmt::format("{} {}", path, below.name), text);
}

constexpr const char* kFishScript =
    R"fish(# Completion of softcell for fish: source it, or put it into ~/.config/fish/completions/softcell.fish.
function __softcell_at
    set -l path ''
    for word in (commandline -opc)[2..]
        set -l longer (string trim -- "$path $word")
        contains -- $longer {}; or break
        set path $longer
    end
    test "$path" = "$argv[1]"
end
function __softcell_scenes
    set -l words (commandline -opc)
    softcell scenes 2>/dev/null | awk -v dimension="$words[3]" '$2 == dimension {{ print $1 }}'
end
function __softcell_kernels
    softcell spu budget 2>/dev/null | awk 'NR > 1 {{ print $1 }}'
end
complete -c softcell -f
{})fish";

}  // namespace

std::string bash_completion(const CommandVerb& top) {
  const CommandVerb tree = with_verbs_behind_help(top);
  std::vector<std::string> paths;
  add_paths(tree, "", paths);
  std::string arms;
  add_branch_arms(tree, "", arms);
  for (const CommandLeaf& leaf : leaves_of(tree)) arms += leaf_arm(leaf);
  return fmt::format(kBashScript, joined(paths, "|"), arms);
}

std::string zsh_completion(const CommandVerb& top) {
  return fmt::format("#compdef softcell\nautoload -Uz bashcompinit && bashcompinit\n{}",
                     bash_completion(top));
}

std::string fish_completion(const CommandVerb& top) {
  const CommandVerb tree = with_verbs_behind_help(top);
  std::vector<std::string> paths;
  add_paths(tree, "", paths);
  std::string lines;
  add_fish_lines(tree, "", lines);
  return fmt::format(kFishScript, joined(paths), lines);
}

}  // namespace softcell::tool
