#include "read_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>

namespace softcell::demos {

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error("cannot read " + path.string() + ": " + why);
  };
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored)) refuse("it is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(std::strerror(errno));
  const std::vector<char> characters{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) refuse("the host reports an error");
  const auto bytes = std::as_bytes(std::span(characters));
  return {bytes.begin(), bytes.end()};
}

}  // namespace softcell::demos
