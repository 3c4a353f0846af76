#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace softcell::demos {

/// Writes the document; the file appears whole or not at all.
/// @throws std::runtime_error  naming the file and why it cannot be written.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& document);

}  // namespace softcell::demos
