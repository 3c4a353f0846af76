// Any bytes as the message of the process that runs Lua: it belongs to somebody else's program.

#include "document/value_message.h"

#include <memory>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const auto file = std::make_shared<const std::string>("fuzz.lua");
  try {
    softcell::demos::read_message({reinterpret_cast<const char*>(data), size}, file);
  } catch (const softcell::demos::SceneError&) {
    // an error's message
  }
  return 0;
}
