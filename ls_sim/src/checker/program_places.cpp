#include "program_places.h"

#include <cstring>

#include "image/function_names.h"

namespace softcell::ls_sim {
namespace {

constexpr std::uint32_t kCallBytes = 5;

}  // namespace

void ProgramPlaces::begin_run(const KernelImage& image, const StackRange& stack) {
  image_ = &image;
  stack_ = stack;
  debug_information_ = &debug_information_of(image);
}

const ProgramPlaces::DebugInformation& ProgramPlaces::debug_information_of(const KernelImage& image) {
  // A program may load images without end.
  constexpr std::size_t kMostKnown = 64;
  const void* const file = image.elf.get();
  if (known_files_.size() == kMostKnown && !known_files_.contains(file)) known_files_.clear();
  std::unique_ptr<DebugInformation>& known = known_files_[file];
  if (known == nullptr) known = std::make_unique<DebugInformation>(image);
  return *known;
}

std::string ProgramPlaces::of(Address instruction) const {
  const std::string place = debug_information_->lines.place_of(instruction);
  return place.empty() ? function_at(*image_, instruction) : place;
}

std::string ProgramPlaces::in_program(Address instruction, std::uint32_t stack_pointer) const {
  constexpr int kDeepest = 8;  // calls in the library
  CallFrame frame{instruction, stack_pointer};
  for (int calls = 0; calls < kDeepest && debug_information_->lines.is_in_library(frame.instruction);
       ++calls) {
    const ImageObject* const function = function_of(*image_, frame.instruction);
    const auto caller = function == nullptr ? std::nullopt : caller_of(*function, frame.stack_pointer);
    if (!caller) break;
    if (!debug_information_->lines.is_in_library(caller->instruction))
      return of(caller->instruction) + " (" + caller->called->name + ")";
    frame = *caller;
  }
  return of(instruction);
}

/// The place that an instruction of 5 bytes goes to, a call or a jump by 32 bits. [AMD64 manual, volume 3] documented
std::optional<std::uint32_t> ProgramPlaces::target_of(std::uint32_t instruction, std::byte opcode) const {
  if (local_store_[instruction] != opcode) return std::nullopt;
  std::int32_t distance = 0;
  std::memcpy(&distance, &local_store_[instruction + 1], sizeof distance);
  return instruction + kCallBytes + static_cast<std::uint32_t>(distance);
}

/// Who has called this function: the first return address on the stack behind a call of it, or of a function that ends by a jump to it.
/// Nothing for one that was called by a pointer.
std::optional<ProgramPlaces::CallFrame> ProgramPlaces::caller_of(const ImageObject& function,
                                                                 std::uint32_t stack_pointer) const {
  constexpr std::uint32_t kSlotBytes = 8;
  constexpr std::byte kCall{0xE8}, kJump{0xE9};
  const auto jumps_to_it = [&](const ImageObject& other) {
    for (std::uint32_t at = other.begin.value; at + kCallBytes <= other.begin.value + other.bytes; ++at)
      if (target_of(at, kJump) == function.begin.value) return true;
    return false;
  };
  const auto base = reinterpret_cast<std::uintptr_t>(local_store_.data());
  for (std::uint32_t slot = (stack_pointer + kSlotBytes - 1) / kSlotBytes * kSlotBytes; in_stack(slot);
       slot += kSlotBytes) {
    std::uint64_t behind = 0;
    std::memcpy(&behind, &local_store_[slot], sizeof behind);
    behind -= base;
    if (behind < image_->text_begin + kCallBytes || behind > image_->text_end) continue;
    const auto call = static_cast<std::uint32_t>(behind) - kCallBytes;
    const auto target = target_of(call, kCall);
    const ImageObject* const called = target ? function_of(*image_, {*target}) : nullptr;
    if (called == nullptr || called->begin.value != *target) continue;
    if (called->begin.value != function.begin.value && !jumps_to_it(*called)) continue;
    return CallFrame{{call}, slot + kSlotBytes, called};
  }
  return std::nullopt;
}

}  // namespace softcell::ls_sim
