#pragma once
// Small glTF files for tests: JSON written by hand around bytes that are collected here.

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

namespace softcell::ppu {

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kLetters[bits >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

/// Bytes for buffers, with one view and one accessor for each row of numbers that is added.
class GltfBuilder {
 public:
  template <class Number>
  std::uint32_t add(std::initializer_list<Number> numbers, const char* type, int component_type,
                    int components, const std::string& more = "") {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    const std::size_t begin = bytes_.size();
    for (const Number number : numbers) {
      char raw[sizeof number];
      std::memcpy(raw, &number, sizeof number);
      bytes_.append(raw, sizeof number);
    }
    separate(views_) += R"({"buffer":0,"byteOffset":)" + std::to_string(begin) + R"(,"byteLength":)" +
                        std::to_string(bytes_.size() - begin) + "}";
    separate(accessors_) += R"({"bufferView":)" + std::to_string(count_) + R"(,"componentType":)" +
                            std::to_string(component_type) + R"(,"count":)" +
                            std::to_string(numbers.size() / static_cast<std::size_t>(components)) +
                            R"(,"type":")" + type + "\"" + more + "}";
    return count_++;
  }
  std::uint32_t add_floats(std::initializer_list<float> numbers, const char* type, int components) {
    return add<float>(numbers, type, 5126, components);
  }
  /// A view of any bytes, with an accessor that nobody uses.
  std::uint32_t add_bytes(std::string_view bytes) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    separate(views_) += R"({"buffer":0,"byteOffset":)" + std::to_string(bytes_.size()) + R"(,"byteLength":)" +
                        std::to_string(bytes.size()) + "}";
    separate(accessors_) += R"({"componentType":5126,"count":0,"type":"SCALAR"})";
    bytes_ += bytes;
    return count_++;
  }

  /// @param rest  the other fields of the document: "meshes": ..., "nodes": ...
  std::string gltf(const std::string& rest) const {
    return document(rest, R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes_) + "\"");
  }
  std::string glb(const std::string& rest) const {
    std::string json = document(rest, ""), bytes = bytes_;
    while (json.size() % 4 != 0) json += ' ';
    while (bytes.size() % 4 != 0) bytes += '\0';
    return "glTF" + word(2) + word(28 + json.size() + bytes.size()) + word(json.size()) + "JSON" + json +
           word(bytes.size()) + std::string("BIN\0", 4) + bytes;
  }
  /// A document whose bytes are in a file of that name.
  std::string gltf_beside(const std::string& file, const std::string& rest) const {
    return document(rest, R"(,"uri":")" + file + "\"");
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string& separate(std::string& list) { return list.empty() ? list : list += ','; }
  static std::string word(std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    char raw[4];
    std::memcpy(raw, &number, 4);
    return {raw, 4};
  }
  std::string document(const std::string& rest, const std::string& uri) const {
    return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(bytes_.size()) + uri +
           R"(}],"bufferViews":[)" + views_ + R"(],"accessors":[)" + accessors_ + "]," + rest + "}";
  }

  std::string bytes_, views_, accessors_;
  std::uint32_t count_ = 0;
};

}  // namespace softcell::ppu
