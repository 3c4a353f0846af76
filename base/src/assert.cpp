#include "softcell/base/assert.h"

#include <cstdio>
#include <cstdlib>

namespace softcell::base::assertion {

void fail(const Location& location, std::string_view message,
          std::initializer_list<std::string> values) noexcept {
  std::string text;
  const std::string* value = values.begin();
  for (std::size_t at = message.find("{}"); at != message.npos; at = message.find("{}")) {
    text += message.substr(0, at);
    text += *value++;
    message.remove_prefix(at + 2);
  }
  text += message;
  std::fprintf(stderr, "%s:%d: %s: SC_ASSERT(%s) does not hold: %s\n", location.file, location.line,
               location.function, location.condition, text.c_str());
  std::abort();
}

}  // namespace softcell::base::assertion
