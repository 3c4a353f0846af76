#pragma once
// Atomic files: a file that is written appears whole under its name, or not at all.

#include <sys/types.h>

#include <cstdio>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string_view>

namespace softcell::base {

/// An atomic file. It writes to a temporary file in the same folder and renames that file at the end. So nobody mistakes a half-written
/// file for a whole one, and two writers of one file never mix their bytes. A file that is replaced keeps its permissions, and a symbolic
/// link to it stays a link. Renaming cannot replace a device or a pipe: WholeFile writes to these directly, and opens them when the first
/// byte is written, because opening a pipe waits for its reader.
///
///   WholeFile file(path);
///   file.write(text);
///   file.commit();  // without it, no file is left
///
/// Every error is a std::runtime_error that names the file and says why it cannot be written. One thread uses
/// one object.
class WholeFile {
 public:
  /// Opens the temporary file beside `path`; a device or pipe is opened when the first byte is written.
  explicit WholeFile(std::filesystem::path path);
  /// Takes over a stream that is open already, as standard output is: written directly, and closed at the end.
  /// @param called  the name for error messages.
  WholeFile(std::FILE* stream, std::filesystem::path called);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  /// Appends bytes. @pre finish() was not called
  void write(std::string_view bytes);
  /// The open stream, for a library that writes to streams. Use it instead of write(); do not close it.
  /// @pre  finish() was not called
  std::FILE* stream();
  /// The path of the temporary file, or of the device or pipe, for a program that writes files by name. Use
  /// it instead of write(). It has the extension of the final name. Empty for a stream that was
  /// taken over.
  const std::filesystem::path& written_path() const { return temporary_.empty() ? place_ : temporary_; }

  /// Closes the temporary file, which keeps its name. If several files belong together, finish all of them before you commit the first:
  /// errors such as a full disk occur here.
  void finish();
  /// Calls finish() if it has not been called, and renames the temporary file to the final name. Call it once.
  void commit();

  /// Follows symbolic links to the file that they lead to, whether or not it exists; returns any other path
  /// as it is. Gives up after 40 links, as the kernel does.
  static std::filesystem::path behind_links(std::filesystem::path path);

 private:
  static constexpr std::size_t kNoName = static_cast<std::size_t>(-1);

  /// @param replaced  the status of the file that is replaced, whose permissions the new one gets; it may not
  ///                  exist.
  void open_temporary(const std::filesystem::file_status& replaced);
  void open_in_place();
  void discard();
  /// The name is known to remove_temporary_files_at() until it is forgotten.
  void remember_temporary();
  void forget_temporary();
  [[noreturn]] void fail(int error);

  std::filesystem::path path_;       ///< as passed by the caller
  std::filesystem::path place_;      ///< the path behind links, which is written or replaced
  std::filesystem::path temporary_;  ///< empty: none, because the file is written in place
  std::optional<mode_t> kept_mode_;  ///< the permissions of the file that is replaced
  std::FILE* file_ = nullptr;        ///< null: finished, or a device's or pipe's before the first byte
  std::size_t name_for_signals_ = kNoName;
  bool finished_ = false;
  bool settled_ = false;  ///< committed, or discarded
};

/// Has these signals remove the temporary files of this process before they end it, as they do by default; a signal that is ignored stays
/// so. It is for a command to call, when it starts: signals belong to the program. More than 64 files that are open at once are left.
void remove_temporary_files_at(std::initializer_list<int> signals);

/// Several atomic files that are committed together: none appears before all are written. Without commit(),
/// none appears.
class WholeFiles {
 public:
  /// @return  a reference that is valid as long as this object.
  /// @throws std::runtime_error  with the file and the reason why it cannot be written.
  WholeFile& open(const std::filesystem::path& file) { return files_.emplace_back(file); }
  /// Adds WholeFile(stream, called).
  WholeFile& open(std::FILE* stream, const std::filesystem::path& called) {
    return files_.emplace_back(stream, called);
  }
  /// Opens the file if there is a path. @return  null without one
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
