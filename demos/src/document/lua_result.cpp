#include "lua_sandbox.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// The location of a value in the result, as a chain on the stack, because most locations are never written out.
struct Path {
  const Path* outer = nullptr;
  std::string_view name;    // in a table
  std::uint32_t index = 0;  // in an array, from 1

  /// "box[2].size[1]"; for the result as a whole, what it is.
  std::string text() const { return outer == nullptr ? "what the script returns" : inner_text(); }

  std::string inner_text() const {
    if (outer == nullptr) return {};
    constexpr std::size_t kLongestName = 64;
    const std::string before = outer->inner_text();
    if (index > 0) return fmt::format("{}[{}]", before, index);
    return fmt::format("{}{}{}", before, before.empty() ? "" : ".", name.substr(0, kLongestName));
  }
};

[[noreturn]] void refuse(std::string sentence) { throw std::runtime_error(std::move(sentence)); }

class ResultWriter {
 public:
  ResultWriter(lua_State* state, MessageWriter& writer) : state_(state), writer_(writer) {}

  void write(const Path& path, int depth) {
    if (writer_.too_long()) {
      refuse(fmt::format("what the script returns is larger than {} MB", MessageWriter::kMaxBytes >> 20));
    }
    switch (lua_type(state_, -1)) {
      case LUA_TBOOLEAN:
        return writer_.flag(lua_toboolean(state_, -1) != 0);
      case LUA_TNUMBER:
        return write_number(path);
      case LUA_TSTRING:
        return writer_.text(text_at(-1));
      case LUA_TTABLE:
        return write_table(path, depth);
      case LUA_TNIL:
        refuse(path.text() + " is nil; it must be a table");
      default:
        refuse(fmt::format("{} is a {}; a scene is made of numbers, texts, true, false and tables",
                           path.text(), luaL_typename(state_, -1)));
    }
  }

 private:
  void write_number(const Path& path) {
    if (lua_isinteger(state_, -1) != 0) return writer_.integer(lua_tointeger(state_, -1));
    const double number = lua_tonumber(state_, -1);
    if (!std::isfinite(number)) {
      refuse(fmt::format("{} is {}; it must be a finite number", path.text(),
                         std::isnan(number) ? "NaN" : "infinite"));
    }
    writer_.real(number);
  }

  void write_table(const Path& path, int depth) {
    if (depth >= kMaxValueDepth || lua_checkstack(state_, 4) == 0) {
      refuse(fmt::format("tables are nested more than {} deep, or one contains itself", kMaxValueDepth));
    }
    std::uint32_t entries = 0;
    bool all_names = true, all_numbers = true;
    for (lua_pushnil(state_); lua_next(state_, -2) != 0; lua_pop(state_, 1)) {
      ++entries;
      all_names = all_names && lua_type(state_, -2) == LUA_TSTRING;
      all_numbers = all_numbers && lua_isinteger(state_, -2) != 0;
    }
    if (all_names) return write_entries(path, depth, entries);  // this includes the empty table
    if (!all_numbers) {
      refuse(path.text() + " has names as well as numbers for keys; give names, or numbers from 1");
    }
    write_items(path, depth, entries);
  }

  void write_entries(const Path& path, int depth, std::uint32_t entries) {
    writer_.begin_table(entries);
    for (lua_pushnil(state_); lua_next(state_, -2) != 0; lua_pop(state_, 1)) {
      const std::string_view name = text_at(-2);
      writer_.key(name);
      write({.outer = &path, .name = name}, depth + 1);
    }
  }

  void write_items(const Path& path, int depth, std::uint32_t entries) {
    writer_.begin_array(entries);
    for (std::uint32_t i = 1; i <= entries; ++i) {
      const Path item{.outer = &path, .name = {}, .index = i};
      if (lua_rawgeti(state_, -1, i) == LUA_TNIL) refuse(item.text() + " is missing: an array has no holes");
      write(item, depth + 1);
      lua_pop(state_, 1);
    }
  }

  /// @pre the value is a text: lua_tolstring() would convert a number in its table.
  std::string_view text_at(int index) {
    SC_ASSERT(lua_type(state_, index) == LUA_TSTRING, "a {} is no text", luaL_typename(state_, index));
    std::size_t size = 0;
    const char* text = lua_tolstring(state_, index, &size);
    return {text, size};
  }

  lua_State* state_;
  MessageWriter& writer_;
};

}  // namespace

void write_result(lua_State* state, MessageWriter& writer) { ResultWriter(state, writer).write({}, 0); }

}  // namespace softcell::demos
