#pragma once
// The channels as a table.

#include <cstdint>
#include <string_view>

namespace softcell::ls_sim {

/// Which way a channel goes, as the SPU sees it; kNone: there is no such channel.
enum class ChannelAccess : std::uint8_t { kNone, kRead, kWrite };

/// The numbers of channels are below this.
inline constexpr std::uint32_t kChannelCount = 72;

/// The manual's spelling of a channel's number ("MFC_RdTagStat"); an empty string for a number that is no
/// channel. [CBEA, channels] documented
std::string_view channel_name(std::uint32_t number);

ChannelAccess channel_access(std::uint32_t number);

}  // namespace softcell::ls_sim
