#pragma once
// What the tests of the command share.

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace softcell::tests {

/// A short run without a window.
inline constexpr const char* kDrop = "demo 3d --headless --scene drop --size 64x48 ";

inline nlohmann::json read_json(const std::string& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

inline void write_file(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A cube as an OBJ file.
inline const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

}  // namespace softcell::tests
