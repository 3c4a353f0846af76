#pragma once
// The JSON of a glTF file. nlohmann/json parses it, without the parts that softcell does not read. The functions here return its values;
// their errors name the place in the file.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softcell::ppu {

/// A value of the file and where it is: "meshes[0].primitives[2]". Valid as long as the document.
class GltfValue {
 public:
  explicit GltfValue(const nlohmann::json& document) : value_(&document) {}

  bool has(std::string_view key) const;
  const std::string& place() const { return place_; }
  [[noreturn]] void refuse(const std::string& problem) const;

  // Fields of an object. Each is refused if it has another type or range; one that is absent is the default.

  /// An object. @throws std::runtime_error  it is absent.
  GltfValue object(std::string_view key) const;
  /// An object, if there is one.
  std::optional<GltfValue> optional_object(std::string_view key) const;
  /// The items of an array; 0 if it is absent.
  std::size_t size(std::string_view key) const;
  /// An item of an array: an object. @pre  index < size(key)
  GltfValue item(std::string_view key, std::size_t index) const;

  /// A whole number from 0 to `high`.
  std::optional<std::uint64_t> whole(std::string_view key, std::uint64_t high) const;
  std::uint64_t whole(std::string_view key, std::uint64_t high, std::uint64_t otherwise) const;
  std::uint64_t required_whole(std::string_view key, std::uint64_t high) const;
  /// The number of an item of the document's array `items`, of which there are `count`.
  std::optional<std::uint32_t> index(std::string_view key, std::string_view items, std::size_t count) const;
  /// The same, of an item of the array `key`.
  std::uint32_t index_at(std::string_view key, std::size_t item, std::string_view items,
                         std::size_t count) const;
  /// A finite number in a range.
  float number(std::string_view key, double low, double high, float otherwise) const;
  /// Exactly `out.size()` finite numbers, which a float can hold. @return whether the array is there.
  bool numbers(std::string_view key, std::span<double> out) const;
  bool flag(std::string_view key, bool otherwise) const;
  /// Text of at most `most` bytes; longer ones are cut.
  std::string text(std::string_view key, std::size_t most) const;
  /// All of a text, if there is one. Valid as long as the document.
  const std::string* whole_text(std::string_view key) const;
  const std::string& text_at(std::string_view key, std::size_t item) const;
  /// The names of the fields of the object `key`; none if it is absent.
  std::vector<std::string> names(std::string_view key) const;

 private:
  GltfValue(const nlohmann::json* value, std::string place) : value_(value), place_(std::move(place)) {}
  const nlohmann::json* find(std::string_view key) const;
  const nlohmann::json& array_item(std::string_view key, std::size_t item) const;
  std::string place_of(std::string_view key) const;
  std::uint64_t as_whole(const nlohmann::json& value, const std::string& where, std::uint64_t high) const;

  const nlohmann::json* value_;
  std::string place_;
};

/// The two parts of a glTF file: JSON, and the bytes behind it in a binary one.
struct GltfDocument {
  nlohmann::json json;
  std::optional<std::string_view> bytes;  ///< valid as long as the file's; none: the file has none
};

/// Takes apart a .gltf or a .glb, which begins with "glTF". Leaves out `extras`. @throws std::runtime_error  a clause:
/// where the JSON is wrong, nested or large beyond measure; a chunk that is wrong; another version of glTF.
GltfDocument read_gltf_document(std::string_view file);

}  // namespace softcell::ppu
