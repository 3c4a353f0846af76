#pragma once
// The PPU side's door to one SPE: its problem state.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "channels/spe_monitor.h"
#include "channels/spe_registers.h"
#include "softcell/base/assert.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/proxy_queue.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/spe_options.h"
#include "spe.h"

namespace softcell::ls_sim {

/// Tells apart the random schedules of proxy queues from those of runs.
inline constexpr std::uint64_t kProxyStreams = 0x7072'6F78'7900;

/// A local store in main storage, while the object lives.
class MappedLocalStore {
 public:
  MappedLocalStore(dma::AddressSpace& memory, int spe, dma::LocalStorePort& port)
      : memory_(memory), spe_(spe) {
    memory_.map_local_store(spe_, port);
  }
  ~MappedLocalStore() { memory_.unmap_local_store(spe_); }
  MappedLocalStore(const MappedLocalStore&) = delete;
  MappedLocalStore& operator=(const MappedLocalStore&) = delete;

 private:
  dma::AddressSpace& memory_;
  int spe_;
};

/// One SPE's problem state. Where the SPE may wait for what is done here, it is woken.
class Door final : public ProblemState {
 public:
  Door(SpeMonitor& monitor, Spe& spe, dma::AddressSpace& memory, const SpeOptions& options, int number,
       std::function<void()> start)
      : monitor_(monitor),
        number_(number),
        spe_(spe),
        registers_(spe_.registers()),
        proxy_(spe_, memory, options.schedule, kProxyStreams + static_cast<std::uint64_t>(number),
               std::move(start)),
        mapped_(memory, number, spe_),
        ea_(memory.local_store_ea(number)) {
    spe_.set_proxy(&proxy_);
    SC_ASSERT(ea_.value % dma::kLocalStoreBytes == 0, "the local store of SPE {} lies at {}", number_, ea_);
  }

  std::optional<std::uint32_t> read_out_mbox() override { return look(&SpeRegisters::read_out_mbox); }
  std::optional<std::uint32_t> read_out_intr_mbox() override {
    return look(&SpeRegisters::read_out_intr_mbox);
  }
  std::optional<std::uint32_t> wait_out_mbox() override {
    return wait_for(&SpeRegisters::out_mbox, &SpeRegisters::read_out_mbox);
  }
  std::optional<std::uint32_t> wait_out_intr_mbox() override {
    return wait_for(&SpeRegisters::out_intr_mbox, &SpeRegisters::read_out_intr_mbox);
  }

  void write_in_mbox(std::uint32_t value) override {
    spe_.on_register_write(dma::SpeRegister::kInMbox, value);
  }

  std::uint32_t mbox_status() override {
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_pause(lock);
    return registers_.out_mbox.count() | registers_.in_mbox.free_slots() << 8 |
           registers_.out_intr_mbox.count() << 16;
  }

  void write_signal(int which, std::uint32_t value) override {
    check_signal(which);
    spe_.on_register_write(which == 1 ? dma::SpeRegister::kSignal1 : dma::SpeRegister::kSignal2, value);
  }

  void set_signal_mode(int which, SignalMode mode) override {
    check_signal(which);
    const SpeMonitor::Lock lock = monitor_.lock();
    registers_.signal(which).set_mode(mode);
  }

  std::optional<dma::Fault> issue_proxy(const dma::MfcCommand& command) override {
    if (auto fault = proxy_.issue(command)) {
      fault->spe = number_;
      fault->is_of_proxy = true;
      return fault;
    }
    SpeMonitor::Lock lock = monitor_.lock();
    if (monitor_.runs(number_)) {
      registers_.proxy_issued = true;
      monitor_.wake(number_);
    } else {
      lock.unlock();
      move_proxy();
    }
    return std::nullopt;
  }

  std::uint32_t proxy_status(std::uint32_t tag_mask) override {
    pause();
    return proxy_.complete_tags(tag_mask);
  }
  std::uint32_t wait_proxy(std::uint32_t tag_mask) override { return proxy_.wait_all(tag_mask); }
  std::uint32_t wait_any_proxy(std::uint32_t tag_mask) { return proxy_.wait_any(tag_mask); }
  std::optional<dma::Fault> poll_proxy_fault() {
    auto fault = proxy_.poll_fault();
    if (fault) {
      fault->spe = number_;
      fault->is_of_proxy = true;
    }
    return fault;
  }
  int free_proxy_slots() override {
    pause();
    return proxy_.free_slots();
  }

  void write_local_store(dma::LocalStoreAddress lsa, std::span<const std::byte> bytes) override {
    if (bytes.size() > dma::kLocalStoreBytes || lsa.value > dma::kLocalStoreBytes - bytes.size()) {
      throw std::invalid_argument(std::to_string(bytes.size()) + " bytes written to local-store address " +
                                  std::to_string(lsa.value) + " pass its end at " +
                                  std::to_string(dma::kLocalStoreBytes));
    }
    const auto size = static_cast<std::uint32_t>(bytes.size());
    spe_.on_external_write(lsa, size);
    dma::copy_to_local_store(&spe_.local_store()[lsa.value], bytes.data(), size);
  }
  std::span<std::byte> local_store() override {
    spe_.on_shared();
    return spe_.local_store();
  }
  dma::EffectiveAddress local_store_ea() const override { return ea_; }

  /// Sets the byte order of the local store, which is that of the loaded image.
  void set_big_endian(bool is_big_endian) { proxy_.set_big_endian(is_big_endian); }

  /// Moves all proxy transfers that can move. Call it before the PPU side waits or the SPE sleeps: on the hardware transfers go on
  /// meanwhile.
  void move_proxy() {
    while (proxy_.advance()) {
    }
  }

 private:
  using Read = std::optional<std::uint32_t> (SpeRegisters::*)();

  static void check_signal(int which) {
    if (which != 1 && which != 2) {
      throw std::invalid_argument("signal register " + std::to_string(which) + "; there are 1 and 2");
    }
  }

  void pause() {
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_pause(lock);
  }

  /// Reads a register and wakes who may wait for it. Call it with the lock.
  std::optional<std::uint32_t> take(Read read) {
    const auto value = (registers_.*read)();
    if (value) monitor_.wake(number_);  // it may wait to write the next
    return value;
  }

  std::optional<std::uint32_t> look(Read read) {
    SpeMonitor::Lock lock = monitor_.lock();
    auto value = take(read);
    if (!value) monitor_.ppu_pause(lock);
    return value;
  }

  std::optional<std::uint32_t> wait_for(Mailbox<1> SpeRegisters::*mailbox, Read read) {
    move_proxy();
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_wait(lock, [&] { return !(registers_.*mailbox).empty() || !monitor_.runs(number_); });
    return take(read);
  }

  SpeMonitor& monitor_;
  int number_;
  Spe& spe_;
  SpeRegisters& registers_;  // guarded by the monitor's lock
  dma::ProxyQueue proxy_;
  MappedLocalStore mapped_;
  dma::EffectiveAddress ea_;
};

}  // namespace softcell::ls_sim
