#pragma once

#include <nlohmann/json_fwd.hpp>

#include "softcell/base/whole_file.h"

namespace softcell::demos {

/// Writes the document, all that is in the file, which the caller commits.
/// @throws std::runtime_error  naming the file and why it cannot be written.
void write_json(base::WholeFile& file, const nlohmann::ordered_json& document);

}  // namespace softcell::demos
