#include "softcell/ls_sim/channels.h"

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace softcell::ls_sim {
namespace {

ChannelReply reply_of(dma::Fault&& fault) { return {0, std::make_unique<dma::Fault>(std::move(fault))}; }

ChannelReply reply_of(std::optional<dma::Fault> fault) {
  return fault ? reply_of(std::move(*fault)) : ChannelReply{};
}

ChannelReply reply_of(std::variant<std::uint32_t, dma::Fault> status) {
  if (auto* fault = std::get_if<dma::Fault>(&status)) return reply_of(std::move(*fault));
  return {std::get<std::uint32_t>(status), {}};
}

ChannelReply illegal(std::uint32_t channel, const char* access) {
  dma::Fault fault{dma::Rule::kIllegalChannel};
  fault.detail = std::string(access) + " of channel " + std::to_string(channel) +
                 ", which this SPE does not have for that";
  return reply_of(std::move(fault));
}

}  // namespace

ChannelReply MfcChannels::read(std::uint32_t channel) {
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcRdTagStat:
      return reply_of(mfc_.read_tag_status());
    case Channel::kMfcRdTagMask:
      return {mfc_.tag_mask(), {}};
    default:
      return illegal(channel, "read");
  }
}

ChannelReply MfcChannels::write(std::uint32_t channel, std::uint32_t value) {
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcLsa:
      parameters_.lsa.value = value;
      return {};
    case Channel::kMfcEah:
      parameters_.ea.value = (std::uint64_t{value} << 32) | (parameters_.ea.value & 0xFFFFFFFFu);
      return {};
    case Channel::kMfcEal:
      parameters_.ea.value = (parameters_.ea.value & ~std::uint64_t{0xFFFFFFFFu}) | value;
      return {};
    case Channel::kMfcSize:
      parameters_.size = value;
      return {};
    case Channel::kMfcTagId:
      parameters_.tag = value;
      return {};
    case Channel::kMfcCmd:
      parameters_.word = value;
      return issue(parameters_);
    case Channel::kMfcWrTagMask:
      mfc_.write_tag_mask(value);
      return {};
    case Channel::kMfcWrTagUpdate:
      return reply_of(mfc_.write_tag_update(value));
    default:
      return illegal(channel, "write");
  }
}

ChannelReply MfcChannels::count(std::uint32_t channel) {
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcCmd:
      return {static_cast<std::uint32_t>(mfc_.free_slots()), {}};
    case Channel::kMfcRdTagStat:
      return {static_cast<std::uint32_t>(mfc_.tag_status_count()), {}};
    case Channel::kMfcRdTagMask:
    case Channel::kMfcLsa:
    case Channel::kMfcEah:
    case Channel::kMfcEal:
    case Channel::kMfcSize:
    case Channel::kMfcTagId:
    case Channel::kMfcWrTagMask:
    case Channel::kMfcWrTagUpdate:
      return {1, {}};
    default:
      return illegal(channel, "count");
  }
}

ChannelReply MfcChannels::issue(const dma::MfcCommand& command) { return reply_of(mfc_.issue(command)); }

}  // namespace softcell::ls_sim
