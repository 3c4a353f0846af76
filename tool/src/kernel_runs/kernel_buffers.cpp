#include "kernel_buffers.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"
#include "softcell/base/read_file.h"

namespace softcell::tool {
namespace {

void check_fits(const BufferSpec& spec, std::uint64_t bytes, std::uint64_t free_bytes) {
  if (bytes <= free_bytes) return;
  throw std::runtime_error("buffer " + spec.name + " of " + std::to_string(bytes) +
                           " bytes does not fit: main memory has " + std::to_string(free_bytes) +
                           " bytes left");
}

std::vector<std::byte> initial_bytes(const BufferSpec& spec, std::uint64_t free_bytes) {
  if (spec.direction == BufferSpec::kOut) {
    check_fits(spec, spec.bytes, free_bytes);
    return std::vector<std::byte>(spec.bytes);
  }
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(spec.file, error);
  if (!error) check_fits(spec, size, free_bytes);  // before reading the file
  auto bytes = base::read_file(spec.file, free_bytes);
  if (bytes.empty())
    throw std::runtime_error("buffer " + spec.name + ": " + spec.file.string() +
                             " is empty, and a buffer has at least one byte");
  return bytes;
}

}  // namespace

KernelBuffers::KernelBuffers(dma::AddressSpace& memory, const KernelTask& task)
    : word_count_(task.arguments.size()), entry_state_(task.entry_state) {
  for (const BufferSpec& spec : task.buffers) {
    Slot slot{&spec, {}, initial_bytes(spec, memory.largest_free_range(dma::Memory::kMain))};
    const auto access =
        spec.direction == BufferSpec::kIn ? dma::SpeAccess::kRead : dma::SpeAccess::kReadWrite;
    slot.memory = dma::Buffer<std::byte>(memory, spec.name, slot.initial.size(), {.spe_access = access});
    slots_.push_back(std::move(slot));
  }
  if (word_count_ != 0) {
    words_ =
        dma::Buffer<std::uint64_t>(memory, "arguments", word_count_, {.spe_access = dma::SpeAccess::kRead});
    std::transform(task.arguments.begin(), task.arguments.end(), words_.data(),
                   [this](const ArgumentSpec& argument) { return word(argument); });
  }
  reset();
}

void KernelBuffers::reset() {
  for (Slot& slot : slots_) {
    SC_ASSERT(slot.initial.size() == slot.memory.size(), "{} bytes for buffer {} of {}", slot.initial.size(),
              slot.spec->name, slot.memory.size());
    std::copy(slot.initial.begin(), slot.initial.end(), slot.memory.data());
  }
}

ls_sim::EntryArguments KernelBuffers::arguments(int spe) const {
  if (entry_state_ == ls_sim::EntryState::kThreadGroup) {
    const auto argument = [this](std::size_t i) { return i < word_count_ ? words_[i] : 0; };
    return {.spe_id = argument(0),
            .argp = argument(1),
            .envp = argument(2),
            .fourth = argument(3),
            .entry_state = entry_state_};
  }
  return {.spe_id = static_cast<std::uint64_t>(spe), .argp = words_.ea().value, .envp = word_count_};
}

const KernelBuffers::Slot& KernelBuffers::slot(std::string_view buffer) const {
  const auto found =
      std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.spec->name == buffer; });
  SC_ASSERT(found != slots_.end(), "no buffer {} among {}", buffer, slots_.size());
  return *found;
}

std::uint64_t KernelBuffers::word(const ArgumentSpec& argument) const {
  if (const auto* address = std::get_if<AddressOf>(&argument)) return slot(address->buffer).memory.ea().value;
  if (const auto* size = std::get_if<SizeOf>(&argument)) return slot(size->buffer).memory.size_bytes();
  return std::get<std::uint64_t>(argument);
}

void KernelBuffers::write_files(OutputFiles& files) const {
  for (const Slot& slot : slots_) {
    if (slot.spec->direction == BufferSpec::kIn) continue;
    const auto bytes = slot.memory.span();
    base::WholeFile& file = files.open(slot.spec->file);
    file.write({reinterpret_cast<const char*>(bytes.data()), bytes.size_bytes()});
    file.finish();
  }
}

}  // namespace softcell::tool
