#include "lua_sandbox.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <lua.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "softcell/base/sanitizers.h"
#include "value_message.h"

namespace softcell::demos {
namespace {

// The chunk's name, with which Lua begins its messages: "s:12: ...".
constexpr const char* kChunkName = "=s";
constexpr int kInstructionsBetweenChecks = 1000;
constexpr double kSlower = SC_ADDRESS_SANITIZER ? 3 : 1;  // the sanitizer slows allocation down

struct Library {
  const char* name;
  lua_CFunction open;
  std::span<const char* const> allowed;
};

constexpr const char* kBaseFunctions[] = {"assert",   "error",    "ipairs", "select",
                                          "tonumber", "tostring", "type"};
constexpr const char* kMathFunctions[] = {
    "abs",  "acos",   "asin", "atan", "ceil",       "cos",       "deg",        "exp",  "floor",
    "fmod", "huge",   "log",  "max",  "maxinteger", "min",       "mininteger", "modf", "pi",
    "rad",  "random", "sin",  "sqrt", "tan",        "tointeger", "type",       "ult"};
constexpr const char* kStringFunctions[] = {"byte",  "char",    "format", "len",
                                            "lower", "reverse", "sub",    "upper"};
constexpr const char* kTableFunctions[] = {"concat", "pack", "sort", "unpack"};
constexpr Library kBaseLibrary{"_G", luaopen_base, kBaseFunctions};
constexpr Library kLibraries[] = {{"math", luaopen_math, kMathFunctions},
                                  {"string", luaopen_string, kStringFunctions},
                                  {"table", luaopen_table, kTableFunctions}};

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The chunk without what luaL_loadfile() passes over as well: a byte order mark, and a first line that begins with #, but for its end.
std::string_view without_preamble(std::string_view chunk) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (chunk.starts_with(kByteOrderMark)) chunk.remove_prefix(kByteOrderMark.size());
  if (chunk.starts_with('#')) chunk.remove_prefix(std::min(chunk.find('\n'), chunk.size()));
  return chunk;
}

/// The other globals of Lua 5.4, of which none is opened.
constexpr const char* kOtherGlobals[] = {"coroutine", "debug", "io", "os", "package", "require", "utf8"};

class Sandbox {
 public:
  explicit Sandbox(int descriptor) : descriptor_(descriptor) {}

  [[noreturn]] void run(std::string_view chunk) {
    begin_ = seconds(CLOCK_MONOTONIC);
    state_ = lua_newstate(allocate, this);
    if (state_ == nullptr) fail(0, "there is no memory for Lua");
    lua_atpanic(state_, [](lua_State* state) -> int { of(state).fail_with_error(LUA_ERRRUN); });
    *static_cast<Sandbox**>(lua_getextraspace(state_)) = this;
    open_libraries();
    lua_sethook(state_, on_hook, LUA_MASKCOUNT | LUA_MASKLINE, kInstructionsBetweenChecks);
    // "t": text only. Bytecode could do anything.
    chunk = without_preamble(chunk);
    int status = luaL_loadbufferx(state_, chunk.data(), chunk.size(), kChunkName, "t");
    if (status == LUA_OK) status = lua_pcall(state_, 0, 1, 0);
    if (status != LUA_OK) fail_with_error(status);
    MessageWriter writer;
    try {
      write_result(state_, writer);
    } catch (const std::runtime_error& error) {
      fail(line_, error.what());
    }
    end(writer.value_message(line_));
  }

 private:
  static Sandbox& of(lua_State* state) { return **static_cast<Sandbox**>(lua_getextraspace(state)); }

  static void* allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
    auto& sandbox = *static_cast<Sandbox*>(self);
    if (block == nullptr) old_size = 0;  // for a new block old_size is the kind of object
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
    sandbox.check_time();
  }

  void check_time() {
    // This is not an error of Lua, which a chunk might catch: the process ends here.
    if (seconds(CLOCK_PROCESS_CPUTIME_ID) > kSlower * kLuaSeconds ||
        seconds(CLOCK_MONOTONIC) - begin_ > kLuaWallSeconds) {
      fail(line_, fmt::format("the script ran for more than {} second here", kLuaSeconds));
    }
  }

  /// table.insert as in Lua, except that Lua's own function moves items in an endless loop when the length is not what it seems.
  static int insert(lua_State* state) {
    luaL_checktype(state, 1, LUA_TTABLE);
    const int given = lua_gettop(state);
    if (given != 2 && given != 3) return luaL_error(state, "wrong number of arguments to 'insert'");
    const auto end = static_cast<lua_Integer>(lua_rawlen(state, 1) + 1);
    const lua_Integer position = given == 2 ? end : luaL_checkinteger(state, 2);
    luaL_argcheck(state, position == end || (position >= 1 && position < end), 2, "position out of bounds");
    for (lua_Integer i = end; i > position; --i) {
      if (i % kInstructionsBetweenChecks == 0) of(state).check_time();
      lua_rawgeti(state, 1, i - 1);
      lua_rawseti(state, 1, i);
    }
    lua_rawseti(state, 1, position);
    return 0;
  }

  /// Tables and functions are written as their type here. Lua writes their address, which would differ from run to run.
  static bool has_only_an_address(lua_State* state, int index) {
    const int type = lua_type(state, index);
    return type == LUA_TTABLE || type == LUA_TFUNCTION || type == LUA_TUSERDATA ||
           type == LUA_TLIGHTUSERDATA || type == LUA_TTHREAD;
  }

  static int to_string(lua_State* state) {
    luaL_checkany(state, 1);
    if (has_only_an_address(state, 1))
      lua_pushstring(state, luaL_typename(state, 1));
    else
      luaL_tolstring(state, 1, nullptr);
    return 1;
  }

  /// string.format. Upvalue: Lua's own function.
  static int format(lua_State* state) {
    for (const char* c = luaL_checkstring(state, 1); *c != '\0'; ++c) {
      if (*c != '%') continue;
      c += 1 + std::strspn(c + 1, "-+ #0123456789.");
      if (*c == 'p') return luaL_argerror(state, 1, "%p is an address, which differs from run to run");
      if (*c == '\0') break;
    }
    for (int i = 2; i <= lua_gettop(state); ++i) {
      if (!has_only_an_address(state, i)) continue;
      lua_pushstring(state, luaL_typename(state, i));
      lua_replace(state, i);
    }
    const int arguments = lua_gettop(state);
    lua_pushvalue(state, lua_upvalueindex(1));
    lua_insert(state, 1);
    lua_call(state, arguments, 1);
    return 1;
  }

  /// Opens the libraries and leaves only what is allowed, also in the methods of texts.
  void open_libraries() {
    const auto open = [&](const Library& library) {
      luaL_requiref(state_, library.name, library.open, 1);
      lua_pop(state_, 1);
    };
    open(kBaseLibrary);
    for (const Library& library : kLibraries) open(library);
    seed_random();
    push_allowed(kBaseLibrary);  // the new globals
    lua_pushcfunction(state_, to_string);
    lua_setfield(state_, -2, "tostring");
    for (const Library& library : kLibraries) {
      push_allowed(library);
      if (library.open == luaopen_string) {
        lua_getfield(state_, -1, "format");
        lua_pushcclosure(state_, format, 1);
        lua_setfield(state_, -2, "format");
        make_methods_of_texts();
      }
      if (library.open == luaopen_table) {
        lua_pushcfunction(state_, insert);
        lua_setfield(state_, -2, "insert");
      }
      refuse_the_rest(library);
      lua_setfield(state_, -2, library.name);
    }
    refuse_the_rest(kBaseLibrary);
    lua_rawseti(state_, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
  }

  /// Makes random numbers the same in every run.
  void seed_random() {
    lua_getglobal(state_, "math");
    lua_getfield(state_, -1, "randomseed");
    lua_pushinteger(state_, 1);
    lua_call(state_, 1, 0);
    lua_pop(state_, 1);
  }

  /// Pushes a table of the allowed functions of a library.
  void push_allowed(const Library& library) {
    lua_newtable(state_);
    lua_getglobal(state_, library.name);
    for (const char* name : library.allowed) {
      lua_getfield(state_, -1, name);
      lua_setfield(state_, -3, name);
    }
    lua_pop(state_, 1);
  }

  /// Makes the table on top of the stack, which has the allowed functions of the library, report an error when a script looks for another
  /// function that Lua's library has. Any other name is nil, as always.
  void refuse_the_rest(const Library& library) {
    lua_newtable(state_);  // the metatable
    lua_pushstring(state_, library.name);
    lua_newtable(state_);  // a key for each name that is missing
    lua_getglobal(state_, library.name);
    for (lua_pushnil(state_); lua_next(state_, -2) != 0; lua_pop(state_, 1)) {
      lua_pushvalue(state_, -2);
      if (lua_rawget(state_, -7) != LUA_TNIL) {  // in the table of what is allowed
        lua_pop(state_, 1);
        continue;
      }
      lua_pop(state_, 1);
      lua_pushvalue(state_, -2);
      lua_pushboolean(state_, 1);
      lua_rawset(state_, -6);
    }
    lua_pop(state_, 1);
    for (const char* name : kOtherGlobals) {
      if (library.open != luaopen_base) break;
      lua_pushboolean(state_, 1);
      lua_setfield(state_, -2, name);
    }
    lua_pushcclosure(state_, find_the_rest, 2);
    lua_setfield(state_, -2, "__index");
    lua_setmetatable(state_, -2);
  }

  /// __index: Lua calls it for a name that the table does not have. Upvalues: the library's name, and a table of the names that Lua has and
  /// a scene does not have.
  static int find_the_rest(lua_State* state) {
    lua_settop(state, 2);
    lua_pushvalue(state, 2);
    if (lua_rawget(state, lua_upvalueindex(2)) == LUA_TNIL) return 1;
    const std::string_view library = lua_tostring(state, lua_upvalueindex(1));
    const bool is_global = library == kBaseLibrary.name;
    // No C++ object may be alive when luaL_error leaves this function, so Lua makes the list.
    luaL_Buffer names;
    luaL_buffinit(state, &names);
    bool is_first = true;
    const auto add = [&](const char* name) {
      if (!std::exchange(is_first, false)) luaL_addstring(&names, ", ");
      luaL_addstring(&names, name);
    };
    const auto add_all = [&](std::span<const char* const> all) {
      for (const char* name : all) add(name);
    };
    if (is_global) {
      add_all(kBaseFunctions);
      for (const Library& each : kLibraries) add(each.name);
    } else {
      for (const Library& each : kLibraries)
        if (library == each.name) add_all(each.allowed);
      if (library == "table") add("insert");
    }
    luaL_pushresult(&names);
    return luaL_error(state, "%s%s%s is not available in a scene; there are: %s",
                      is_global ? "" : lua_tostring(state, lua_upvalueindex(1)), is_global ? "" : ".",
                      lua_tostring(state, 2), lua_tostring(state, -1));
  }

  /// Makes the table on top of the stack the one in which ("text"):name() is found.
  void make_methods_of_texts() {
    lua_pushliteral(state_, "");
    lua_getmetatable(state_, -1);
    lua_pushvalue(state_, -3);
    lua_setfield(state_, -2, "__index");
    lua_pop(state_, 2);
  }

  /// Ends the process with the error on top of the stack.
  [[noreturn]] void fail_with_error(int status) {
    if (status == LUA_ERRMEM)
      fail(line_, fmt::format("the script needs more than {} MB", kLuaMaxBytes >> 20));
    if (lua_type(state_, -1) != LUA_TSTRING) fail(line_, "the script ended with an error that is not a text");
    std::string_view sentence = lua_tostring(state_, -1);
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
      const ssize_t written = write(descriptor_, message.data(), message.size());
      if (written <= 0) _exit(1);
      message.remove_prefix(static_cast<std::size_t>(written));
    }
    _exit(0);
  }

  int descriptor_;
  lua_State* state_ = nullptr;
  std::size_t bytes_ = 0;
  int line_ = 1;  // the chunk's present line; before it runs, its first line
  double begin_ = 0;
};

/// The present address space of the process, in bytes: the chunk is not responsible for what the process inherited.
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

// The address sanitizer's runtime maps memory as it likes and reads /proc when an exception is thrown. Under it, too, a script has no
// function that opens files, and Lua's allocator keeps its limit.
constexpr bool kLimitProcess = SC_ADDRESS_SANITIZER == 0;

}  // namespace

void run_sandboxed(std::string_view chunk, int descriptor) {
  constexpr rlim_t kSpareBytes = rlim_t{192} << 20;  // for Lua, for the message, and for the allocator itself
  if (kLimitProcess) set_limit(RLIMIT_AS, address_space() + kSpareBytes);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(kSlower * kLuaSeconds)) + 1);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  if (kLimitProcess) set_limit(RLIMIT_NOFILE, 0);
  Sandbox(descriptor).run(chunk);
}

}  // namespace softcell::demos
