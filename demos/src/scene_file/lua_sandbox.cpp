#include "lua_sandbox.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <lua.hpp>
#include <span>

#include "value_message.h"

namespace softcell::demos {
namespace {

// As the chunk's name this begins the messages of Lua: "s:12: ...".
constexpr const char* kChunkName = "=s";
constexpr int kInstructionsBetweenChecks = 1000;

struct Library {
  const char* name;
  lua_CFunction open;
  std::span<const char* const> allowed;
};

constexpr const char* kBase[] = {"assert", "error", "ipairs", "select", "tonumber", "tostring", "type"};
constexpr const char* kMath[] = {"abs",  "acos",       "asin",      "atan", "ceil", "cos",    "deg",
                                 "exp",  "floor",      "fmod",      "huge", "log",  "max",    "maxinteger",
                                 "min",  "mininteger", "modf",      "pi",   "rad",  "random", "sin",
                                 "sqrt", "tan",        "tointeger", "type", "ult"};
constexpr const char* kString[] = {"byte", "char", "format", "len", "lower", "reverse", "sub", "upper"};
constexpr const char* kTable[] = {"concat", "pack", "sort", "unpack"};
constexpr Library kAllowed[] = {{"_G", luaopen_base, kBase},
                                {"math", luaopen_math, kMath},
                                {"string", luaopen_string, kString},
                                {"table", luaopen_table, kTable}};

// Lua's own table.insert moves items in a loop without end when the length is not what it seems.
constexpr const char* kPrelude = "function table.insert(t, value) t[#t + 1] = value end";

class Sandbox {
 public:
  Sandbox(int descriptor) : descriptor_(descriptor) {}

  [[noreturn]] void run(std::string_view chunk) {
    clock_gettime(CLOCK_MONOTONIC, &begin_);
    state_ = lua_newstate(allocate, this);
    if (state_ == nullptr) fail(0, "there is no memory for Lua");
    lua_atpanic(state_, [](lua_State* state) -> int { of(state).fail_with_error(LUA_ERRRUN); });
    *static_cast<Sandbox**>(lua_getextraspace(state_)) = this;
    open_libraries();
    if (luaL_dostring(state_, kPrelude) != LUA_OK) fail_with_error(LUA_ERRRUN);
    lua_sethook(state_, on_hook, LUA_MASKCOUNT | LUA_MASKLINE, kInstructionsBetweenChecks);
    // "t": text only. Bytecode could do anything.
    int status = luaL_loadbufferx(state_, chunk.data(), chunk.size(), kChunkName, "t");
    if (status == LUA_OK) status = lua_pcall(state_, 0, 1, 0);
    if (status != LUA_OK) fail_with_error(status);
    MessageWriter writer;
    write(writer, {}, 0);
    lua_sethook(state_, nullptr, 0, 0);
    end(writer.value_message(line_));
  }

 private:
  static Sandbox& of(lua_State* state) { return **static_cast<Sandbox**>(lua_getextraspace(state)); }

  static void* allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
    auto& sandbox = *static_cast<Sandbox*>(self);
    if (block == nullptr) old_size = 0;  // it is the kind of object then
    if (new_size > old_size && new_size - old_size > kLuaMaxBytes - sandbox.bytes_) return nullptr;
    void* moved = nullptr;
    if (new_size == 0) {
      std::free(block);
    } else {
      moved = std::realloc(block, new_size);
      if (moved == nullptr) return nullptr;
    }
    sandbox.bytes_ += new_size - old_size;
    return moved;
  }

  static void on_hook(lua_State* state, lua_Debug* record) {
    Sandbox& sandbox = of(state);
    if (record->event == LUA_HOOKLINE) {
      sandbox.line_ = record->currentline;
      return;
    }
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double seconds = static_cast<double>(now.tv_sec - sandbox.begin_.tv_sec) +
                           1e-9 * static_cast<double>(now.tv_nsec - sandbox.begin_.tv_nsec);
    // Not an error of Lua's, which a chunk might catch: the process ends here.
    if (seconds > kLuaSeconds) {
      sandbox.fail(sandbox.line_, fmt::format("the script ran for more than {} second here", kLuaSeconds));
    }
  }

  /// Opens the libraries and leaves only what is allowed, also to methods of texts.
  void open_libraries() {
    for (const Library& library : kAllowed)
      luaL_requiref(state_, library.name, library.open, 1), lua_pop(state_, 1);
    // Random numbers are the same in every run.
    lua_getglobal(state_, "math");
    lua_getfield(state_, -1, "randomseed");
    lua_pushinteger(state_, 1);
    lua_call(state_, 1, 0);
    lua_pop(state_, 1);

    lua_newtable(state_);  // the new globals
    for (const Library& library : kAllowed) {
      const bool is_base = library.open == luaopen_base;
      lua_getglobal(state_, library.name);
      if (is_base) {
        lua_pushvalue(state_, -2);
      } else {
        lua_newtable(state_);
      }
      for (const char* name : library.allowed) {
        lua_getfield(state_, -2, name);
        lua_setfield(state_, -2, name);
      }
      if (library.open == luaopen_string) {
        lua_pushliteral(state_, "");
        lua_getmetatable(state_, -1);
        lua_pushvalue(state_, -3);
        lua_setfield(state_, -2, "__index");
        lua_pop(state_, 2);
      }
      if (is_base) {
        lua_pop(state_, 2);
      } else {
        lua_setfield(state_, -3, library.name);
        lua_pop(state_, 1);
      }
    }
    lua_rawseti(state_, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
  }

  /// What errors call the value at this path; the path of the whole result is empty.
  static std::string named(const std::string& path) {
    return path.empty() ? "what the script returns" : path;
  }

  /// Writes the value on top of the stack. @param path  of the value: "world.gravity", "box[2].size[1]".
  void write(MessageWriter& writer, const std::string& path, int depth) {
    if (writer.too_long()) {
      fail(line_,
           fmt::format("what the script returns is larger than {} MB", MessageWriter::kMaxBytes >> 20));
    }
    switch (lua_type(state_, -1)) {
      case LUA_TBOOLEAN:
        writer.flag(lua_toboolean(state_, -1) != 0);
        return;
      case LUA_TNUMBER:
        write_number(writer, path);
        return;
      case LUA_TSTRING:
        writer.text(text_at(-1));
        return;
      case LUA_TTABLE:
        write_table(writer, path, depth);
        return;
      case LUA_TNIL:
        fail(line_, fmt::format("{} is nil; it must be a table", named(path)));
      default:
        fail(line_, fmt::format("{} is a {}; a scene is made of numbers, texts, true, false and tables",
                                named(path), lua_typename(state_, lua_type(state_, -1))));
    }
  }

  void write_number(MessageWriter& writer, const std::string& path) {
    if (lua_isinteger(state_, -1) != 0) {
      writer.integer(lua_tointeger(state_, -1));
      return;
    }
    const double number = lua_tonumber(state_, -1);
    if (!std::isfinite(number)) {
      fail(line_, fmt::format("{} is {}; it must be a finite number", named(path),
                              std::isnan(number) ? "NaN" : "infinite"));
    }
    writer.real(number);
  }

  void write_table(MessageWriter& writer, const std::string& path, int depth) {
    if (depth >= kMaxValueDepth || lua_checkstack(state_, 4) == 0) {
      fail(line_,
           fmt::format("tables lie more than {} deep in each other, or one contains itself", kMaxValueDepth));
    }
    std::uint32_t entries = 0;
    bool all_names = true, all_numbers = true;
    for (lua_pushnil(state_); lua_next(state_, -2) != 0; lua_pop(state_, 1)) {
      ++entries;
      all_names = all_names && lua_type(state_, -2) == LUA_TSTRING;
      all_numbers = all_numbers && lua_isinteger(state_, -2) != 0;
    }
    if (all_names) {  // the empty table, too
      writer.begin_table(entries);
      for (lua_pushnil(state_); lua_next(state_, -2) != 0; lua_pop(state_, 1)) {
        const std::string name(text_at(-2));
        writer.key(name);
        write(writer, (path.empty() ? "" : path + ".") + name.substr(0, 64), depth + 1);
      }
      return;
    }
    if (!all_numbers)
      fail(line_, named(path) + " has names as well as numbers for keys; give names, or numbers from 1");
    writer.begin_array(entries);
    for (std::uint32_t i = 1; i <= entries; ++i) {
      const std::string item = fmt::format("{}[{}]", path, i);
      if (lua_rawgeti(state_, -1, i) == LUA_TNIL) {
        fail(line_, fmt::format("{} is missing: an array has no holes", item));
      }
      write(writer, item, depth + 1);
      lua_pop(state_, 1);
    }
  }

  std::string_view text_at(int index) {
    std::size_t size = 0;
    const char* text = lua_tolstring(state_, index, &size);
    return {text, size};
  }

  /// Ends with the error on top of the stack.
  [[noreturn]] void fail_with_error(int status) {
    if (status == LUA_ERRMEM)
      fail(line_, fmt::format("the script needs more than {} MB", kLuaMaxBytes >> 20));
    if (lua_type(state_, -1) != LUA_TSTRING) fail(line_, "the script ended with an error that is no text");
    std::string_view sentence = text_at(-1);
    int line = line_, length = 0;
    if (std::sscanf(sentence.data(), "s:%d: %n", &line, &length) == 1 && length > 0) {
      sentence.remove_prefix(static_cast<std::size_t>(length));
    }
    constexpr std::size_t kLongestSentence = 400;
    fail(line, sentence.substr(0, kLongestSentence));
  }

  [[noreturn]] void fail(int line, std::string_view sentence) {
    end(MessageWriter::error_message(line, sentence));
  }

  [[noreturn]] void end(std::string_view message) {
    while (!message.empty()) {
      const ssize_t written = write_bytes(message);
      if (written <= 0) _exit(1);
      message.remove_prefix(static_cast<std::size_t>(written));
    }
    _exit(0);
  }

  ssize_t write_bytes(std::string_view bytes) const {
    return ::write(descriptor_, bytes.data(), bytes.size());
  }

  int descriptor_;
  lua_State* state_ = nullptr;
  std::size_t bytes_ = 0;
  int line_ = 0;  // at which the chunk is
  timespec begin_{};
};

/// The process's address space now, in bytes: what it inherited is no fault of the chunk's.
rlim_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void set_limit(__rlimit_resource resource, rlim_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

}  // namespace

void run_sandboxed(std::string_view chunk, int descriptor) {
  constexpr rlim_t kSpareBytes = rlim_t{192} << 20;  // Lua's, the message's, and the allocator's own
  set_limit(RLIMIT_AS, address_space() + kSpareBytes);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(kLuaSeconds)));
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  set_limit(RLIMIT_NOFILE, 0);
  Sandbox(descriptor).run(chunk);
}

}  // namespace softcell::demos
