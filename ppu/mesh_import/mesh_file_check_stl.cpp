// STL: a count and 50 bytes a triangle, or text. The files' normals are not looked at: they follow from the
// corners.

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "ppu/mesh_import/mesh_file_check_formats.h"
#include "ppu/mesh_import/mesh_file_text.h"

namespace softcell::ppu {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read as it lies in memory");

constexpr std::size_t kHeaderBytes = 84, kTriangleBytes = 50;
/// In the two bytes behind a triangle, above three times five bits of colour. [VisCAM, SolidView] second-hand
constexpr std::uint16_t kHasColour = 0x8000;

std::uint32_t promised_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof(count), sizeof(count));
  return count;
}

MeshFileContents check_binary(std::string_view bytes) {
  MeshFileContents contents;
  const std::size_t count = promised_triangles(bytes);
  for (std::size_t t = 0; t < count; ++t) {
    add_polygon(contents, 3, "");
    std::array<float, 12> numbers{};  // normal, three corners
    std::memcpy(numbers.data(), bytes.data() + kHeaderBytes + t * kTriangleBytes, sizeof(numbers));
    for (std::size_t i = 3; i < numbers.size(); ++i) {
      if (!std::isfinite(numbers[i]))
        refuse("triangle " + std::to_string(t) + " has a coordinate that is not finite");
    }
    std::uint16_t attribute = 0;
    std::memcpy(&attribute, bytes.data() + kHeaderBytes + t * kTriangleBytes + sizeof(numbers),
                sizeof(attribute));
    contents.has_colours = contents.has_colours || (attribute & kHasColour) != 0;
  }
  return contents;
}

class TextCheck {
 public:
  explicit TextCheck(std::string_view text) : lines_(text) {}

  MeshFileContents run() {
    while (lines_.next()) {
      expect({"solid"}, true);
      solid_ = mesh_part_name(std::span(lines_.words()).subspan(1));
      for (next(); lines_.words()[0] != "endsolid"; next()) facet();
    }
    return contents_;
  }

 private:
  void next() {
    if (!lines_.next()) refuse("it ends in the middle of a solid; 'endsolid' was expected");
  }

  /// The line's first words. A solid's name may follow.
  void expect(std::initializer_list<std::string_view> wanted, bool more_allowed = false) {
    const auto& words = lines_.words();
    std::size_t i = 0;
    for (const std::string_view word : wanted) {
      if (i == words.size() || words[i] != word) lines_.refuse(in_quotes(word) + " was expected");
      ++i;
    }
    if (!more_allowed && words.size() != i) lines_.refuse(in_quotes(words[i]) + " does not belong there");
  }

  void facet() {
    expect({"facet", "normal"}, true);
    if (lines_.words().size() != 5) lines_.refuse("three numbers were expected after 'facet normal'");
    for (std::size_t i = 2; i < 5; ++i) lines_.number(lines_.words()[i]);
    next(), expect({"outer", "loop"});
    for (int corner = 0; corner < 3; ++corner) {
      next(), expect({"vertex"}, true);
      if (lines_.words().size() != 4) lines_.refuse("three coordinates were expected after 'vertex'");
      for (std::size_t i = 1; i < 4; ++i) lines_.finite_number(lines_.words()[i]);
    }
    next(), expect({"endloop"});
    next(), expect({"endfacet"});
    add_polygon(contents_, 3, "");
    extend_parts(contents_, solid_, "");
  }

  LineReader lines_;
  MeshFileContents contents_;
  std::string solid_;
};

}  // namespace

MeshFileContents check_stl(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes) {
    const std::size_t expected = kHeaderBytes + kTriangleBytes * std::size_t{promised_triangles(bytes)};
    if (bytes.size() == expected) return check_binary(bytes);
    // A text file has text where a binary one has its count; only what does not begin as text is judged by
    // its count.
    if (!bytes.starts_with("solid")) {
      refuse("its header promises " + std::to_string(promised_triangles(bytes)) + " triangles in " +
             std::to_string(expected) + " bytes, but the file has " + std::to_string(bytes.size()));
    }
  }
  if (!bytes.starts_with("solid"))
    refuse("it is neither a text STL file ('solid ...') nor a whole binary one");
  if (bytes.find('\0') != std::string_view::npos)
    refuse("it begins as a text STL file but holds binary data");
  return TextCheck(bytes).run();
}

}  // namespace softcell::ppu
