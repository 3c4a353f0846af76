#include "spu_programs/spu_executable.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace softcell::spu_programs {
namespace {

std::uint32_t number(const std::vector<std::uint8_t>& file, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | file.at(at + static_cast<std::size_t>(i));
  return value;
}

constexpr std::uint32_t kLoaded = 1;  // PT_LOAD

}  // namespace

std::vector<std::uint8_t> read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

SpuExecutable parse_executable(const std::vector<std::uint8_t>& file) {
  SpuExecutable executable;
  executable.entry = number(file, 24, 4);
  const std::uint32_t headers = number(file, 28, 4);
  const std::uint32_t header_bytes = number(file, 42, 2);
  const std::uint32_t count = number(file, 44, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t header = headers + std::size_t{i} * header_bytes;
    if (number(file, header, 4) != kLoaded) continue;
    const std::uint32_t offset = number(file, header + 4, 4);
    const std::uint32_t in_file = number(file, header + 16, 4);
    Segment segment{number(file, header + 8, 4), number(file, header + 20, 4), {}};
    for (std::uint32_t byte = 0; byte < in_file; ++byte) segment.bytes.push_back(file.at(offset + byte));
    executable.segments.push_back(std::move(segment));
  }
  return executable;
}

}  // namespace softcell::spu_programs
