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

/// Bytes at the bottom of every local store that belong to the emulator: the environment through which a kernel on the native engine
/// reaches its channels. An SPU program linked at 0x80 leaves them free as well.
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

/// The machine whose instructions an image has, which decides the engine that runs it.
enum class Machine : std::uint8_t {
  kHost,  ///< the host's: made by softcell_add_spu_kernel
  kSpu,   ///< the SPU's: an executable of a real SPU compiler
};

/// A kernel as load_image() reads it: bytes that run wherever they are copied, and what is known about them.
struct KernelImage {
  std::string name;
  Machine machine = Machine::kHost;
  std::uint32_t begin = kEnvironmentBytes;  ///< local-store address of the first byte
  /// Local-store address from which its stack grows down. An image that is linked above the bottom of the
  /// local store has its stack below itself.
  std::uint32_t stack_top = dma::kLocalStoreBytes;
  std::vector<std::byte> bytes;  ///< from `begin` to the end of data; bss follows, zeroed
  std::uint32_t data_begin = 0;  ///< local-store address of the writable initialised data
  std::uint32_t data_end = 0;
  std::uint32_t entry = 0;                         ///< local-store address
  std::uint32_t main = 0;                          ///< local-store address of main; 0: not known
  std::uint32_t text_begin = 0, text_end = 0;      ///< local-store addresses of the instructions
  std::uint32_t rodata_begin = 0, rodata_end = 0;  ///< and of the constants
  ImageSizes sizes;
  /// A program that is loaded whole, with a heap between its bss and its stack.
  bool program = false;
  /// For a program: local-store addresses of words that hold an address in the program; the address of the local store on the host is added
  /// to them. An image that is moved by DMA has none.
  std::vector<dma::LocalStoreAddress> relocations;
  std::vector<ImageObject> objects;                   ///< in order of address
  std::vector<ImageObject> functions;                 ///< in order of address
  std::shared_ptr<const std::vector<std::byte>> elf;  ///< the file, for its line table
  bool checked = false;                               ///< built with calls for every load and store
};

/// Reads a kernel that was linked with spu_kernels/sdk/ls.ld.
/// Any thread.
/// @throws std::runtime_error  with the image's name and the reason: not ELF, another machine or class,
///                             truncated, linked by another script, a relocation left, larger than a local
///                             store, segments that overlap, an entry outside the text.
KernelImage load_image(std::string_view name, std::span<const std::byte> elf);

/// The bytes of a section of such a file; none if there is no such section, or the file is another one. softcell-spu-gcc puts the checked
/// build of a program into its section .softcell.checked, and its name into .softcell.name.
std::span<const std::byte> image_section(std::span<const std::byte> elf, std::string_view section);

/// True if the bytes begin like an ELF file for the SPU: 32 bits, big-endian, machine 23.
bool is_spu_program(std::span<const std::byte> elf);

/// Reads an executable that a compiler for the SPU has made, for the interpreter. Its segments may lie anywhere in the local store; the
/// bytes above them are for its stack, which begins where its start-up code or the loader puts it.
/// Any thread.
/// @throws std::runtime_error  with the program's name and the reason: not ELF, another machine or class, not linked,
///                             truncated, nothing to load, overlays, segments that overlap or leave the local store,
///                             an entry outside the loaded bytes.
/// @source  [GNU binutils, libspe2's loader] second-hand
KernelImage load_spu_program(std::string_view name, std::span<const std::byte> elf);

}  // namespace softcell::ls_sim
