#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace softcell::base {

/// All bytes of a file. Devices and pipes are refused: reading one might never end.
/// @param most_bytes  that it may have.
/// @throws std::runtime_error  naming the file and why it cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::uint64_t most_bytes);

}  // namespace softcell::base
