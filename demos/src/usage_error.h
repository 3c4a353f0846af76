#pragma once

#include <stdexcept>

namespace softcell::demos {

/// The command was called in a way that it does not have: exit status 2. Anything else that goes wrong is a
/// std::runtime_error: exit status 1.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softcell::demos
