#include "ppu/mesh_import/material_library.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

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

/// "d 0.5" and the like; options before the number, as in "d -halo 0.5", are skipped.
float share_of(const LineReader& lines) {
  const auto& words = lines.words();
  if (words.size() < 2) lines.refuse(in_quotes(words[0]) + " is not followed by a number");
  return static_cast<float>(std::clamp(lines.finite_number(words.back()), 0.0, 1.0));
}

/// "map_Kd [options] FILE". A name that follows options is one word. Folders may be parted as on Windows.
std::string texture_of(const LineReader& lines) {
  const auto& words = lines.words();
  if (words.size() < 2) lines.refuse(in_quotes(words[0]) + " is not followed by the name of a file");
  std::string name = words[1].starts_with('-') ? mesh_part_name({words.end() - 1, words.end()})
                                               : mesh_part_name({words.begin() + 1, words.end()});
  std::ranges::replace(name, '\\', '/');
  return name;
}

/// What a library's statements say of one material.
struct Statements {
  std::optional<Eigen::Vector3f> colour;
  float opacity = 1;
  MeshMaterial material;

  MeshMaterial finished() {
    // Many programs write a black Kd beside a texture, which then shows its own colours.
    if (colour && colour->isZero() && !material.base_texture.file.empty()) colour.reset();
    if (!colour && (!material.base_texture.file.empty() || opacity < 1)) colour = Eigen::Vector3f::Ones();
    if (colour) material.base_colour = Eigen::Vector4f(colour->x(), colour->y(), colour->z(), opacity);
    if (opacity < 1) material.alpha = MeshAlpha::kBlend;
    return material;
  }
};

void read_statement(const LineReader& lines, Statements& to) {
  const std::string_view keyword = lines.words()[0];
  if (keyword == "Kd") {
    to.colour = colour_of(lines);
  } else if (keyword == "map_Kd") {
    to.material.base_texture.file = texture_of(lines);
  } else if (keyword == "d") {
    to.opacity = share_of(lines);
  } else if (keyword == "Tr") {
    to.opacity = 1 - share_of(lines);
  } else if (keyword == "Pr") {
    to.material.roughness = share_of(lines);
  } else if (keyword == "Pm") {
    to.material.metallic = share_of(lines);
  } else if (keyword == "norm") {
    to.material.normal_texture.file = texture_of(lines);
  }
}

constexpr std::array<std::string_view, 7> kRead{"Kd", "map_Kd", "d", "Tr", "Pr", "Pm", "norm"};

}  // namespace

MaterialLibrary parse_material_library(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) refuse("it holds binary data; a material library is text");
  std::map<std::string, Statements, std::less<>> statements;
  Statements* current = nullptr;
  for (LineReader lines(text, true); lines.next();) {
    const auto& words = lines.words();
    if (words[0] == "newmtl") {
      current = &statements[mesh_part_name({words.begin() + 1, words.end()})];
      *current = {};
    } else if (std::ranges::find(kRead, words[0]) != kRead.end()) {
      if (current == nullptr) lines.refuse(in_quotes(words[0]) + " comes before the first 'newmtl'");
      read_statement(lines, *current);
    }
  }
  MaterialLibrary library;
  for (auto& [name, said] : statements) library.emplace(name, said.finished());
  return library;
}

}  // namespace softcell::ppu
