// Wavefront OBJ: polygons only; smoothing groups and the like are skipped, curves and surfaces refused. The
// names of objects, groups and materials are kept here. The library gets none of them: it follows the names
// of material libraries, even into places where there is nothing, and has been seen to write outside its
// memory on the way.

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ppu/mesh_import/mesh_file_check_formats.h"
#include "ppu/mesh_import/mesh_file_text.h"

namespace softcell::ppu {
namespace {

/// Statements without geometry.
constexpr std::array<std::string_view, 12> kSkipped{
    "s", "mg", "usemap", "maplib", "bevel", "lod", "vp", "l", "p", "shadow_obj", "trace_obj", "c_interp"};

class ObjCheck {
 public:
  explicit ObjCheck(std::string_view text) : lines_(text, true) {}

  MeshFileContents run() {
    while (lines_.next()) statement();
    // Indices may name vertices that come later, so the ends are known only here.
    check_end(highest_[0], counts_[0], "vertex");
    check_end(highest_[1], counts_[1], "texture coordinate");
    check_end(highest_[2], counts_[2], "normal");
    contents_.has_normals = contents_.triangles > 0 && corners_ == corners_with_normal_;
    contents_.has_texture_coordinates = corners_with_texture_ > 0;
    return contents_;
  }

 private:
  void statement() {
    const std::string_view keyword = lines_.words()[0];
    if (keyword.starts_with('#')) return;
    // Names may have a # of their own.
    const bool is_geometry =
        keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f" || keyword == "fo";
    const std::span<const std::string_view> words =
        is_geometry ? before_comment(lines_.words()) : lines_.words();
    if (keyword == "v") {
      // x y z, with a weight, or with a colour
      numbers(words, {3, 4, 6, 7});
      if (words.size() == 5 && lines_.finite_number(words[4]) == 0) lines_.refuse("a vertex has weight 0");
      ++counts_[0];
      contents_.has_colours = contents_.has_colours || words.size() == 7;
      keep("v", words);
    } else if (keyword == "vt") {
      numbers(words, {1, 2, 3});
      ++counts_[1];
      keep("vt", words);
    } else if (keyword == "vn") {
      numbers(words, {3});
      ++counts_[2];
      keep("vn", words);
    } else if (keyword == "f" || keyword == "fo") {
      face(words);
      extend_parts(contents_, object_, material_);
      keep("f", words);
    } else if (keyword == "o" || keyword == "g") {
      object_ = mesh_part_name(arguments(words));
    } else if (keyword == "usemtl") {
      material_ = mesh_part_name(arguments(words));
    } else if (keyword == "mtllib") {
      contents_.material_library = mesh_part_name(arguments(words));
    } else if (std::find(kSkipped.begin(), kSkipped.end(), keyword) == kSkipped.end()) {
      lines_.refuse(in_quotes(keyword) + " is not a statement of an OBJ file of polygons");
    }
  }

  using Words = std::span<const std::string_view>;

  static Words before_comment(Words words) {
    const auto comment =
        std::ranges::find_if(words, [](std::string_view word) { return word.starts_with('#'); });
    return {words.begin(), comment};
  }
  static Words arguments(Words words) { return words.subspan(1); }

  /// In the way that the library reads: it takes .5 for no number.
  void keep(std::string_view keyword, Words words) {
    contents_.geometry += keyword;
    for (std::string_view word : arguments(words)) {
      contents_.geometry += ' ';
      if (word.starts_with('-') || word.starts_with('+')) {
        if (word[0] == '-') contents_.geometry += '-';
        word.remove_prefix(1);
      }
      if (word.starts_with('.')) contents_.geometry += '0';
      contents_.geometry += word;
    }
    contents_.geometry += '\n';
  }

  void numbers(Words words, std::initializer_list<std::size_t> allowed) {
    if (std::find(allowed.begin(), allowed.end(), words.size() - 1) == allowed.end()) {
      lines_.refuse(in_quotes(words[0]) + " is followed by " + std::to_string(words.size() - 1) +
                    " numbers; " + std::to_string(*allowed.begin()) + " were expected");
    }
    for (std::size_t i = 1; i < words.size(); ++i) lines_.finite_number(words[i]);
  }

  void face(Words words) {
    for (const std::string_view word : arguments(words)) corner(word);
    try {
      add_polygon(contents_, words.size() - 1, "");
    } catch (const std::runtime_error& problem) {
      lines_.refuse(problem.what());
    }
  }

  /// One of v, v/vt, v//vn, v/vt/vn.
  void corner(std::string_view word) {
    std::size_t part = 0;
    for (std::string_view rest = word;; ++part) {
      if (part == 3) lines_.refuse(in_quotes(word) + " is not a corner of a face");
      const std::size_t slash = rest.find('/');
      const std::string_view number = rest.substr(0, slash);
      const bool may_be_missing = part == 1 && slash != std::string_view::npos;
      if (!(number.empty() && may_be_missing)) {
        index(number, part);
        if (part == 1) ++corners_with_texture_;
      }
      if (slash == std::string_view::npos) break;
      rest.remove_prefix(slash + 1);
    }
    ++corners_;
    if (part == 2) ++corners_with_normal_;
  }

  void index(std::string_view word, std::size_t kind) {
    const std::int64_t value = lines_.integer(word);
    if (value == 0) lines_.refuse("a face has index 0; OBJ indices begin at 1");
    if (value < 0 && value < -counts_[kind]) {
      lines_.refuse("index " + std::to_string(value) + " points before the first of " +
                    std::to_string(counts_[kind]));
    }
    highest_[kind] = std::max(highest_[kind], value);
  }

  static void check_end(std::int64_t highest, std::int64_t count, const char* what) {
    if (highest > count) {
      refuse("a face names " + std::string(what) + " " + std::to_string(highest) + ", but the file has " +
             std::to_string(count));
    }
  }

  LineReader lines_;
  MeshFileContents contents_;
  std::array<std::int64_t, 3> counts_{}, highest_{};  ///< of v, vt, vn
  std::size_t corners_ = 0, corners_with_normal_ = 0, corners_with_texture_ = 0;
  std::string object_, material_;  ///< of the faces to come
};

}  // namespace

MeshFileContents check_obj(std::string_view bytes) {
  if (bytes.find('\0') != std::string_view::npos) refuse("it holds binary data; an OBJ file is text");
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  return ObjCheck(bytes).run();
}

}  // namespace softcell::ppu
