#pragma once
// The channels as instructions reach them: those of the SPU itself, and those of the port.

#include <optional>
#include <utility>

#include "core.h"
#include "softcell/dma/fault.h"
#include "softcell/ls_sim/channels.h"

namespace softcell::ls_sim::interpreter {

/// Channels 13, 14 and 15 belong to the state of the SPU.
class ChannelAccess : public Surroundings {
 public:
  /// @param port  null: every count is 1, and reads give 0.
  ChannelAccess(SpuState& state, ChannelPort* port) : state_(state), port_(port) {}

  bool read_channel(std::uint32_t channel, std::uint32_t& value) override {
    if (channel == kMachineStatus) {
      value = state_.interrupts_enabled ? 1 : 0;
      return true;
    }
    if (channel == kReadSrr0) {
      value = state_.srr0;
      return true;
    }
    return ask([&] { return port_->read(channel); }, value);
  }

  bool count_channel(std::uint32_t channel, std::uint32_t& value) override {
    value = 1;
    return ask([&] { return port_->count(channel); }, value);
  }

  bool write_channel(std::uint32_t channel, std::uint32_t value) override {
    if (channel == kWriteSrr0) {
      state_.srr0 = value & kInstructionMask;
      return true;
    }
    return ask([&] { return port_->write(channel, value); }, value);
  }

  void sync() override {
    if (port_ == nullptr) return;
    const HostArithmetic host;
    port_->sync();
  }

  /// Why the run has ended.
  std::optional<dma::Fault> poll_fault() { return std::exchange(fault_, std::nullopt); }

 protected:
  static constexpr auto kMachineStatus = static_cast<std::uint32_t>(Channel::kSpuRdMachStat);
  static constexpr auto kWriteSrr0 = static_cast<std::uint32_t>(Channel::kSpuWrSrr0);
  static constexpr auto kReadSrr0 = static_cast<std::uint32_t>(Channel::kSpuRdSrr0);

  /// Asks the port, in the host's own mode of arithmetic.
  template <class Question>
  bool ask(Question&& question, std::uint32_t& value) {
    if (port_ == nullptr) return true;
    const HostArithmetic host;
    ChannelReply reply = question();
    if (reply.fault) fault_ = std::move(*reply.fault);
    value = reply.value;
    return !fault_;
  }

  SpuState& state_;
  ChannelPort* port_;

 private:
  std::optional<dma::Fault> fault_;
};

}  // namespace softcell::ls_sim::interpreter
