#pragma once
// The SPU's channels: its only way to the MFC and to anything outside.

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

/// The first of the stop codes 0x2100 to 0x21FF, by which a program calls a function of the PPU side. [libspe2, newlib] documented
inline constexpr std::uint32_t kAssistedCalls = 0x2100;

/// The result of a channel operation: a value, or the fault that stops the SPU. It fits into two registers, because every command of a
/// kernel returns one.
struct ChannelReply {
  std::uint32_t value = 0;
  std::unique_ptr<dma::Fault> fault;
};

/// The channels as an engine calls them, from the thread that runs the SPE. Reading an empty channel and
/// writing a full one wait.
class ChannelPort {
 public:
  virtual ~ChannelPort() = default;
  virtual ChannelReply read(std::uint32_t channel) = 0;
  virtual ChannelReply write(std::uint32_t channel, std::uint32_t value) = 0;

  /// The number of reads or writes that would not wait: rchcnt.
  virtual ChannelReply count(std::uint32_t channel) = 0;

  /// Issues a DMA command: the writes to MFC_LSA, MFC_EAH, MFC_EAL, MFC_Size, MFC_TagID and MFC_Cmd in one
  /// call.
  virtual ChannelReply issue(const dma::MfcCommand& command) = 0;

  /// The instruction `sync`: from now on the SPU executes the instructions that were written to the local store before.
  virtual void sync() = 0;

  /// The SPU has stopped with a code that does not end its program. Returns when the PPU side lets it continue.
  /// @param assist  for a call of the PPU side (codes 0x2100 to 0x21FF): the address of the word that says what is called,
  ///                operation << 24 | the local-store address of the arguments; on an SPU, it follows the
  ///                instruction. [libspe2, newlib] documented
  /// @return  whether it continues; otherwise its run ends with this code.
  virtual bool stop(std::uint32_t code, dma::LocalStoreAddress assist) {
    static_cast<void>(code);
    static_cast<void>(assist);
    return false;
  }
};

}  // namespace softcell::ls_sim
