#include "usage_sentence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <vector>

#include "command_tree.h"
#include "softcell/base/assert.h"
#include "softcell/base/nearest_name.h"

namespace softcell::tool {
namespace {

/// The verbs that were called, the topmost first.
std::vector<const CLI::App*> called(const CLI::App& top) {
  std::vector<const CLI::App*> chain{&top};
  for (auto below = top.get_subcommands(); !below.empty(); below = chain.back()->get_subcommands())
    chain.push_back(below.back());
  return chain;
}

std::string unknown_option(const std::string& verb, const CommandVerb& tree, const std::string& argument) {
  const std::string name = argument.substr(0, argument.find('='));
  std::vector<std::string_view> known;
  for (const CommandOption& option : tree.options) {
    if (option.positional) continue;
    for (const std::string& known_name : option.names) {
      if (known_name.starts_with("--")) known.push_back(known_name);
    }
  }
  // In a short name every letter is similar to every other.
  const std::string_view nearest = name.size() > 2 ? base::nearest_name(name, known) : std::string_view();
  return fmt::format("{} has no option {}{}", verb, name,
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

/// The verb that is most likely meant; empty if none is similar. In a name of one or two letters every letter is similar to every other.
std::string_view likely_verb(const std::string& argument, const std::vector<std::string_view>& known) {
  return argument.size() > 2 ? base::nearest_name(argument, known) : std::string_view();
}

std::string one_argument_too_many(const std::string& verb, const CommandVerb& tree,
                                  const std::string& argument) {
  std::vector<std::string> taken;
  for (const CommandOption& option : tree.options) {
    if (option.positional) taken.push_back(option.names.front());
  }
  return fmt::format(
      "the argument '{}' is one too many: {} takes {}", argument, verb,
      taken.empty() ? "nothing but options" : fmt::format("{} and options", fmt::join(taken, ", ")));
}

/// @param argument  the argument that no option or verb takes.
std::string unexpected(const std::string& verb, const CLI::App& app, const std::string& argument) {
  const CommandVerb tree = command_tree(app);
  if (argument.starts_with('-')) return unknown_option(verb, tree, argument);
  if (!tree.verbs.empty()) return unknown_verb(verb, app, argument);
  return one_argument_too_many(verb, tree, argument);
}

std::string needs_value(const CLI::Option& option) {
  return fmt::format("{} needs a value: {}", option.get_name(), option.get_type_name());
}

/// The message about the option that the parser names, if it has too many or too few values; empty if the parser names none.
std::string wrong_count(const CLI::App& app, const std::string& what) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (!what.starts_with(name + ": ")) continue;
    if (what.ends_with(" missing")) return needs_value(*option);
    return fmt::format("{} is given {} times; give it once", name, option->count());
  }
  return {};
}

}  // namespace

std::string unknown_verb(const std::string& verb, const CLI::App& app, const std::string& argument) {
  SC_ASSERT(!verb.empty(), "'{}' is a command of a verb without a name", argument);
  const CommandVerb tree = command_tree(app);
  std::vector<std::string_view> known;
  for (const CommandVerb& below : tree.verbs) known.push_back(below.name);
  if (known.empty()) return fmt::format("{} has no commands below it, and no '{}'", verb, argument);
  const std::string_view likely = likely_verb(argument, known);
  return fmt::format("{} has no command '{}'; {}", verb, argument,
                     likely.empty() ? fmt::format("there are: {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean {}?", likely));
}

std::string called_verb(const CLI::App& top) {
  std::string path;
  for (const CLI::App* verb : called(top)) path += (path.empty() ? "" : " ") + verb->get_name();
  return path;
}

std::string usage_sentence(const CLI::App& top, const CLI::ParseError& error) {
  const CLI::App& app = *called(top).back();
  const std::string verb = called_verb(top), what = error.what();
  const bool misses = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  // A misspelled option may be the reason why a required one is missing.
  if (misses || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const auto left = top.remaining(true); !left.empty()) return unexpected(verb, app, left.front());
  }
  constexpr std::string_view kIsRequired = " is required";
  if (misses && what.ends_with(kIsRequired))
    return fmt::format("{} needs {}", verb, what.substr(0, what.size() - kIsRequired.size()));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    if (const std::string sentence = wrong_count(app, what); !sentence.empty()) return sentence;
  }
  return what;
}

std::optional<std::string> left_out_sentence(const CLI::App& top,
                                             std::span<const std::string_view> left_out) {
  const auto left = top.remaining(true);
  if (!top.get_subcommands().empty() || left.empty() || !std::ranges::count(left_out, left.front()))
    return {};
  return fmt::format("this softcell is built without demos: {}", unknown_verb("it", top, left.front()));
}

std::optional<std::string> more_behind_help(const CLI::App& top, int argc, const char* const* argv) {
  const CLI::App& app = *called(top).back();
  for (const std::string& rest : top.remaining(true)) {
    if (!rest.starts_with('-')) continue;
    const std::string whole = "-h" + rest.substr(1);
    if (std::find(argv, argv + argc, whole) != argv + argc)
      return unknown_option(called_verb(top), command_tree(app), whole);
  }
  return {};
}

std::optional<std::string> empty_value(const CLI::App& top) {
  for (const CLI::App* app : called(top)) {
    for (const CLI::Option* option : app->get_options()) {
      if (option->get_positional() || option->get_expected_max() == 0 || option->get_type_name() == "REGEX")
        continue;
      const auto& values = option->results();
      if (std::find(values.begin(), values.end(), "") != values.end()) return needs_value(*option);
    }
  }
  return {};
}

std::string verbs_sentence(const CLI::App& top) {
  SC_ASSERT(called_verb(top).starts_with(top.get_name()), "'{}' is no verb of {}", called_verb(top),
            top.get_name());
  std::string path = called_verb(top).substr(top.get_name().size());
  if (!path.empty()) path = path.substr(1) + " ";
  std::vector<std::string> verbs;
  for (const CommandLeaf& leaf : leaves_of(command_tree(*called(top).back())))
    verbs.push_back(path + leaf.path);
  return fmt::format("say what to do: {}", fmt::join(verbs, ", "));
}

}  // namespace softcell::tool
