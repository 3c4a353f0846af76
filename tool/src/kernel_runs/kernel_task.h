#pragma once
// A kernel to run with the user's files as its buffers: the common part of `spu run` and `spu explore`.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/image.h"
#include "verb/verb_files.h"

namespace softcell::tool {

/// A buffer in main storage that is filled from a file, written to one, or both.
struct BufferSpec {
  enum Direction : std::uint8_t {
    kIn,     ///< read from the file; SPEs may only read it
    kOut,    ///< `bytes` zeros at first; written to the file if the run succeeds
    kInOut,  ///< read from the file, and replaces it if the run succeeds
  };
  Direction direction = kIn;
  std::string name;
  std::filesystem::path file;
  std::uint64_t bytes = 0;  ///< for kOut only
};

std::string_view name(BufferSpec::Direction direction);

/// One 64-bit word of a kernel's arguments: a number, or something about a buffer.
struct AddressOf {
  std::string buffer;
};
struct SizeOf {
  std::string buffer;
};
using ArgumentSpec = std::variant<std::uint64_t, AddressOf, SizeOf>;

struct KernelTask {
  std::string image = {};  ///< a file, or the name of a kernel of this project
  bool checked = false;
  std::optional<ls_sim::Machine> machine = {};  ///< of --engine; none: that of the image
  /// Who starts a program built for the SPU. If a thread group does, `arguments`, at most four, are main's own arguments.
  ls_sim::EntryState entry_state = ls_sim::EntryState::kLibspe2;
  std::vector<BufferSpec> buffers = {};
  std::vector<ArgumentSpec> arguments = {};
  std::vector<std::uint32_t> in_mbox = {};  ///< placed in the inbound mailbox of each SPE, at most four
  int spes = 1;
  std::chrono::milliseconds deadline{10'000};
};

// Parsers of option values.
// @throws UsageError  one sentence with the text and the allowed values.

/// "native" or "interpreter" of --engine; none for an empty text.
std::optional<ls_sim::Machine> parse_engine(const std::string& text);

/// "libspe2" or "thread-group" of --entry.
ls_sim::EntryState parse_entry(const std::string& text);

/// "NAME=FILE" of --in and --inout.
BufferSpec parse_file_buffer(BufferSpec::Direction direction, const std::string& text);

/// "NAME=FILE:SIZE" of --out. SIZE is in bytes, or with K or M after it in KB or MB.
BufferSpec parse_out_buffer(const std::string& text);

/// "@NAME" (address of a buffer), "#NAME" (its size in bytes), "f32:VALUE" (the bits of a float), or a 64-bit integer, decimal or with 0x;
/// a negative one is taken modulo 2^64.
ArgumentSpec parse_argument(const std::string& text);

/// A 32-bit number of --in-mbox.
std::uint32_t parse_mbox_value(const std::string& text);

/// The files of --out and --inout.
std::vector<NamedFile> written_files(const KernelTask& task);

/// The kernel image if it is a file, with its checked image if that is wanted, and the files of --in.
/// @throws std::runtime_error  one sentence: there is no checked image.
std::vector<NamedFile> read_files(const KernelTask& task);

/// Refuses mistakes that concern several options: two buffers with one name or one file, and arguments that name no buffer.
void check(const KernelTask& task);

}  // namespace softcell::tool
