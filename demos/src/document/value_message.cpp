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
  MessageReader(std::string_view bytes, Location location) : rest_(bytes), location_(std::move(location)) {}

  template <class T>
  std::optional<T> read() {
    T value;
    if (rest_.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  std::optional<std::string> read_text() {
    const auto size = read<std::uint32_t>();
    if (!size || *size > rest_.size()) return std::nullopt;
    std::string text(rest_.substr(0, *size));
    rest_.remove_prefix(*size);
    return text;
  }

  std::optional<Value> read_value(int depth) {
    if (depth > kMaxValueDepth) return std::nullopt;
    const auto tag = read<char>();
    if (!tag) return std::nullopt;
    switch (*tag) {
      case kFlag: {
        const auto flag = read<char>();
        return flag ? std::optional(Value{*flag != 0, location_}) : std::nullopt;
      }
      case kInteger: {
        const auto integer = read<std::int64_t>();
        return integer ? std::optional(Value{*integer, location_}) : std::nullopt;
      }
      case kReal: {
        const auto real = read<double>();
        return real && std::isfinite(*real) ? std::optional(Value{*real, location_}) : std::nullopt;
      }
      case kText: {
        auto text = read_text();
        return text ? std::optional(Value{std::move(*text), location_}) : std::nullopt;
      }
      case kArray:
        return read_array(depth);
      case kTable:
        return read_table(depth);
      default:
        return std::nullopt;
    }
  }

  bool at_end() const { return rest_.empty(); }
  Location& location() { return location_; }

 private:
  std::optional<Value> read_array(int depth) {
    const auto count = read<std::uint32_t>();
    if (!count) return std::nullopt;
    Array array;
    for (std::uint32_t i = 0; i < *count; ++i) {
      auto item = read_value(depth + 1);
      if (!item) return std::nullopt;
      array.push_back(std::move(*item));
    }
    return Value{std::move(array), location_};
  }

  std::optional<Value> read_table(int depth) {
    const auto count = read<std::uint32_t>();
    if (!count) return std::nullopt;
    Table table;
    for (std::uint32_t i = 0; i < *count; ++i) {
      auto key = read_text();
      if (!key) return std::nullopt;
      auto value = read_value(depth + 1);
      if (!value) return std::nullopt;
      table.push_back({std::move(*key), std::move(*value)});
    }
    std::sort(table.begin(), table.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return Value{std::move(table), location_};
  }

  std::string_view rest_;
  Location location_;
};

std::string header(char tag, int line) {
  std::string bytes(1, tag);
  const auto number = static_cast<std::int32_t>(line);
  return bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

template <class T>
void MessageWriter::append(const T& value) {
  if (!too_long()) bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void MessageWriter::flag(bool value) {
  append<char>(kFlag);
  append<char>(value ? 1 : 0);
}
void MessageWriter::integer(std::int64_t value) {
  append<char>(kInteger);
  append(value);
}
void MessageWriter::real(double value) {
  append<char>(kReal);
  append(value);
}
void MessageWriter::text(std::string_view value) {
  append<char>(kText);
  key(value);
}
void MessageWriter::begin_array(std::uint32_t items) {
  append<char>(kArray);
  append(items);
}
void MessageWriter::begin_table(std::uint32_t entries) {
  append<char>(kTable);
  append(entries);
}
void MessageWriter::key(std::string_view name) {
  append(static_cast<std::uint32_t>(name.size()));
  if (!too_long()) bytes_.append(name);
}

std::string MessageWriter::value_message(int line) const { return header(kValue, line) + bytes_; }

std::string MessageWriter::error_message(int line, std::string_view sentence) {
  return header(kError, line).append(sentence);
}

std::optional<Value> read_message(std::string_view message, const std::shared_ptr<const std::string>& file) {
  MessageReader reader(message, {file, 0, 0});
  const auto tag = reader.read<char>();
  const auto line = reader.read<std::int32_t>();
  if (!tag || !line) return std::nullopt;
  reader.location().line = std::max(0, *line);
  if (*tag == kError) {
    throw SceneError(reader.location(), std::string(message.substr(sizeof(char) + sizeof(std::int32_t))));
  }
  if (*tag != kValue) return std::nullopt;
  auto value = reader.read_value(0);
  return value && reader.at_end() ? std::move(value) : std::nullopt;
}

}  // namespace softcell::demos
