#pragma once
// A shared library opened while the program runs.

#include <initializer_list>

namespace softcell::render {

/// Stays loaded until the process ends: Mesa and LLVM leave exit handlers and thread-local state behind that
/// must not point at unmapped code.
class DynamicLibrary {
 public:
  /// Opens the first of the names that the system has, keeping its symbols to itself.
  /// @throws std::runtime_error  naming what was looked for, the loader's reason, and the package to install.
  DynamicLibrary(std::initializer_list<const char*> names, const char* package);

  /// The function of that name, as the given pointer type. @throws std::runtime_error when it has none.
  template <class Pointer>
  Pointer function(const char* name) const {
    return reinterpret_cast<Pointer>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_ = nullptr;
  const char* name_ = nullptr;
};

}  // namespace softcell::render
