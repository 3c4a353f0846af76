#include "ppu/mesh_import/neighbours.h"

#include <algorithm>
#include <cstddef>
#include <system_error>

#include "softcell/base/read_file.h"

namespace softcell::ppu {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [rest, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return rest == folder.end();
}

}  // namespace

ReadNeighbour neighbours_of(const fs::path& mesh, std::vector<fs::path>& files) {
  return [folder = mesh.has_parent_path() ? mesh.parent_path() : fs::path("."), &files](
             const std::string& name, std::uint64_t most_bytes) -> std::optional<std::string> {
    const fs::path named(name);
    if (name.empty() || name.find('\0') != std::string::npos || named.is_absolute()) return std::nullopt;
    std::error_code error;
    const fs::path home = fs::canonical(folder, error);
    if (error) return std::nullopt;
    const fs::path found = fs::canonical(folder / named, error);  // links followed
    if (error || !is_below(found, home) || !fs::is_regular_file(found, error)) return std::nullopt;
    const std::vector<std::byte> bytes = base::read_file(found, most_bytes);
    files.push_back(found);
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
}

}  // namespace softcell::ppu
