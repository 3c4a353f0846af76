#include "shell_completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace softcell::demos {
namespace {

std::string joined(const std::vector<std::string>& words, const char* between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

std::string offer_words(const std::string& words) {
  return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", words);
}

/// How bash finds the words for a value.
std::string value_action(const CommandOption& option) {
  const auto choices = choices_of(option);
  if (!choices.empty()) return offer_words(joined(choices));
  if (option.value == "DIR") return "COMPREPLY=($(compgen -d -- \"$word\"))";
  if (option.value == "SCENE") return "_softcell_scenes \"$word\" \"${path##* }\"";
  if (option.value.find("FILE") != std::string::npos) return "COMPREPLY=($(compgen -f -- \"$word\"))";
  return "COMPREPLY=()";
}

/// One arm of the case over the path: values of the option before, then what stands alone, then options.
std::string leaf_arm(const CommandLeaf& leaf) {
  std::string values;
  std::vector<std::string> words;
  bool takes_file = false;
  for (const CommandOption& option : leaf.verb->options) {
    if (option.positional) {
      takes_file = option.value == "FILE";
      for (const std::string& choice : choices_of(option)) words.push_back(choice);
      continue;
    }
    words.insert(words.end(), option.names.begin(), option.names.end());
    if (!option.value.empty())
      values += fmt::format("        {}) {}; return ;;\n", joined(option.names, "|"), value_action(option));
  }
  std::string text = fmt::format("    '{}')\n", leaf.path);
  if (!values.empty()) text += fmt::format("      case \"$before\" in\n{}      esac\n", values);
  if (takes_file)
    text += "      if [[ $word != -* ]]; then COMPREPLY=($(compgen -f -- \"$word\")); return; fi\n";
  return text + fmt::format("      {} ;;\n", offer_words(joined(words)));
}

/// Arms for what is not a whole verb yet: the words that come next.
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

/// Patterns of the words that make a path longer, for the loop that reads it.
void add_paths(const CommandVerb& verb, const std::string& path, std::vector<std::string>& patterns) {
  for (const CommandVerb& below : verb.verbs) {
    const std::string longer = path.empty() ? below.name : fmt::format("{} {}", path, below.name);
    patterns.push_back(fmt::format("'{}'", longer));
    add_paths(below, longer, patterns);
  }
}

constexpr const char* kBashScript =
    R"bash(# Completion of softcell for bash: source it, or put it where bash-completion looks.
_softcell_scenes() {{
  local names="$(softcell scenes 2>/dev/null | awk -v dimension="$2" '$2 == dimension {{ print $1 }}')"
  COMPREPLY=($(compgen -W "$names" -- "$1") $(compgen -f -- "$1"))
}}
_softcell() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" path='' longer i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    longer="${{path:+$path }}${{COMP_WORDS[i]}}"
    case "$longer" in
      {}) path="$longer" ;;
      *) break ;;
    esac
  done
  case "$path" in
{}  esac
}}
complete -o filenames -F _softcell softcell
)bash";

}  // namespace

std::string bash_completion(const CommandVerb& top) {
  std::vector<std::string> paths;
  add_paths(top, "", paths);
  std::string arms;
  add_branch_arms(top, "", arms);
  for (const CommandLeaf& leaf : leaves_of(top)) arms += leaf_arm(leaf);
  return fmt::format(kBashScript, joined(paths, "|"), arms);
}

std::string zsh_completion(const CommandVerb& top) {
  return fmt::format("#compdef softcell\nautoload -Uz bashcompinit && bashcompinit\n{}",
                     bash_completion(top));
}

}  // namespace softcell::demos
