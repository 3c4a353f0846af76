#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace softcell::base {

/// Reads all bytes of a file. Refuses devices and pipes, because reading one might never end. Any thread.
/// @param most_bytes  the most bytes that the file may have.
/// @throws std::runtime_error  a sentence with the file and the reason why it cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t most_bytes);

}  // namespace softcell::base
