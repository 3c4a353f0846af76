#include "json_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace softcell::demos {

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& document) {
  const auto fail = [&](int error) {
    throw std::runtime_error("cannot write " + path.string() + ": " + std::strerror(error));
  };
  // A device or a pipe is written to directly: it cannot be replaced by renaming.
  std::error_code ignored;
  const bool in_place =
      std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
  const std::filesystem::path temporary = in_place ? path : std::filesystem::path(path.string() + ".part");
  const std::string text = document.dump(2) + "\n";
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail(errno);
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int write_error = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed || (!in_place && std::rename(temporary.c_str(), path.c_str()) != 0)) {
    const int error = written ? errno : write_error;
    if (!in_place) std::remove(temporary.c_str());
    fail(error);
  }
}

}  // namespace softcell::demos
