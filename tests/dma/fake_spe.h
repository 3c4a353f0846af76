#pragma once
// An SPE as others see it: a local store, and a record of what they wrote to it.

#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "softcell/dma/local_store_port.h"

namespace softcell::dma {

/// Any thread may write to it; look at the records when nobody does.
class FakeSpe : public LocalStorePort {
 public:
  explicit FakeSpe(std::size_t bytes = kLocalStoreBytes) : store(bytes) {}

  std::span<std::byte> local_store() override { return store; }
  void on_external_write(LocalStoreAddress lsa, std::uint32_t bytes) override {
    const std::lock_guard lock(mutex_);
    writes.emplace_back(lsa.value, bytes);
  }
  void on_register_write(SpeRegister which, std::uint32_t value) override {
    const std::lock_guard lock(mutex_);
    registers.emplace_back(which, value);
  }

  std::vector<std::byte> store;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes;  // address, bytes
  std::vector<std::pair<SpeRegister, std::uint32_t>> registers;

 private:
  std::mutex mutex_;
};

}  // namespace softcell::dma
