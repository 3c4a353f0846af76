#pragma once
// The command line as plain data: the one source of --help, the manual page and the shell completions.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace softcell::tool {

struct CommandOption {
  /// The names with their dashes, short ones first; a positional has one, without dashes.
  std::vector<std::string> names;
  /// The placeholder of its value: FILE, DIR, SCENE, "eager|lazy|random:SEED"; empty: a flag.
  std::string value;
  std::string description;
  bool positional = false;
  bool required = false;
  std::vector<std::string> needs{};     ///< it is refused without these
  std::vector<std::string> excludes{};  ///< it is refused together with these
  bool repeated = false;                ///< it takes several values
};

/// A verb with the verbs below it.
struct CommandVerb {
  std::string name;
  std::string description;
  std::vector<CommandOption> options;
  std::vector<CommandVerb> verbs;
};

/// The command line that the parser knows.
CommandVerb command_tree(const CLI::App& app);

/// The verbs that do something, each with its path from the top: "demo 3d".
struct CommandLeaf {
  std::string path;
  const CommandVerb* verb;
};
std::vector<CommandLeaf> leaves_of(const CommandVerb& top);

/// The words of a value that is a choice, "host|simulated"; a choice with an open part, "random:SEED", only up to the colon. Empty for all
/// other values.
std::vector<std::string> choices_of(const CommandOption& option);

}  // namespace softcell::tool
