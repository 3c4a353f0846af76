#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace softcell::demos {

/// All bytes of a file. @throws std::runtime_error  naming the file and why it cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path& path);

}  // namespace softcell::demos
