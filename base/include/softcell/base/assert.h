#pragma once
// SC_ASSERT(condition, "message with {} for each value", values...)
//
// States what always holds, unless softcell itself or a caller that breaks a @pre has a mistake. If the condition is false, the program
// prints one line to standard error and aborts:
//
//   arena.cpp:58: void softcell::dma::Arena::free(...): SC_ASSERT(begin < bytes_) does not hold: ...
//
// Never use it for wrong input by a user or for a fault of a kernel: these are errors with a message. The condition has no side effects.
//
// Assertions are on if SOFTCELL_ASSERTIONS is defined: in Debug builds and builds with sanitizers, unless the CMake option of that name
// says otherwise. If they are off, neither condition nor values are evaluated.

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>

namespace softcell::base::assertion {

/// The message of an assertion with these values. The compiler checks that it has as many {} as values.
template <class... Values>
struct Message {
  /// Makes a message from a literal.
  consteval Message(const char* message) : text(message) {  // NOLINT: hence not explicit
    std::size_t placeholders = 0;
    for (std::size_t at = text.find("{}"); at != text.npos; at = text.find("{}", at + 2)) ++placeholders;
    if (placeholders != sizeof...(Values)) throw "the message needs as many {} as there are values";
  }
  std::string_view text;
};

/// A type whose number is its member `value`: an address or a handle.
template <class Type>
concept WrapsNumber = requires(const Type& wrapper) {
  { wrapper.value } -> std::convertible_to<std::uint64_t>;
};

/// Numbers in decimal, addresses, handles and pointers in hexadecimal, enumerators as their numbers.
template <class Value>
std::string text_of(const Value& value) {
  char digits[64];
  const auto hexadecimal = [&](std::uint64_t number) {
    return "0x" + std::string(digits, std::to_chars(digits, digits + sizeof digits, number, 16).ptr);
  };
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    return std::string(std::string_view(value));
  } else if constexpr (std::same_as<Value, bool>) {
    return value ? "true" : "false";
  } else if constexpr (std::is_enum_v<Value>) {
    return text_of(static_cast<std::underlying_type_t<Value>>(value));
  } else if constexpr (std::is_arithmetic_v<Value>) {
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
  } else if constexpr (std::is_pointer_v<Value>) {
    return hexadecimal(reinterpret_cast<std::uintptr_t>(value));
  } else if constexpr (WrapsNumber<Value>) {
    return hexadecimal(value.value);
  } else {
    return value.string();  // a path
  }
}

/// Where an assertion stands in the source.
struct Location {
  const char* file;
  int line;
  const char* function;
  const char* condition;
};

[[noreturn, gnu::cold, gnu::noinline]] void fail(const Location& location, std::string_view message,
                                                 std::initializer_list<std::string> values) noexcept;

template <class... Values>
[[noreturn, gnu::cold, gnu::noinline]] void violated(const Location& location,
                                                     Message<std::type_identity_t<Values>...> message,
                                                     const Values&... values) noexcept {
  fail(location, message.text, {text_of(values)...});
}

/// Compiled if assertions are off, so that their arguments stay correct; never called.
template <class... Values>
void ignored(bool, Message<std::type_identity_t<Values>...>, const Values&...) {}

}  // namespace softcell::base::assertion

#ifdef SOFTCELL_ASSERTIONS
#define SC_ASSERT(condition, ...)                                        \
  (static_cast<bool>(condition) ? static_cast<void>(0)                   \
                                : ::softcell::base::assertion::violated( \
                                      {__FILE__, __LINE__, __PRETTY_FUNCTION__, #condition}, __VA_ARGS__))
#else
#define SC_ASSERT(condition, ...) \
  (true ? static_cast<void>(0)    \
        : ::softcell::base::assertion::ignored(static_cast<bool>(condition), __VA_ARGS__))
#endif
