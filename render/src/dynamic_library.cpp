#include "dynamic_library.h"

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace softcell::render {

DynamicLibrary::DynamicLibrary(std::initializer_list<const char*> names, const char* package) {
  std::string reasons;
  for (const char* name : names) {
    handle_ = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
    name_ = name;
    if (handle_ != nullptr) return;
    reasons += (reasons.empty() ? "" : "; ") + std::string(::dlerror());
  }
  throw std::runtime_error("cannot load " + std::string(*names.begin()) + " (" + reasons +
                           "); install the package " + package);
}

void* DynamicLibrary::symbol(const char* name) const {
  void* const address = ::dlsym(handle_, name);
  if (address == nullptr) throw std::runtime_error(std::string(name_) + " has no function " + name);
  return address;
}

}  // namespace softcell::render
