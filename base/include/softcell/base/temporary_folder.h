#pragma once
// A folder for temporary files.

#include <filesystem>
#include <string_view>

namespace softcell::base {

/// A new folder in TMPDIR or, if that names no folder, in /tmp. The destructor removes it with all that is in it.
class TemporaryFolder {
 public:
  /// @param name  what the folder's name begins with.
  /// @throws std::runtime_error  it cannot be made; the message names it.
  explicit TemporaryFolder(std::string_view name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Where it lies.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace softcell::base
