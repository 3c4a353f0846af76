#include "value_message.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace softcell::demos {
namespace {

enum Tag : char {
  kValue = 'V',
  kError = 'E',
  kFlag = 'b',
  kInteger = 'i',
  kReal = 'd',
  kText = 's',
  kArray = 'a',
  kTable = 't'
};

/// Reads what MessageWriter wrote; reads nothing more after something did not fit.
class MessageReader {
 public:
  MessageReader(std::string_view bytes, Place place) : rest_(bytes), place_(std::move(place)) {}

  template <class T>
  std::optional<T> take() {
    T value;
    if (rest_.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  std::optional<std::string> take_text() {
    const auto size = take<std::uint32_t>();
    if (!size || *size > rest_.size()) return std::nullopt;
    std::string text(rest_.substr(0, *size));
    rest_.remove_prefix(*size);
    return text;
  }

  std::optional<Value> take_value(int depth) {
    if (depth > kMaxValueDepth) return std::nullopt;
    const auto tag = take<char>();
    if (!tag) return std::nullopt;
    switch (*tag) {
      case kFlag: {
        const auto flag = take<char>();
        return flag ? std::optional(Value{*flag != 0, place_}) : std::nullopt;
      }
      case kInteger: {
        const auto integer = take<std::int64_t>();
        return integer ? std::optional(Value{*integer, place_}) : std::nullopt;
      }
      case kReal: {
        const auto real = take<double>();
        return real && std::isfinite(*real) ? std::optional(Value{*real, place_}) : std::nullopt;
      }
      case kText: {
        auto text = take_text();
        return text ? std::optional(Value{std::move(*text), place_}) : std::nullopt;
      }
      case kArray:
        return take_array(depth);
      case kTable:
        return take_table(depth);
      default:
        return std::nullopt;
    }
  }

  bool at_end() const { return rest_.empty(); }
  Place& place() { return place_; }

 private:
  std::optional<Value> take_array(int depth) {
    const auto count = take<std::uint32_t>();
    if (!count) return std::nullopt;
    Array array;
    for (std::uint32_t i = 0; i < *count; ++i) {
      auto item = take_value(depth + 1);
      if (!item) return std::nullopt;
      array.push_back(std::move(*item));
    }
    return Value{std::move(array), place_};
  }

  std::optional<Value> take_table(int depth) {
    const auto count = take<std::uint32_t>();
    if (!count) return std::nullopt;
    Table table;
    for (std::uint32_t i = 0; i < *count; ++i) {
      auto key = take_text();
      if (!key) return std::nullopt;
      auto value = take_value(depth + 1);
      if (!value) return std::nullopt;
      table.push_back({std::move(*key), std::move(*value)});
    }
    std::sort(table.begin(), table.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return Value{std::move(table), place_};
  }

  std::string_view rest_;
  Place place_;
};

std::string header(char tag, int line) {
  std::string bytes(1, tag);
  const auto number = static_cast<std::int32_t>(line);
  return bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

template <class T>
void MessageWriter::put(const T& value) {
  if (!too_long()) bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void MessageWriter::flag(bool value) {
  put<char>(kFlag);
  put<char>(value ? 1 : 0);
}
void MessageWriter::integer(std::int64_t value) {
  put<char>(kInteger);
  put(value);
}
void MessageWriter::real(double value) {
  put<char>(kReal);
  put(value);
}
void MessageWriter::text(std::string_view value) {
  put<char>(kText);
  key(value);
}
void MessageWriter::begin_array(std::uint32_t items) {
  put<char>(kArray);
  put(items);
}
void MessageWriter::begin_table(std::uint32_t entries) {
  put<char>(kTable);
  put(entries);
}
void MessageWriter::key(std::string_view name) {
  put(static_cast<std::uint32_t>(name.size()));
  if (!too_long()) bytes_.append(name);
}

std::string MessageWriter::value_message(int line) const { return header(kValue, line) + bytes_; }

std::string MessageWriter::error_message(int line, std::string_view sentence) {
  return header(kError, line).append(sentence);
}

std::optional<Value> read_message(std::string_view message, const std::shared_ptr<const std::string>& file) {
  MessageReader reader(message, {file, 0, 0});
  const auto tag = reader.take<char>();
  const auto line = reader.take<std::int32_t>();
  if (!tag || !line) return std::nullopt;
  reader.place().line = std::max(0, *line);
  if (*tag == kError) {
    throw SceneError(reader.place(), std::string(message.substr(sizeof(char) + sizeof(std::int32_t))));
  }
  if (*tag != kValue) return std::nullopt;
  auto value = reader.take_value(0);
  return value && reader.at_end() ? std::move(value) : std::nullopt;
}

}  // namespace softcell::demos
