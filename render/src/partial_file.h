#pragma once
// A file that is under construction: it has its final name only when it is whole.

#include <filesystem>

namespace softcell::render {

/// Owns a temporary name beside the final one (same directory, so that the rename cannot cross file systems;
/// same extension, which tells an encoder the format). Whatever lies under it is removed unless commit() was
/// called.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path final_path);
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Where to write. The final path itself when that exists and is no regular file: a device must not be
  /// replaced.
  const std::filesystem::path& path() const { return temporary_; }

  /// Gives the file its final name, replacing an older one. @throws std::runtime_error naming the file.
  void commit();

 private:
  std::filesystem::path final_;
  std::filesystem::path temporary_;
  bool owned_;  ///< the temporary file is ours to remove
};

}  // namespace softcell::render
