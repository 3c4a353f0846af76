#pragma once
// Files that appear whole or not at all.

#include <sys/types.h>

#include <cstdio>
#include <deque>
#include <filesystem>
#include <optional>
#include <string_view>

namespace softcell::base {

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
  /// Takes over a stream that is open already, as standard output is: written directly, and closed at the end.
  /// @param called  what errors call it.
  WholeFile(std::FILE* stream, std::filesystem::path called);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Before finish(). More than one call for a file of several parts.
  void write(std::string_view bytes);
  /// In place of write(), for a library that writes to streams: the file's. Not to be closed.
  std::FILE* stream();
  /// In place of write(), for a program that writes files by name: the temporary name, which ends as the
  /// file's own does, or that of a device or pipe. Empty for a stream that was taken over.
  const std::filesystem::path& written_path() const { return temporary_.empty() ? place_ : temporary_; }

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
  std::optional<mode_t> kept_mode_;  ///< the permissions of the file that is replaced
  std::FILE* file_ = nullptr;        ///< null: finished, or a device's or pipe's before the first byte
  bool finished_ = false;
  bool settled_ = false;  ///< in its place, or discarded
};

/// Files that take their places together: none before all are written. Without commit() nothing is left.
class WholeFiles {
 public:
  /// @return  good as long as this. @throws std::runtime_error  naming the file and why it cannot be written.
  WholeFile& open(const std::filesystem::path& file) { return files_.emplace_back(file); }
  WholeFile& open(std::FILE* stream, const std::filesystem::path& called) {
    return files_.emplace_back(stream, called);
  }
  /// Null when none is asked for.
  WholeFile* open(const std::optional<std::filesystem::path>& file) { return file ? &open(*file) : nullptr; }

  /// @throws std::runtime_error  naming the file that cannot be written.
  void commit() {
    for (WholeFile& file : files_) file.finish();
    for (WholeFile& file : files_) file.commit();
  }

 private:
  std::deque<WholeFile> files_;
};

}  // namespace softcell::base
