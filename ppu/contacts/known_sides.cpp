#include "ppu/contacts/known_sides.h"

#include <algorithm>

namespace softcell::ppu {

void KnownSides::begin_substep() {
  const auto keep_near = [](auto& list) {
    std::erase_if(list, [](const auto& known) { return !known.is_near; });
    for (auto& known : list) known.is_near = false;
  };
  keep_near(sides_);
  keep_near(tracks_);
  if (!is_new_) origin_.reset();
  is_new_ = false;
}

float KnownSides::last_side_of(std::uint32_t rigid, std::uint32_t part) const {
  const auto known = std::ranges::find_if(sides_, of(rigid, part));
  return known != sides_.end() && known->side < 0 ? -1.0f : 1.0f;
}

float KnownSides::side_of(std::uint32_t rigid, std::uint32_t part, int seen) {
  constexpr int kMostDoubts = 12;
  auto known = std::ranges::find_if(sides_, of(rigid, part));
  if (known == sides_.end()) known = sides_.insert(known, Side{rigid, part, true, 0, 0});
  known->is_near = true;
  const int side = seen > 0 ? 1 : seen < 0 ? -1 : 0;
  if (side * known->side < 0)
    ++known->doubts;
  else if (side != 0)
    known->doubts = 0;
  if (side != 0 && (known->side == 0 || known->doubts > kMostDoubts)) known->side = side, known->doubts = 0;
  return known->side < 0 ? -1.0f : 1.0f;
}

auto KnownSides::track(std::uint32_t rigid, std::uint32_t part) const -> std::optional<Track> {
  const auto known = std::ranges::find_if(tracks_, of(rigid, part));
  return known != tracks_.end() ? std::optional(known->track) : std::nullopt;
}

void KnownSides::set_track(std::uint32_t rigid, std::uint32_t part, const Track& track) {
  const auto known = std::ranges::find_if(tracks_, of(rigid, part));
  if (known == tracks_.end())
    tracks_.push_back({rigid, part, true, track});
  else
    known->is_near = true, known->track = track;
}

void KnownSides::begin_piece(const Eigen::Vector3f& origin) {
  origin_ = origin;
  is_new_ = true;
}

}  // namespace softcell::ppu
