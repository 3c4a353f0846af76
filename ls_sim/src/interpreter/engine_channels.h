#pragma once
// The channels of a program on an SPE.

#include "channel_access.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::ls_sim::interpreter {

/// The parameters of an MFC command are kept until its opcode is written, and then issued with it.
class EngineChannels final : public ChannelAccess {
 public:
  /// @param is_checked  whether to pass `sync` on, for the checker. The engine itself never executes stale instructions.
  EngineChannels(SpuState& state, ChannelPort& port, bool is_checked)
      : ChannelAccess(state, &port), is_checked_(is_checked) {}

  void sync() override {
    if (is_checked_) ChannelAccess::sync();
  }

  bool write_channel(std::uint32_t channel, std::uint32_t value) override {
    switch (static_cast<Channel>(channel)) {
      case Channel::kMfcLsa:
        command_.lsa.value = value;
        return true;
      case Channel::kMfcEah:
        command_.ea.value = std::uint64_t{value} << 32 | (command_.ea.value & 0xFFFFFFFFu);
        return true;
      case Channel::kMfcEal:
        command_.ea.value = (command_.ea.value & ~std::uint64_t{0xFFFFFFFFu}) | value;
        return true;
      case Channel::kMfcSize:
        command_.size = value;
        return true;
      case Channel::kMfcTagId:
        command_.tag = value;
        return true;
      case Channel::kMfcCmd:
        command_.word = value;
        return ask([&] { return port_->issue(command_); }, value);
      default:
        return ChannelAccess::write_channel(channel, value);
    }
  }

 private:
  dma::MfcCommand command_;
  bool is_checked_;
};

}  // namespace softcell::ls_sim::interpreter
