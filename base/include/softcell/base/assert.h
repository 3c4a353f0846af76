#pragma once
// SC_ASSERT(condition, "message with {} for each value", values...)
//
// Says what must hold unless softcell itself has a mistake. Where it does not, the program ends: one line on
// standard error has file, line, condition and message, and the process aborts. Faults of a kernel and what
// the outside world gets wrong are no assertions.
//
// Alive where SOFTCELL_ASSERTIONS is defined: Debug builds and builds with sanitizers, unless the CMake
// option of that name says otherwise. Elsewhere neither condition nor values are evaluated.

#include <charconv>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace softcell::base::assertion {

/// The message, checked when it is compiled: as many {} as values.
template <class... Values>
struct Message {
  consteval Message(const char* message) : text(message) {  // NOLINT: a literal is a message
    std::size_t places = 0;
    for (std::size_t at = text.find("{}"); at != text.npos; at = text.find("{}", at + 2)) ++places;
    if (places != sizeof...(Values)) throw "the message needs as many {} as there are values";
  }
  std::string_view text;
};

template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    return std::string(std::string_view(value));
  } else if constexpr (std::same_as<Value, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_enum_v<Value>) {
    return text_of(static_cast<std::underlying_type_t<Value>>(value));
  } else if constexpr (std::is_arithmetic_v<Value>) {
    char digits[64];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
  } else {
    return value.string();  // a path
  }
}

[[noreturn, gnu::cold, gnu::noinline]] void fail(const char* file, int line, const char* condition,
                                                 std::string_view message,
                                                 std::initializer_list<std::string> values) noexcept;

template <class... Values>
[[noreturn, gnu::cold, gnu::noinline]] void violated(const char* file, int line, const char* condition,
                                                     Message<std::type_identity_t<Values>...> message,
                                                     const Values&... values) noexcept {
  fail(file, line, condition, message.text, {text_of(values)...});
}

/// What is compiled and never called.
template <class... Values>
void ignored(bool, Message<std::type_identity_t<Values>...>, const Values&...) {}

}  // namespace softcell::base::assertion

#ifdef SOFTCELL_ASSERTIONS
#define SC_ASSERT(condition, ...) \
  (static_cast<bool>(condition)   \
       ? static_cast<void>(0)     \
       : ::softcell::base::assertion::violated(__FILE__, __LINE__, #condition, __VA_ARGS__))
#else
#define SC_ASSERT(condition, ...) \
  (true ? static_cast<void>(0)    \
        : ::softcell::base::assertion::ignored(static_cast<bool>(condition), __VA_ARGS__))
#endif
