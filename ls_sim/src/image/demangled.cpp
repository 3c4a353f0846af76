#include "demangled.h"
#include "softcell/base/assert.h"

#include <cxxabi.h>

#include <cstdlib>

namespace softcell::ls_sim {

std::string demangled(std::string_view symbol) {
  constexpr std::size_t kLongestName = 1024;  // a longer one stays as it is
  std::string name(symbol);
  if (name.size() > kLongestName) return name;
  int status = 0;
  char* const text = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  SC_ASSERT(status != 0 || text != nullptr, "a name of {} characters is demangled to nothing", name.size());
  if (status == 0) name = text;
  std::free(text);
  return name;
}

}  // namespace softcell::ls_sim
