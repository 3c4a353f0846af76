#pragma once

#include <cstdint>
#include <string_view>

namespace softcell::ls_sim {

/// The manual's spelling of a channel's number ("MFC_RdTagStat"); an empty string for a number that is no
/// channel. [CBEA, channels] documented
std::string_view channel_name(std::uint32_t number);

}  // namespace softcell::ls_sim
