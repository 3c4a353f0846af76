// PLY: a header that declares elements and their properties, then their values as text or binary in either
// byte order.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ppu/mesh_import/mesh_file_check_formats.h"
#include "ppu/mesh_import/mesh_file_text.h"

namespace softcell::ppu {
namespace {

struct Type {
  std::string_view name, other_name;
  std::size_t size;
  enum Kind { kSigned, kUnsigned, kReal } kind;
};

constexpr std::array<Type, 8> kTypes{{{"char", "int8", 1, Type::kSigned},
                                      {"uchar", "uint8", 1, Type::kUnsigned},
                                      {"short", "int16", 2, Type::kSigned},
                                      {"ushort", "uint16", 2, Type::kUnsigned},
                                      {"int", "int32", 4, Type::kSigned},
                                      {"uint", "uint32", 4, Type::kUnsigned},
                                      {"float", "float32", 4, Type::kReal},
                                      {"double", "float64", 8, Type::kReal}}};

struct Property {
  std::string name;
  const Type* type = nullptr;        ///< of the value, or of the list's items
  const Type* count_type = nullptr;  ///< of the list's length; none for a single value
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  const Property* find(std::initializer_list<std::string_view> names) const {
    const auto found = std::find_if(properties.begin(), properties.end(), [&](const Property& property) {
      return std::find(names.begin(), names.end(), property.name) != names.end();
    });
    return found == properties.end() ? nullptr : &*found;
  }
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
  std::string declarations = {};  ///< all of it, without what `has_more` is about
  bool has_more = false;          ///< comments or free text

  const Element* find(std::string_view name) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const Element& element) { return element.name == name; });
    return found == elements.end() ? nullptr : &*found;
  }
};

const Type* type_named(const LineReader& lines, std::string_view name) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& type) {
    return type.name == name || type.other_name == name;
  });
  if (found == kTypes.end()) lines.refuse(in_quotes(name) + " is not a type of PLY files");
  return &*found;
}

Encoding encoding_named(const LineReader& lines, std::string_view name) {
  if (name == "ascii") return Encoding::kText;
  if (name == "binary_little_endian") return Encoding::kLittleEndian;
  if (name == "binary_big_endian") return Encoding::kBigEndian;
  lines.refuse(in_quotes(name) + " is not a format of PLY files");
}

/// Nothing but a comment. Some exporters forget the keyword in the lines behind the format, where no reader
/// misses a declaration: Blender 2.47 wrote "Created by Blender3D".
bool is_comment(const std::vector<std::string_view>& words, bool before_elements) {
  constexpr std::array<std::string_view, 4> kDeclarations{"ply", "format", "element", "property"};
  if (words[0] == "comment" || words[0] == "obj_info") return true;
  return before_elements &&
         std::find(kDeclarations.begin(), kDeclarations.end(), words[0]) == kDeclarations.end();
}

void append_line(std::string& text, const std::vector<std::string_view>& words) {
  for (const std::string_view word : words) text.append(&word == &words[0] ? "" : " ").append(word);
  text += '\n';
}

Header read_header(LineReader& lines) {
  const auto next = [&] {
    if (!lines.next()) refuse("its header has no end; 'end_header' was expected");
    return lines.words();
  };
  if (!lines.next() || lines.words() != std::vector<std::string_view>{"ply"})
    refuse("its first line is not 'ply'");
  Header header;
  std::vector<std::string_view> words = next();
  if (words.size() != 3 || words[0] != "format" || words[2] != "1.0") {
    lines.refuse("'format ascii 1.0' (or binary_little_endian, binary_big_endian) was expected");
  }
  header.encoding = encoding_named(lines, words[1]);
  header.declarations = "ply\n";
  append_line(header.declarations, words);
  for (words = next(); words[0] != "end_header"; words = next()) {
    if (is_comment(words, header.elements.empty())) {
      header.has_more = true;
      continue;
    }
    append_line(header.declarations, words);
    if (words[0] == "element" && words.size() == 3) {
      const std::int64_t count = lines.integer(words[2]);
      if (count < 0) lines.refuse("an element's count is negative");
      if (header.find(words[1]) != nullptr)
        lines.refuse("element " + in_quotes(words[1]) + " is declared twice");
      header.elements.push_back({std::string(words[1]), static_cast<std::size_t>(count), {}});
      continue;
    }
    const bool list = words.size() == 5 && words[1] == "list";
    if (words[0] != "property" || !(list || words.size() == 3) || header.elements.empty()) {
      lines.refuse(
          "'element NAME COUNT', 'property TYPE NAME' or 'property list TYPE TYPE NAME' was expected");
    }
    Element& element = header.elements.back();
    if (element.find({words.back()}) != nullptr)
      lines.refuse("property " + in_quotes(words.back()) + " is declared twice");
    const Type* count_type = list ? type_named(lines, words[2]) : nullptr;
    if (list && count_type->kind == Type::kReal) lines.refuse("the length of a list must be a whole number");
    element.properties.push_back(
        {std::string(words.back()), type_named(lines, words[list ? 3 : 1]), count_type});
  }
  header.declarations += "end_header\n";
  return header;
}

/// Values of the body, one after the other.
class TextValues {
 public:
  explicit TextValues(const LineReader& lines) : lines_(lines) {}
  void begin_element() {
    if (!lines_.next()) refuse("it ends before all the elements that its header promises");
    at_ = 0;
  }
  void end_element() const {
    if (at_ != lines_.words().size()) lines_.refuse("there are more values than properties");
  }
  double value(const Type& type) {
    if (at_ == lines_.words().size()) lines_.refuse("there are fewer values than properties");
    const std::string_view word = lines_.words()[at_++];
    if (type.kind == Type::kReal) return lines_.finite_number(word);
    const std::int64_t value = lines_.integer(word), values = std::int64_t{1} << (8 * type.size);
    const std::int64_t lowest = type.kind == Type::kSigned ? -values / 2 : 0;
    if (value < lowest || value >= lowest + values)
      lines_.refuse(in_quotes(word) + " is out of its type's range");
    return static_cast<double>(value);
  }
  /// Least bytes that a value takes in the file: a digit and a separator.
  static std::size_t least_bytes(const Type&) { return 2; }
  std::size_t bytes_left() const { return lines_.rest().size() + 1; }  // the last line may lack its separator
  void end() {
    if (lines_.next()) lines_.refuse("there is more after the elements that the header promises");
  }

 private:
  LineReader lines_;
  std::size_t at_ = 0;
};

class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, bool big_endian)
      : rest_(bytes), swap_(big_endian == (std::endian::native == std::endian::little)) {}
  void begin_element() {}
  void end_element() const {}
  double value(const Type& type) {
    if (rest_.size() < type.size) refuse("it ends before all the elements that its header promises");
    std::array<char, 8> raw{};
    for (std::size_t i = 0; i < type.size; ++i) raw[swap_ ? type.size - 1 - i : i] = rest_[i];
    rest_.remove_prefix(type.size);
    switch (type.kind) {
      case Type::kReal:
        return type.size == 4 ? static_cast<double>(as<float>(raw)) : as<double>(raw);
      case Type::kSigned:
        return type.size == 1   ? as<std::int8_t>(raw)
               : type.size == 2 ? as<std::int16_t>(raw)
                                : as<std::int32_t>(raw);
      case Type::kUnsigned:
        return type.size == 1   ? as<std::uint8_t>(raw)
               : type.size == 2 ? as<std::uint16_t>(raw)
                                : as<std::uint32_t>(raw);
    }
    return 0;
  }
  static std::size_t least_bytes(const Type& type) { return type.size; }
  std::size_t bytes_left() const { return rest_.size(); }
  void end() const {
    if (!rest_.empty())
      refuse("it has " + std::to_string(rest_.size()) + " bytes more than its header promises");
  }

 private:
  template <class T>
  static T as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  std::string_view rest_;
  bool swap_;
};

template <class Values>
void check_face_list(Values& values, const Property& list, std::size_t vertices, const std::string& where,
                     MeshFileContents& contents) {
  const double corners = values.value(*list.count_type);
  if (!(corners >= 0)) refuse(where + "the length of a list is negative");
  add_polygon(contents, static_cast<std::size_t>(corners), where);
  for (std::size_t i = 0; i < static_cast<std::size_t>(corners); ++i) {
    const double index = values.value(*list.type);
    if (!(index >= 0) || index >= static_cast<double>(vertices)) {
      refuse(where + "index " + std::to_string(static_cast<std::int64_t>(index)) + " is outside the " +
             std::to_string(vertices) + " vertices");
    }
  }
}

template <class Values>
void check_values(Values& values, const Property& property, const std::string& where) {
  double count = 1;
  if (property.count_type != nullptr) count = values.value(*property.count_type);
  if (!(count >= 0)) refuse(where + "the length of a list is negative");
  for (double i = 0; i < count; ++i) {
    if (!(std::abs(values.value(*property.type)) <= std::numeric_limits<float>::max())) {
      refuse(where + property.name + " is not a finite number (of at most 3.4e38)");
    }
  }
}

template <class Values>
MeshFileContents check_body(Values values, const Header& header) {
  const Element& vertex = *header.find("vertex");
  MeshFileContents contents;
  for (const Element& element : header.elements) {
    std::size_t least_bytes = 0;
    for (const Property& property : element.properties) {
      least_bytes +=
          Values::least_bytes(property.count_type != nullptr ? *property.count_type : *property.type);
    }
    if (least_bytes == 0) refuse("element " + in_quotes(element.name) + " has no properties");
    if (element.count > values.bytes_left() / least_bytes) {
      refuse("its header promises " + std::to_string(element.count) + " elements " + in_quotes(element.name) +
             ", more than the file has bytes for");
    }
    const Property* corners =
        element.name == "face" ? element.find({"vertex_indices", "vertex_index"}) : nullptr;
    for (std::size_t i = 0; i < element.count; ++i) {
      values.begin_element();
      const std::string where = element.name + " " + std::to_string(i) + ": ";
      for (const Property& property : element.properties) {
        if (&property == corners) {
          check_face_list(values, property, vertex.count, where, contents);
        } else {
          check_values(values, property, where);
        }
      }
      values.end_element();
    }
  }
  values.end();
  return contents;
}

void require_mesh(const Header& header) {
  const Element* vertex = header.find("vertex");
  if (vertex == nullptr) refuse("it declares no element 'vertex'");
  for (const std::string_view name : {"x", "y", "z"}) {
    const Property* property = vertex->find({name});
    if (property == nullptr || property->count_type != nullptr) {
      refuse("its vertices have no property " + in_quotes(name));
    }
  }
  const Element* face = header.find("face");
  if (face == nullptr) refuse("it declares no element 'face'; a mesh of triangles was expected");
  const Property* corners = face->find({"vertex_indices", "vertex_index"});
  if (corners == nullptr || corners->count_type == nullptr || corners->type->kind == Type::kReal) {
    refuse("its faces have no list of whole numbers 'vertex_indices'");
  }
  if (face->find({"vertex_indices"}) != nullptr && face->find({"vertex_index"}) != nullptr) {
    refuse("its faces have both 'vertex_indices' and 'vertex_index'; one of them was expected");
  }
  if (header.find("tristrips") != nullptr) refuse("it has triangle strips; faces alone were expected");
}

}  // namespace

MeshFileContents check_ply(std::string_view bytes) {
  LineReader lines(bytes);
  Header header = read_header(lines);
  require_mesh(header);
  MeshFileContents contents =
      header.encoding == Encoding::kText
          ? check_body(TextValues(lines), header)
          : check_body(BinaryValues(lines.rest(), header.encoding == Encoding::kBigEndian), header);
  const Element& vertex = *header.find("vertex");
  contents.has_normals =
      vertex.find({"nx"}) != nullptr && vertex.find({"ny"}) != nullptr && vertex.find({"nz"}) != nullptr;
  const auto has = [&](std::initializer_list<std::string_view> names) {
    return vertex.find(names) != nullptr;
  };
  contents.has_texture_coordinates = has({"u", "s", "tx", "texture_u"}) && has({"v", "t", "ty", "texture_v"});
  contents.has_colours = has({"red", "r"}) && has({"green", "g"}) && has({"blue", "b"});
  // The library loses properties behind a comment, and takes one that begins with an element's name for that.
  if (header.has_more) contents.geometry = header.declarations.append(lines.rest());
  return contents;
}

}  // namespace softcell::ppu
