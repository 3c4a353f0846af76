#pragma once
// The SPU's channels: its only door to the MFC and to the world.

#include <cstdint>
#include <memory>

#include "softcell/dma/fault.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::ls_sim {

/// Channel numbers. [CBEA, channels] documented
enum class Channel : std::uint8_t {
#define SC_CHANNEL(number, enumerator, name, access) enumerator = (number),
#include "softcell/ls_sim/channels.def"
#undef SC_CHANNEL
};

/// What a channel operation gave: a value, or the fault that stops the SPU. It fits two registers, as there
/// is one for each command of a kernel.
struct ChannelReply {
  std::uint32_t value = 0;
  std::unique_ptr<dma::Fault> fault;
};

/// What an engine sees of its surroundings. Called by the thread that runs the SPE. Reads of an empty and
/// writes of a full channel wait.
class ChannelPort {
 public:
  virtual ~ChannelPort() = default;
  virtual ChannelReply read(std::uint32_t channel) = 0;
  virtual ChannelReply write(std::uint32_t channel, std::uint32_t value) = 0;

  /// How many reads or writes would not wait: rchcnt.
  virtual ChannelReply count(std::uint32_t channel) = 0;

  /// A whole DMA command: writes to MFC_LSA, MFC_EAH, MFC_EAL, MFC_Size, MFC_TagID and MFC_Cmd in one call.
  virtual ChannelReply issue(const dma::MfcCommand& command) = 0;

  /// The instruction `sync`: what has been written to the local store is what is executed from now on.
  virtual void sync() = 0;
};

}  // namespace softcell::ls_sim
