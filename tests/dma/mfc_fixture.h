#pragma once
// What most MFC tests need: a local store, a buffer in main memory, and short words for commands and waits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/dma/mfc.h"

namespace softcell::dma {

inline constexpr Schedule kEager{Schedule::kEager, 0};
inline constexpr Schedule kLazy{Schedule::kLazy, 0};

/// In the names of tests.
inline void PrintTo(const Schedule& schedule, std::ostream* out) { *out << to_string(schedule); }

inline MfcCommand command(MfcOpcode opcode, std::uint32_t lsa, EffectiveAddress ea, std::uint32_t size,
                          std::uint32_t tag) {
  return {static_cast<std::uint32_t>(opcode), {lsa}, ea, size, tag};
}

/// One SPE's view: everything an MFC works on, the MFC under the given schedule, and the calls of a kernel.
class MfcBench {
 public:
  static constexpr std::size_t kBufferBytes = 65536;

  explicit MfcBench(Schedule schedule, std::uint64_t stream = 0)
      : buffer(space, "buffer", kBufferBytes), store(kLocalStoreBytes), mfc(store, space, schedule, stream) {}

  void issue(MfcOpcode opcode, std::uint32_t lsa, std::uint32_t offset, std::uint32_t size,
             std::uint32_t tag) {
    const std::optional<Fault> fault = mfc.issue(command(opcode, lsa, buffer.ea() + offset, size, tag));
    ASSERT_FALSE(fault) << fault->message();
  }

  /// An element that moves `size` bytes at `offset` of the buffer.
  ListElement element(std::uint32_t size, std::uint32_t offset) const {
    return {size, static_cast<std::uint32_t>(buffer.ea().value) + offset};
  }
  ListElement stalling(std::uint32_t size, std::uint32_t offset) const {
    return {size | ListElement::kStallBit, static_cast<std::uint32_t>(buffer.ea().value) + offset};
  }

  /// Where lists lie in the local store.
  static constexpr std::uint32_t kListLsa = 0x30000;

  /// The command for a list that lies in the local store at `list`.
  MfcCommand list_command(MfcOpcode opcode, std::uint32_t lsa, std::size_t elements, std::uint32_t tag,
                          std::uint32_t list = kListLsa) const {
    const EffectiveAddress ea{(buffer.ea().value >> 32 << 32) | list};
    return command(opcode, lsa, ea, static_cast<std::uint32_t>(elements * kListElementBytes), tag);
  }
  void write_list(const std::vector<ListElement>& elements, std::uint32_t list = kListLsa) {
    std::memcpy(&store[list], elements.data(), elements.size() * sizeof(ListElement));
  }
  void issue_list(MfcOpcode opcode, std::uint32_t lsa, const std::vector<ListElement>& elements,
                  std::uint32_t tag, std::uint32_t list = kListLsa) {
    write_list(elements, list);
    const std::optional<Fault> fault = mfc.issue(list_command(opcode, lsa, elements.size(), tag, list));
    ASSERT_FALSE(fault) << fault->message();
  }

  std::uint32_t wait(std::uint32_t mask, std::uint32_t condition) {
    mfc.write_tag_mask(mask);
    EXPECT_FALSE(mfc.write_tag_update(condition));
    const auto status = mfc.read_tag_status();
    EXPECT_TRUE(std::holds_alternative<std::uint32_t>(status));
    return std::holds_alternative<std::uint32_t>(status) ? std::get<std::uint32_t>(status) : 0;
  }
  std::uint32_t wait_immediate(std::uint32_t mask) { return wait(mask, 0); }
  std::uint32_t wait_any(std::uint32_t mask) { return wait(mask, 1); }
  std::uint32_t wait_all(std::uint32_t mask) { return wait(mask, 2); }

  void fill_buffer(std::uint32_t offset, std::uint32_t bytes, int value) {
    std::fill_n(buffer.data() + offset, bytes, static_cast<std::byte>(value));
  }
  void fill_store(std::uint32_t lsa, std::uint32_t bytes, int value) {
    std::fill_n(store.begin() + lsa, bytes, static_cast<std::byte>(value));
  }
  /// How many of the local store's bytes from `lsa` on hold `value`.
  std::ptrdiff_t count_in_store(std::uint32_t lsa, std::uint32_t bytes, int value) const {
    const auto range = std::span(store).subspan(lsa, bytes);
    return std::count(range.begin(), range.end(), static_cast<std::byte>(value));
  }
  int store_at(std::uint32_t lsa) const { return std::to_integer<int>(store[lsa]); }
  int buffer_at(std::uint32_t offset) const { return std::to_integer<int>(buffer[offset]); }

  AddressSpace space;
  Buffer<std::byte> buffer;
  std::vector<std::byte> store;
  Mfc mfc;
};

/// Eager, lazy and a few random ones.
inline std::vector<Schedule> all_schedules() {
  std::vector<Schedule> schedules{{Schedule::kEager, 0}, {Schedule::kLazy, 0}};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) schedules.push_back({Schedule::kRandom, seed});
  return schedules;
}

inline std::string schedule_test_name(const testing::TestParamInfo<Schedule>& info) {
  std::string name = to_string(info.param);
  std::replace(name.begin(), name.end(), ':', '_');
  return name;
}

}  // namespace softcell::dma
