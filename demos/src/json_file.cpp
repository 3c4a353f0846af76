#include "json_file.h"

#include <nlohmann/json.hpp>

namespace softcell::demos {

void write_json(base::WholeFile& file, const nlohmann::ordered_json& document) {
  file.write(document.dump(2) + "\n");
  file.finish();
}

}  // namespace softcell::demos
