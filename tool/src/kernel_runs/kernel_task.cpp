#include "kernel_task.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <set>

#include "kernel_file.h"
#include "verb/exit_status.h"
#include "verb/output_files.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kInMboxDepth = 4;  // [CBEA, SPU mailboxes] documented
constexpr std::size_t kThreadArguments = 4;

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || digit(c); });
}

/// The whole text as a number in decimal or, after 0x, in hexadecimal.
std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
  const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
  if (hexadecimal) text.remove_prefix(2);
  std::uint64_t value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, hexadecimal ? 16 : 10);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> parse_integer(std::string_view text) {
  if (!text.starts_with('-')) return parse_unsigned(text);
  const auto magnitude = parse_unsigned(text.substr(1));
  if (!magnitude || *magnitude > std::uint64_t{1} << 63) return std::nullopt;
  return 0 - *magnitude;
}

template <class Number>
std::optional<Number> parse_real(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> parse_size(std::string_view text) {
  std::uint64_t unit = 1;
  if (text.ends_with('K') || text.ends_with('M')) {
    unit = text.back() == 'K' ? 1024 : 1024 * 1024;
    text.remove_suffix(1);
  }
  const auto count = parse_unsigned(text);
  if (!count || *count == 0 || *count > (std::uint64_t{1} << 40) / unit) return std::nullopt;
  return *count * unit;
}

const char* option(BufferSpec::Direction direction) {
  switch (direction) {
    case BufferSpec::kIn:
      return "--in ";
    case BufferSpec::kOut:
      return "--out ";
    default:
      return "--inout ";
  }
}

/// The name before the '=' and the text after it.
std::pair<std::string, std::string> split_name(const std::string& text, const std::string& refusal) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size() || !is_name(text.substr(0, equals)))
    throw UsageError(refusal);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

std::string_view name(BufferSpec::Direction direction) {
  switch (direction) {
    case BufferSpec::kIn:
      return "in";
    case BufferSpec::kOut:
      return "out";
    default:
      return "inout";
  }
}

std::optional<ls_sim::Machine> parse_engine(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (text == "native") return ls_sim::Machine::kHost;
  if (text == "interpreter") return ls_sim::Machine::kSpu;
  throw UsageError("--engine " + text + ": give native or interpreter");
}

ls_sim::EntryState parse_entry(const std::string& text) {
  if (text == "libspe2") return ls_sim::EntryState::kLibspe2;
  if (text == "thread-group") return ls_sim::EntryState::kThreadGroup;
  throw UsageError("--entry " + text + ": give libspe2 or thread-group");
}

BufferSpec parse_file_buffer(BufferSpec::Direction direction, const std::string& text) {
  auto [name, file] = split_name(
      text, option(direction) + text + ": give NAME=FILE, NAME of letters, digits and underscores");
  if (file == kStandardOutput)
    throw UsageError(option(direction) + text +
                     ": a buffer is filled from a file, not from standard input; ./- is a file of that name");
  return {direction, std::move(name), std::move(file)};
}

BufferSpec parse_out_buffer(const std::string& text) {
  const std::string refusal =
      "--out " + text + ": give NAME=FILE:SIZE, SIZE in bytes or with K or M, for example y=y.bin:4096";
  auto [name, rest] = split_name(text, refusal);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos || colon == 0) throw UsageError(refusal);
  const auto bytes = parse_size(std::string_view(rest).substr(colon + 1));
  if (!bytes) throw UsageError(refusal);
  return {BufferSpec::kOut, std::move(name), rest.substr(0, colon), *bytes};
}

ArgumentSpec parse_argument(const std::string& text) {
  const std::string_view rest = std::string_view(text).substr(std::min<std::size_t>(1, text.size()));
  if (text.starts_with('@') && is_name(rest)) return AddressOf{std::string(rest)};
  if (text.starts_with('#') && is_name(rest)) return SizeOf{std::string(rest)};
  if (text.starts_with("f32:")) {
    if (const auto value = parse_real<float>(std::string_view(text).substr(4)))
      return std::uint64_t{std::bit_cast<std::uint32_t>(*value)};
  } else if (const auto value = parse_integer(text)) {
    return *value;
  }
  throw UsageError("--arg " + text +
                   ": give a 64-bit integer (12, 0x1F), f32:VALUE, @NAME (address of a buffer) or #NAME (its "
                   "size in bytes)");
}

std::uint32_t parse_mbox_value(const std::string& text) {
  const auto value = parse_unsigned(text);
  if (!value || *value > 0xFFFF'FFFF)
    throw UsageError("--in-mbox " + text + ": give a number from 0 to 0xFFFFFFFF");
  return static_cast<std::uint32_t>(*value);
}

std::vector<NamedFile> written_files(const KernelTask& task) {
  std::vector<NamedFile> files;
  for (const BufferSpec& buffer : task.buffers) {
    if (buffer.direction != BufferSpec::kIn)
      files.push_back({option(buffer.direction) + buffer.name, buffer.file});
  }
  return files;
}

std::vector<NamedFile> read_files(const KernelTask& task) {
  std::vector<NamedFile> files;
  if (const auto image = find_kernel_file(task.image, task.checked)) {
    files.push_back({"the kernel image", task.image});
    files.push_back({"the kernel image", image});
  }
  for (const BufferSpec& buffer : task.buffers) {
    if (buffer.direction == BufferSpec::kIn)
      files.push_back({option(buffer.direction) + buffer.name, buffer.file});
  }
  return files;
}

void check(const KernelTask& task) {
  check_distinct(written_files(task));
  std::set<std::string_view> names;
  for (const BufferSpec& buffer : task.buffers) {
    if (!names.insert(buffer.name).second)
      throw UsageError("two buffers are called " + buffer.name + "; each needs a name of its own");
  }
  for (const ArgumentSpec& argument : task.arguments) {
    const auto known = [&](const std::string& buffer, const char* mark) {
      if (!names.contains(buffer))
        throw UsageError("--arg " + std::string(mark) + buffer + ": no --in, --out or --inout has that name");
    };
    if (const auto* address = std::get_if<AddressOf>(&argument)) known(address->buffer, "@");
    if (const auto* size = std::get_if<SizeOf>(&argument)) known(size->buffer, "#");
  }
  if (task.entry_state == ls_sim::EntryState::kThreadGroup && task.arguments.size() > kThreadArguments)
    throw UsageError(
        "--entry thread-group takes at most four words of --arg, as a thread has no more arguments");
  if (task.in_mbox.size() > kInMboxDepth)
    throw UsageError("--in-mbox takes at most four values, as an inbound mailbox holds no more");
}

}  // namespace softcell::tool
