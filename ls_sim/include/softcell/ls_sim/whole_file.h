#pragma once
// A file that appears whole or not at all.

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace softcell::ls_sim {

/// Written under a temporary name of its own in the same folder and renamed at the end, so that no
/// half-written file is left as if it were whole, and two writers of one file never mix their bytes. A file
/// that is replaced keeps its permissions, and a link to it stays a link. A device or a pipe is written to
/// directly, as it cannot be replaced by renaming, and opened at the first byte only, as a pipe's opening
/// waits for its reader.
///
///   WholeFile file(path);
///   file.write(text);
///   file.commit();  // without it nothing is left
///
/// Every error is a std::runtime_error that names the file and says why it cannot be written.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Before finish(). More than one call for a file of several parts.
  void write(std::string_view bytes);

  /// Ends the writing, the file still under its temporary name. Of several files that belong together, finish
  /// all before the first is committed: a full disk shows here.
  void finish();
  /// finish(), where that is not done yet, and the file takes its place.
  void commit();

  /// The file that a symbolic link stands for, through further links, also one that is not there yet; any
  /// other path itself. Links that go round in a circle are followed some way.
  static std::filesystem::path behind_links(std::filesystem::path path);

 private:
  /// @param replaced  the file whose permissions it keeps; there may be none.
  void open_temporary(const std::filesystem::file_status& replaced);
  void open_in_place();
  void discard();
  [[noreturn]] void fail(int error);

  std::filesystem::path path_;       ///< as the caller has it
  std::filesystem::path place_;      ///< that is written or replaced
  std::filesystem::path temporary_;  ///< empty: there is none, as when written in place
  std::FILE* file_ = nullptr;        ///< null: finished, or a device's or pipe's before the first byte
  bool settled_ = false;             ///< in its place, or discarded
};

}  // namespace softcell::ls_sim
