#include "command_tree.h"
#include "softcell/base/assert.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

namespace softcell::tool {
namespace {

/// Sorted, because the parser has the options in the order of their addresses.
std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

CommandOption command_option(const CLI::Option& option) {
  CommandOption result;
  result.description = option.get_description();
  result.required = option.get_required();
  result.positional = option.get_positional();
  if (result.positional) {
    result.names = {option.get_name()};
  } else {
    for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  }
  SC_ASSERT(!result.names.empty() && !result.description.empty(), "an option described as '{}' has {} names",
            result.description, result.names.size());
  if (option.get_expected_max() > 0) result.value = option.get_type_name();
  result.repeated = option.get_expected_max() > 1;
  result.needs = names_of(option.get_needs());
  result.excludes = names_of(option.get_excludes());
  return result;
}

void add_leaves(const CommandVerb& verb, const std::string& path, std::vector<CommandLeaf>& leaves) {
  if (verb.verbs.empty()) leaves.push_back({path, &verb});
  for (const CommandVerb& below : verb.verbs) add_leaves(below, path + " " + below.name, leaves);
}

}  // namespace

CommandVerb command_tree(const CLI::App& app) {
  CommandVerb verb{app.get_name(), app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) verb.options.push_back(command_option(*option));
  for (const CLI::App* below : app.get_subcommands(nullptr)) verb.verbs.push_back(command_tree(*below));
  SC_ASSERT(!verb.name.empty() && !verb.description.empty(), "a verb '{}' described as '{}'", verb.name,
            verb.description);
  return verb;
}

std::vector<CommandLeaf> leaves_of(const CommandVerb& top) {
  std::vector<CommandLeaf> leaves;
  for (const CommandVerb& verb : top.verbs) add_leaves(verb, verb.name, leaves);
  SC_ASSERT(!leaves.empty(), "the command {} has no verbs", top.name);
  return leaves;
}

std::vector<std::string> choices_of(const CommandOption& option) {
  if (option.value.find('|') == std::string::npos) return {};
  std::vector<std::string> choices;
  std::string word;
  for (const char c : option.value + "|") {
    if (c != '|') {
      word += c;
      continue;
    }
    const std::size_t colon = word.find(':');
    choices.push_back(colon == std::string::npos ? word : word.substr(0, colon + 1));
    word.clear();
  }
  return choices;
}

}  // namespace softcell::tool
