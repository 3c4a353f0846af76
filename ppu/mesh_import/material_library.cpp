#include "ppu/mesh_import/material_library.h"

#include <algorithm>

#include "ppu/mesh_import/mesh_file_check.h"
#include "ppu/mesh_import/mesh_file_text.h"

namespace softcell::ppu {
namespace {

/// "Kd r g b", or "Kd r" for a grey. "Kd spectral FILE" and "Kd xyz X Y Z" give no colour.
std::optional<Eigen::Vector3f> colour_of(const LineReader& lines) {
  const auto& words = lines.words();
  if (words.size() > 1 && (words[1] == "spectral" || words[1] == "xyz")) return std::nullopt;
  if (words.size() != 2 && words.size() != 4) lines.refuse("'Kd' is not followed by one number or three");
  Eigen::Vector3f colour;
  for (int channel = 0; channel < 3; ++channel) {
    const auto word = static_cast<std::size_t>(words.size() == 4 ? 1 + channel : 1);
    colour[channel] = static_cast<float>(std::clamp(lines.finite_number(words[word]), 0.0, 1.0));
  }
  return colour;
}

/// "map_Kd [options] FILE". A name that follows options is one word.
std::string texture_of(const LineReader& lines) {
  const auto& words = lines.words();
  if (words.size() < 2) lines.refuse("'map_Kd' is not followed by the name of a file");
  return words[1].starts_with('-') ? mesh_part_name({words.end() - 1, words.end()})
                                   : mesh_part_name({words.begin() + 1, words.end()});
}

}  // namespace

MaterialLibrary parse_material_library(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) refuse("it holds binary data; a material library is text");
  MaterialLibrary library;
  Material* material = nullptr;
  for (LineReader lines(text, true); lines.next();) {
    const auto& words = lines.words();
    if (words[0] == "newmtl") {
      material = &library[mesh_part_name({words.begin() + 1, words.end()})];
      *material = {};
    } else if (words[0] == "Kd" || words[0] == "map_Kd") {
      if (material == nullptr) lines.refuse(in_quotes(words[0]) + " comes before the first 'newmtl'");
      if (words[0] == "Kd")
        material->base_colour = colour_of(lines);
      else
        material->texture = texture_of(lines);
    }
  }
  return library;
}

}  // namespace softcell::ppu
