#pragma once
// The channels as a table.

#include <cstdint>
#include <string_view>

namespace softcell::ls_sim {

/// Direction of a channel as the SPU sees it; kNone: there is no such channel.
enum class ChannelAccess : std::uint8_t { kNone, kRead, kWrite };

/// All channel numbers are below this.
inline constexpr std::uint32_t kChannelCount = 72;

/// The channel's name in the manual's spelling ("MFC_RdTagStat"); an empty string if there is no such
/// channel. Any thread. [CBEA, channels] documented
std::string_view channel_name(std::uint32_t number);

/// The channel's direction. Any thread.
ChannelAccess channel_access(std::uint32_t number);

}  // namespace softcell::ls_sim
