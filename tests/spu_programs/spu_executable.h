#pragma once

// An SPU executable as the tests read it: the segments of a 32-bit big-endian ELF file, and nothing else of
// it. Made for files of this folder; a file that is none of them fails an assertion or gives nothing.

#include <cstdint>
#include <string>
#include <vector>

namespace softcell::spu_programs {

struct Segment {
  std::uint32_t address = 0;
  std::uint32_t bytes_in_memory = 0;
  std::vector<std::uint8_t> bytes;
};

struct SpuExecutable {
  std::uint32_t entry = 0;
  std::vector<Segment> segments;  // those that are loaded
};

/// The bytes of a file. @throws std::runtime_error  it cannot be read
std::vector<std::uint8_t> read_bytes(const std::string& path);

/// @throws std::out_of_range  the file is truncated
SpuExecutable parse_executable(const std::vector<std::uint8_t>& file);

}  // namespace softcell::spu_programs
