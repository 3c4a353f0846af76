#include "softcell/base/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace softcell::base {

TemporaryFolder::TemporaryFolder(std::string_view name) {
  std::error_code none;
  std::filesystem::path parent = std::filesystem::temp_directory_path(none);
  if (none) parent = "/tmp";  // TMPDIR names no folder, which GCC does not mind either
  std::string made = parent / (std::string(name) + "-XXXXXX");
  if (mkdtemp(made.data()) == nullptr)
    throw std::runtime_error("cannot make the temporary folder " + made + ": " + std::strerror(errno));
  path_ = made;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace softcell::base
