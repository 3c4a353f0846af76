#pragma once
// A kernel image: the bytes that are copied into a local store, and their declared sizes.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim {

/// Bytes at the bottom of every local store that belong to the emulator: the environment through which a
/// kernel on the host engine reaches its channels. An SPU program linked at 0x80 leaves them free as well.
inline constexpr std::uint32_t kEnvironmentBytes = 128;

/// Sizes of an image in bytes, and its declared limits.
struct ImageSizes {
  std::uint32_t text = 0, rodata = 0, data = 0, bss = 0;
  std::uint32_t stack = 0;   ///< declared, at the top of the local store
  std::uint32_t budget = 0;  ///< declared: the most that total() may be

  std::uint32_t from = 0;  ///< local-store address where it begins, including the environment
  std::uint32_t end = 0;   ///< local-store address of the first byte after bss and alignment
  std::uint32_t total() const { return end - from + stack; }
};

/// A variable of an image, from its symbol table.
struct ImageObject {
  std::string name;  ///< demangled
  dma::LocalStoreAddress begin;
  std::uint32_t bytes = 0;
};

struct KernelImage {
  std::string name;
  std::uint32_t begin = kEnvironmentBytes;  ///< local-store address of the first byte
  /// Local-store address from which its stack grows down. An image that is linked above the bottom of the
  /// local store has its stack below itself.
  std::uint32_t stack_top = dma::kLocalStoreBytes;
  std::vector<std::byte> bytes;  ///< from `begin` to the end of data; bss follows, zeroed
  std::uint32_t data_begin = 0;  ///< local-store address of the writable initialised data
  std::uint32_t data_end = 0;
  std::uint32_t entry = 0;                         ///< local-store address
  std::uint32_t text_begin = 0, text_end = 0;      ///< local-store addresses of the instructions
  std::uint32_t rodata_begin = 0, rodata_end = 0;  ///< and of the constants
  ImageSizes sizes;
  std::vector<ImageObject> objects;                   ///< in order of address
  std::shared_ptr<const std::vector<std::byte>> elf;  ///< the file, for its line table
  bool checked = false;                               ///< built with calls for every load and store
};

/// Reads a kernel that was linked with spu_kernels/sdk/ls.ld.
/// Any thread.
/// @throws std::runtime_error  with the image's name and the reason: not ELF, another machine or class,
///                             truncated, linked by another script, a relocation left, larger than a local
///                             store, segments that overlap, an entry outside the text.
KernelImage load_image(std::string_view name, std::span<const std::byte> elf);

}  // namespace softcell::ls_sim
