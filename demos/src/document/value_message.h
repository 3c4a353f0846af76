#pragma once
// The message by which the child that runs Lua hands its result to the parent through a pipe. The parent does not trust it, because the
// child ran an unknown program.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "value.h"

namespace softcell::demos {

/// Builds a message of at most kMaxBytes. Once it is longer, the writer drops what follows, and too_long() says so.
class MessageWriter {
 public:
  static constexpr std::size_t kMaxBytes = 8 << 20;

  void flag(bool value);
  void integer(std::int64_t value);
  void real(double value);
  void text(std::string_view value);
  void begin_array(std::uint32_t items);
  void begin_table(std::uint32_t entries);  ///< each entry: key(), then a value
  void key(std::string_view name);

  bool too_long() const { return bytes_.size() > kMaxBytes; }

  /// The message with all that was written. @param line  the line at which the chunk ended
  std::string value_message(int line) const;
  static std::string error_message(int line, std::string_view sentence);

 private:
  template <class T>
  void append(const T& value);
  std::string bytes_;
};

/// The value in a message; empty when the message is incomplete. Tables are sorted by key.
/// @throws SceneError  the message is an error.
std::optional<Value> read_message(std::string_view message, const std::shared_ptr<const std::string>& file);

}  // namespace softcell::demos
