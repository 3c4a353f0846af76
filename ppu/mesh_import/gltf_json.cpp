#include "ppu/mesh_import/gltf_json.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "ppu/mesh_import/mesh_file_text.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 32;                     // of arrays and objects in each other; glTF needs some 8
constexpr std::size_t kMaxValues = 4'000'000;     // of the JSON: some 200 MB
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBytesChunk = 0x004E4942;

/// What nlohmann/json says, without its number, and without what it quotes of the file.
std::string complaint_of(std::string text) {
  const std::size_t begin = text.find("] ");
  if (begin != std::string::npos) text.erase(0, begin + 2);
  text.resize(std::min(text.find("; last read"), text.size()));
  constexpr std::size_t kLongest = 160;
  text.resize(std::min(text.size(), kLongest));
  for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
  return text;
}

json parse_json(std::string_view text) {
  std::size_t values = 0;
  const auto keep = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > kMaxDepth) refuse("its JSON is nested more than " + std::to_string(kMaxDepth) + " deep");
    if (++values > kMaxValues) refuse("its JSON has more than " + std::to_string(kMaxValues) + " values");
    return event != json::parse_event_t::key || parsed.get_ref<const std::string&>() != "extras";
  };
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  try {
    return json::parse(text, keep);
  } catch (const json::exception& problem) {
    refuse("its JSON cannot be read: " + complaint_of(problem.what()));
  }
}

std::uint32_t word_at(std::string_view file, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, file.data() + at, sizeof word);
  return word;
}

/// The chunk at `at`, which moves behind it.
std::string_view chunk(std::string_view file, std::size_t& at, std::uint32_t kind, const char* name) {
  if (file.size() - at < 8) refuse(std::string("it ends before its chunk ") + name);
  const std::uint32_t size = word_at(file, at), found = word_at(file, at + 4);
  if (found != kind) refuse(std::string("its chunk ") + name + " is not where it was expected");
  at += 8;
  if (file.size() - at < size) {
    refuse(std::string("its chunk ") + name + " is to have " + std::to_string(size) +
           " bytes; the file has " + std::to_string(file.size() - at) + " more");
  }
  const std::string_view bytes = file.substr(at, size);
  at += std::min<std::size_t>((size + std::size_t{3}) / 4 * 4, file.size() - at);
  return bytes;
}

GltfDocument read_binary(std::string_view file) {
  if (file.size() < 12) refuse("it ends within its header");
  if (word_at(file, 4) != 2)
    refuse("it is of version " + std::to_string(word_at(file, 4)) + " of glTF; 2 was expected");
  const std::uint32_t size = word_at(file, 8);
  if (size > file.size() || size < 12) {
    refuse("it is to have " + std::to_string(size) + " bytes and has " + std::to_string(file.size()));
  }
  file = file.substr(0, size);
  std::size_t at = 12;
  GltfDocument document;
  document.json = parse_json(chunk(file, at, kJsonChunk, "JSON"));
  if (at < file.size()) document.bytes = chunk(file, at, kBytesChunk, "BIN");
  return document;
}

}  // namespace

bool GltfValue::has(std::string_view key) const { return find(key) != nullptr; }

void GltfValue::refuse(const std::string& problem) const {
  ppu::refuse(place_.empty() ? problem : place_ + ": " + problem);
}

std::string GltfValue::place_of(std::string_view key) const {
  return place_.empty() ? std::string(key) : place_ + "." + std::string(key);
}

const json* GltfValue::find(std::string_view key) const {
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

GltfValue GltfValue::object(std::string_view key) const {
  auto found = optional_object(key);
  if (!found) refuse("it has no " + in_quotes(key));
  return std::move(*found);
}

std::optional<GltfValue> GltfValue::optional_object(std::string_view key) const {
  const json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_object()) ppu::refuse(place_of(key) + " is not an object");
  return GltfValue(value, place_of(key));
}

std::size_t GltfValue::size(std::string_view key) const {
  const json* const value = find(key);
  if (value == nullptr) return 0;
  if (!value->is_array()) ppu::refuse(place_of(key) + " is not an array");
  return value->size();
}

const json& GltfValue::array_item(std::string_view key, std::size_t item) const {
  SC_ASSERT(item < size(key), "item {} of {} of {}", item, size(key), std::string(key));
  return (*find(key))[item];
}

GltfValue GltfValue::item(std::string_view key, std::size_t index) const {
  const json& value = array_item(key, index);
  std::string place = place_of(key) + "[" + std::to_string(index) + "]";
  if (!value.is_object()) ppu::refuse(place + " is not an object");
  return {&value, std::move(place)};
}

std::uint64_t GltfValue::as_whole(const json& value, const std::string& where, std::uint64_t high) const {
  std::uint64_t number = 0;
  // JSON does not tell 3.0 from 3.
  if (value.is_number_unsigned()) {
    number = value.get<std::uint64_t>();
  } else if (value.is_number_float() && value.get<double>() >= 0 && value.get<double>() < 9e15 &&
             value.get<double>() == std::floor(value.get<double>())) {
    number = static_cast<std::uint64_t>(value.get<double>());
  } else {
    ppu::refuse(where + " is not a whole number of 0 or more");
  }
  if (number > high) {
    ppu::refuse(where + " is " + std::to_string(number) + "; it may be at most " + std::to_string(high));
  }
  return number;
}

std::optional<std::uint64_t> GltfValue::whole(std::string_view key, std::uint64_t high) const {
  const json* const value = find(key);
  if (value == nullptr) return std::nullopt;
  return as_whole(*value, place_of(key), high);
}

std::uint64_t GltfValue::whole(std::string_view key, std::uint64_t high, std::uint64_t otherwise) const {
  return whole(key, high).value_or(otherwise);
}

std::uint64_t GltfValue::required_whole(std::string_view key, std::uint64_t high) const {
  const auto number = whole(key, high);
  if (!number) refuse("it has no " + in_quotes(key));
  return *number;
}

namespace {

std::uint32_t checked_index(std::uint64_t number, const std::string& where, std::string_view items,
                            std::size_t count) {
  if (number >= count) {
    refuse(where + " is " + std::to_string(number) + ", but the file has " + std::to_string(count) + " " +
           std::string(items));
  }
  return static_cast<std::uint32_t>(number);
}

constexpr std::uint64_t kAnyIndex = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::optional<std::uint32_t> GltfValue::index(std::string_view key, std::string_view items,
                                              std::size_t count) const {
  const auto number = whole(key, kAnyIndex);
  if (!number) return std::nullopt;
  return checked_index(*number, place_of(key), items, count);
}

std::uint32_t GltfValue::index_at(std::string_view key, std::size_t item, std::string_view items,
                                  std::size_t count) const {
  const std::string where = place_of(key) + "[" + std::to_string(item) + "]";
  return checked_index(as_whole(array_item(key, item), where, kAnyIndex), where, items, count);
}

float GltfValue::number(std::string_view key, double low, double high, float otherwise) const {
  const json* const value = find(key);
  if (value == nullptr) return otherwise;
  if (!value->is_number()) ppu::refuse(place_of(key) + " is not a number");
  const auto number = value->get<double>();
  if (!(number >= low && number <= high)) {
    ppu::refuse(place_of(key) + " is " + value->dump() + "; a number from " + json(low).dump() + " to " +
                json(high).dump() + " was expected");
  }
  return static_cast<float>(number);
}

bool GltfValue::numbers(std::string_view key, std::span<double> out) const {
  const json* const value = find(key);
  if (value == nullptr) return false;
  bool good = value->is_array() && value->size() == out.size();
  for (std::size_t i = 0; good && i < out.size(); ++i) {
    const json& number = (*value)[i];
    good = number.is_number() && std::abs(number.get<double>()) <= double{std::numeric_limits<float>::max()};
    if (good) out[i] = number.get<double>();
  }
  if (!good) ppu::refuse(place_of(key) + " does not have " + std::to_string(out.size()) + " finite numbers");
  return true;
}

bool GltfValue::flag(std::string_view key, bool otherwise) const {
  const json* const value = find(key);
  if (value == nullptr) return otherwise;
  if (!value->is_boolean()) ppu::refuse(place_of(key) + " is neither true nor false");
  return value->get<bool>();
}

const std::string* GltfValue::whole_text(std::string_view key) const {
  const json* const value = find(key);
  if (value == nullptr) return nullptr;
  if (!value->is_string()) ppu::refuse(place_of(key) + " is not text");
  return &value->get_ref<const std::string&>();
}

std::string GltfValue::text(std::string_view key, std::size_t most) const {
  const std::string* const all = whole_text(key);
  return all == nullptr ? std::string() : all->substr(0, most);
}

const std::string& GltfValue::text_at(std::string_view key, std::size_t item) const {
  const json& value = array_item(key, item);
  if (!value.is_string()) ppu::refuse(place_of(key) + "[" + std::to_string(item) + "] is not text");
  return value.get_ref<const std::string&>();
}

std::vector<std::string> GltfValue::names(std::string_view key) const {
  std::vector<std::string> found;
  const auto object = optional_object(key);
  if (!object) return found;
  for (const auto& [name, value] : object->value_->items()) found.push_back(name);
  return found;
}

GltfDocument read_gltf_document(std::string_view file) {
  GltfDocument document;
  if (file.size() >= 4 && word_at(file, 0) == kMagic) {
    document = read_binary(file);
  } else {
    document.json = parse_json(file);
  }
  if (!document.json.is_object()) refuse("its JSON is not an object");
  const GltfValue root(document.json);
  const std::string version = root.object("asset").text("version", 16);
  if (!version.starts_with("2."))
    refuse("it is of version " + in_quotes(version) + " of glTF; 2.0 was expected");
  return document;
}

}  // namespace softcell::ppu
