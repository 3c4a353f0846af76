#pragma once
// A kernel's surroundings without an emulator: code runs on a stack inside 256 KB of aligned memory, at whose
// start lies the environment, and what it asks of the gate is written down.

#include <gtest/gtest.h>
#include <pthread.h>
#include <softcell_environment.h>
#include <sys/mman.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

namespace softcell::test {

constexpr std::size_t kLocalStoreBytes = 256 * 1024;

/// One call of the gate, with the environment's DMA parameters at that moment.
struct GateCall {
  std::uint32_t kind = 0, channel = 0, value = 0;
  std::uint32_t lsa = 0, eah = 0, eal = 0, size = 0, tag = 0, tag_mask = 0;
};

class LocalStoreThread {
 public:
  LocalStoreThread() {
    mapping_ =
        mmap(nullptr, 2 * kLocalStoreBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping_ == MAP_FAILED) throw std::bad_alloc();
    base_ = (reinterpret_cast<std::uintptr_t>(mapping_) + kLocalStoreBytes - 1) & ~(kLocalStoreBytes - 1);
    softcell_sdk::Environment environment{};
    environment.gate = reinterpret_cast<std::uint64_t>(&gate);
    std::memcpy(base(), &environment, sizeof environment);
  }
  ~LocalStoreThread() { munmap(mapping_, 2 * kLocalStoreBytes); }
  LocalStoreThread(const LocalStoreThread&) = delete;
  LocalStoreThread& operator=(const LocalStoreThread&) = delete;

  std::byte* base() const { return reinterpret_cast<std::byte*>(base_); }
  std::byte* at(std::uint32_t address) const { return base() + address; }

  /// What the gate answers, by kind, channel and value; 0 without it. It may also change the local store.
  std::function<std::uint32_t(const GateCall&)> answer;

  /// Runs `kernel` with its stack in the upper half of the local store; returns what it asked of the gate.
  std::vector<GateCall> run(std::function<void()> kernel) {
    calls_.clear();
    kernel_ = std::move(kernel);
    current() = this;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstack(&attributes, base() + kLocalStoreBytes / 2, kLocalStoreBytes / 2);
    pthread_t thread{};
    const int failed = pthread_create(
        &thread, &attributes,
        [](void* self) -> void* {
          static_cast<LocalStoreThread*>(self)->kernel_();
          return nullptr;
        },
        this);
    pthread_attr_destroy(&attributes);
    EXPECT_EQ(failed, 0) << std::strerror(failed);
    if (failed == 0) pthread_join(thread, nullptr);
    return calls_;
  }

 private:
  static LocalStoreThread*& current() {
    static LocalStoreThread* thread = nullptr;
    return thread;
  }
  static std::uint32_t gate(std::uint32_t operation, std::uint32_t value) {
    LocalStoreThread& self = *current();
    softcell_sdk::Environment e;
    std::memcpy(&e, self.base(), sizeof e);
    self.calls_.push_back({operation >> 8, operation & 0xFF, value, e.mfc_lsa, e.mfc_eah, e.mfc_eal,
                           e.mfc_size, e.mfc_tag, e.mfc_tag_mask});
    return self.answer ? self.answer(self.calls_.back()) : 0;
  }

  void* mapping_ = nullptr;
  std::uintptr_t base_ = 0;
  std::function<void()> kernel_;
  std::vector<GateCall> calls_;
};

}  // namespace softcell::test
