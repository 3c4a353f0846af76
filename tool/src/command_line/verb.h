#pragma once
// The interface by which a verb adds itself to the command line.

#include <functional>
#include <memory>
#include <vector>

namespace CLI {
class App;
}

namespace softcell::tool {

/// Does what the command line asks for, and prints its result on standard output. Returns the exit status.
/// @throws UsageError (exit status 2) or another std::exception (exit status 1), one sentence either way.
using Call = std::function<int()>;

/// One verb, or several below a common one. It keeps the values of its options, so it must outlive the parser.
class Verb {
 public:
  Verb() = default;
  virtual ~Verb() = default;
  Verb(const Verb&) = delete;
  Verb& operator=(const Verb&) = delete;

  /// Adds the verb to the parser.
  /// @param chosen  becomes the verb's call if the command line names the verb; must outlive this object
  virtual void add_to(CLI::App& command, Call& chosen) = 0;
};

using Verbs = std::vector<std::unique_ptr<Verb>>;

}  // namespace softcell::tool
