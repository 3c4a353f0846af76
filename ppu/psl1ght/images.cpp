#include "images.h"

#include <cerrno>
#include <stdexcept>
#include <string>

#include "ppu/libspe2/object.h"
#include "ppu/libspe2/programs.h"

namespace softcell::psl1ght {
namespace {

struct Imported {
  std::shared_ptr<const ls_sim::KernelImage> program;
};

u32 error_of_file() {
  switch (errno) {
    case ENOENT:
      return kNoSuchFile;
    case ENOMEM:
      return kNoMemory;
    default:
      return kInvalid;
  }
}

/// load() gives a program, or throws what is wrong with it.
template <class Load>
u32 import(sysSpuImage* image, u32 type, Load&& load) {
  std::shared_ptr<const ls_sim::KernelImage> program;
  try {
    program = load();
  } catch (const std::runtime_error& error) {
    Machine::complain(error.what());
    return kNoProgram;
  }
  if (program == nullptr) return error_of_file();
  const u32 entry = program->entry;
  Imported* const key =
      libspe2::Objects<Imported>::all().add(std::make_shared<Imported>(Imported{std::move(program)}));
  *image = {.type = type, .entryPoint = entry, .segments = key, .segmentCount = 1};
  return kOk;
}

}  // namespace

std::shared_ptr<const ls_sim::KernelImage> program_of(const sysSpuImage* image) {
  if (image == nullptr) return nullptr;
  const auto found = libspe2::Objects<Imported>::all().find(image->segments);
  return found == nullptr ? nullptr : found->program;
}

}  // namespace softcell::psl1ght

using namespace softcell::psl1ght;
using softcell::libspe2::program_in_file;
using softcell::libspe2::program_in_memory;

s32 sysSpuImageImport(sysSpuImage* image, const void* elf, u32 type) {
  return call([&]() -> std::uint32_t {
    if (image == nullptr || elf == nullptr) return kFault;
    if (type != SPU_IMAGE_PROTECT && type != SPU_IMAGE_DIRECT) return kInvalid;
    return import(image, type, [&] { return program_in_memory("SPU program", elf, nullptr); });
  });
}

s32 sysSpuImageOpen(sysSpuImage* image, const char* path) {
  return call([&]() -> std::uint32_t {
    if (image == nullptr || path == nullptr) return kFault;
    return import(image, SPU_IMAGE_PROTECT, [&] { return program_in_file(path, 0); });
  });
}

s32 sysSpuImageOpenFd(sysSpuImage* image, s32 fd, u64 offset) {
  return call([&]() -> std::uint32_t {
    if (image == nullptr) return kFault;
    const std::string path = "/proc/self/fd/" + std::to_string(fd);
    return import(image, SPU_IMAGE_PROTECT, [&] { return program_in_file(path, offset); });
  });
}

s32 sysSpuImageClose(sysSpuImage* image) {
  return call([&]() -> std::uint32_t {
    if (image == nullptr) return kFault;
    if (softcell::libspe2::Objects<Imported>::all().remove(image->segments) == nullptr) return kInvalid;
    image->segments = nullptr;
    return kOk;
  });
}
