#include "softcell/base/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"

namespace softcell::base {
namespace {

constexpr std::uint64_t kBytesAtOnce = 1 << 20;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error("cannot read " + path.string() + ": " + why);
}

void check_kind(const std::filesystem::path& path) {
  std::error_code ignored;  // a file whose kind the host does not tell fails to open, too
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (status.type() == std::filesystem::file_type::not_found) refuse(path, "there is no such file");
  if (std::filesystem::is_directory(status)) refuse(path, "it is a directory");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    refuse(path, "it is not a regular file");
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t most_bytes) {
  SC_ASSERT(most_bytes < std::numeric_limits<std::uint64_t>::max(), "no limit for {}", path);
  check_kind(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, std::strerror(errno));
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > most_bytes)
    refuse(path, "it has " + std::to_string(size) + " bytes, and may have " + std::to_string(most_bytes) +
                     " at most");
  std::vector<std::byte> bytes;
  if (!error) bytes.reserve(size + kBytesAtOnce);
  // By what is read, not by the size that was seen: a file may grow, and those of /proc say 0.
  while (file) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + std::min(kBytesAtOnce, most_bytes + 1 - begin));
    file.read(reinterpret_cast<char*>(bytes.data() + begin),
              static_cast<std::streamsize>(bytes.size() - begin));
    bytes.resize(begin + static_cast<std::size_t>(file.gcount()));
    if (bytes.size() > most_bytes)
      refuse(path, "it has more than the " + std::to_string(most_bytes) + " bytes that it may have");
  }
  if (file.bad()) refuse(path, "the host reports an error");
  return bytes;
}

}  // namespace softcell::base
