#include "softcell/ls_sim/channel_name.h"

#include <array>

namespace softcell::ls_sim {
namespace {

struct ChannelRow {
  std::string_view name;
  ChannelAccess access = ChannelAccess::kNone;
};

constexpr auto kChannels = [] {
  std::array<ChannelRow, kChannelCount> rows{};
#define SC_CHANNEL(number, enumerator, name, access) rows[number] = {name, ChannelAccess::access};
#include "softcell/ls_sim/channels.def"
#undef SC_CHANNEL
  return rows;
}();

ChannelRow row(std::uint32_t number) { return number < kChannelCount ? kChannels[number] : ChannelRow(); }

}  // namespace

std::string_view channel_name(std::uint32_t number) { return row(number).name; }
ChannelAccess channel_access(std::uint32_t number) { return row(number).access; }

}  // namespace softcell::ls_sim
