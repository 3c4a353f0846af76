#include "partial_file.h"

#include <unistd.h>

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace softcell::render {

PartialFile::PartialFile(std::filesystem::path final_path)
    : final_(std::move(final_path)), temporary_(final_) {
  std::error_code unknown;  // a path that cannot be looked at fails when it is opened, with a better message
  owned_ = !std::filesystem::exists(final_, unknown) || std::filesystem::is_regular_file(final_, unknown);
  if (owned_) {
    std::string name = ".";
    name += final_.stem().string() + ".partial-" + std::to_string(::getpid()) + final_.extension().string();
    temporary_.replace_filename(name);
  }
}

PartialFile::~PartialFile() {
  std::error_code ignored;  // nothing to remove is fine
  if (owned_) std::filesystem::remove(temporary_, ignored);
}

void PartialFile::commit() {
  if (!owned_) return;
  std::error_code error;
  std::filesystem::rename(temporary_, final_, error);
  if (error) throw std::runtime_error("cannot put " + final_.string() + " in its place: " + error.message());
  owned_ = false;
}

}  // namespace softcell::render
