#include "softcell/ls_sim/whole_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace softcell::ls_sim {

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)), temporary_(path_) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path_, ignored);
  if (is_directory(status)) fail(EISDIR);
  const bool in_place = exists(status) && !is_regular_file(status);
  if (in_place) {
    if (access(path_.c_str(), W_OK) != 0) fail(errno);
    return;
  }
  temporary_ = temporary_name(path_);
  open();
}

WholeFile::~WholeFile() { discard(); }

std::filesystem::path WholeFile::temporary_name(const std::filesystem::path& path) {
  return path.string() + ".part";
}

void WholeFile::open() {
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ != nullptr) return;
  settled_ = true;  // whatever has that name is not of this file's making
  fail(errno);
}

void WholeFile::write(std::string_view bytes) {
  if (file_ == nullptr) open();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(errno);
}

void WholeFile::finish() {
  if (file_ != nullptr && std::fclose(std::exchange(file_, nullptr)) != 0) fail(errno);
}

void WholeFile::commit() {
  finish();
  if (temporary_ != path_ && std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(errno);
  settled_ = true;
}

void WholeFile::discard() {
  if (std::exchange(settled_, true)) return;
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  if (temporary_ != path_) std::remove(temporary_.c_str());
}

void WholeFile::fail(int error) {
  discard();
  throw std::runtime_error("cannot write " + path_.string() + ": " + std::strerror(error));
}

}  // namespace softcell::ls_sim
