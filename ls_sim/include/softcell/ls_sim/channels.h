#pragma once
// The SPU's channels: its only door to the MFC and to the world.

#include <cstdint>
#include <memory>

#include "softcell/dma/fault.h"
#include "softcell/dma/mfc.h"

namespace softcell::ls_sim {

/// Channel numbers. [CBEA, channels] documented
enum class Channel : std::uint8_t {
  kMfcLsa = 16,
  kMfcEah = 17,
  kMfcEal = 18,
  kMfcSize = 19,
  kMfcTagId = 20,
  kMfcCmd = 21,
  kMfcWrTagMask = 22,
  kMfcWrTagUpdate = 23,
  kMfcRdTagStat = 24,
  kMfcRdTagMask = 12,
};

/// What a channel operation gave: a value, or the fault that stops the SPU. It fits two registers, as there
/// is one for each command of a kernel.
struct ChannelReply {
  std::uint32_t value = 0;
  std::unique_ptr<dma::Fault> fault;
};

/// What an engine sees of its surroundings. Called by the thread that runs the SPE.
class ChannelPort {
 public:
  virtual ~ChannelPort() = default;
  virtual ChannelReply read(std::uint32_t channel) = 0;
  virtual ChannelReply write(std::uint32_t channel, std::uint32_t value) = 0;
  virtual ChannelReply count(std::uint32_t channel) = 0;

  /// A whole DMA command: writes to MFC_LSA, MFC_EAH, MFC_EAL, MFC_Size, MFC_TagID and MFC_Cmd in one call.
  virtual ChannelReply issue(const dma::MfcCommand& command) = 0;
};

/// The channels that lead to the MFC: command parameters, tag mask, tag update and status. Any other number
/// is a fault (illegal-channel), as is a read of a channel that is only written and the reverse.
class MfcChannels final : public ChannelPort {
 public:
  explicit MfcChannels(dma::Mfc& mfc) : mfc_(mfc) {}

  ChannelReply read(std::uint32_t channel) override;
  ChannelReply write(std::uint32_t channel, std::uint32_t value) override;
  ChannelReply count(std::uint32_t channel) override;
  ChannelReply issue(const dma::MfcCommand& command) override;

 private:
  dma::Mfc& mfc_;
  dma::MfcCommand parameters_{};  ///< as written to channels 16 to 20 so far
};

}  // namespace softcell::ls_sim
