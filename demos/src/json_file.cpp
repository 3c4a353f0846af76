#include "json_file.h"

#include <nlohmann/json.hpp>

#include "softcell/ls_sim/whole_file.h"

namespace softcell::demos {

void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& document) {
  ls_sim::WholeFile file(path);
  file.write(document.dump(2) + "\n");
  file.commit();
}

}  // namespace softcell::demos
