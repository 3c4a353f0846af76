#include "softcell/ls_sim/whole_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace softcell::ls_sim {

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code ignored;
  const bool in_place =
      std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored);
  temporary_ = in_place ? path_ : std::filesystem::path(path_.string() + ".part");
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ == nullptr) {
    throw std::runtime_error("cannot write " + path_.string() + ": " + std::strerror(errno));
  }
}

WholeFile::~WholeFile() { discard(); }

void WholeFile::write(std::string_view bytes) {
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
