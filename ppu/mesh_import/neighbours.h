#pragma once
// Files that a mesh's file names: beside it or in folders below.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace softcell::ppu {

/// The bytes of a file that the mesh's file names; none: there is no such file in the mesh's folder or below.
/// @param name  with '/' between folders   @param most_bytes  the most bytes that it may have
/// @throws std::runtime_error  a sentence: it is larger, or cannot be read.
using ReadNeighbour =
    std::function<std::optional<std::string>(const std::string& name, std::uint64_t most_bytes)>;

/// Reads files below the folder of `mesh`, links followed. What is read is noted in `files`, which outlives
/// the function.
ReadNeighbour neighbours_of(const std::filesystem::path& mesh, std::vector<std::filesystem::path>& files);

}  // namespace softcell::ppu
