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

int KnownSides::known_side_of(std::uint32_t rigid, std::uint32_t part) const {
  const auto known = std::ranges::find_if(sides_, of_whole(rigid, part));
  return known == sides_.end() ? 0 : known->side;
}

float KnownSides::last_side_of(std::uint32_t rigid, std::uint32_t part) const {
  return known_side_of(rigid, part) < 0 ? -1.0f : 1.0f;
}

void KnownSides::Side::look(int seen) {
  constexpr int kMostDoubts = 12;
  is_near = true;
  const int seems = seen > 0 ? 1 : seen < 0 ? -1 : 0;
  if (seems * side < 0)
    ++doubts;
  else if (seems != 0)
    doubts = 0;
  if (seems != 0 && (side == 0 || doubts > kMostDoubts)) side = seems, doubts = 0;
}

float KnownSides::side_of(std::uint32_t rigid, std::uint32_t part, int seen) {
  auto known = std::ranges::find_if(sides_, of_whole(rigid, part));
  if (known == sides_.end()) known = sides_.insert(known, Side{rigid, part});
  known->look(seen);
  return known->side < 0 ? -1.0f : 1.0f;
}

float KnownSides::side_of_sheet(std::uint32_t rigid, std::uint32_t part, std::span<const Triangle> triangles,
                                const TriangleSheets& sheets, const SheetSeen& sheet) {
  const auto has_sheet = [&](const Side& side) {
    if (!of(rigid, part)(side) || !side.sheet) return false;
    const auto known = std::ranges::find(triangles, *side.sheet);
    return known != triangles.end() &&
           sheets.of(static_cast<std::size_t>(known - triangles.begin())) == sheet.sheet;
  };
  auto known = std::ranges::find_if(sides_, has_sheet);
  if (known == sides_.end()) known = sides_.insert(known, Side{rigid, part});
  known->sheet = triangles[sheet.nearest];
  known->look(sheet.seen);
  return known->side == 0 ? last_side_of(rigid, part) : static_cast<float>(known->side);
}

bool KnownSides::knows_sheets(std::uint32_t rigid, std::uint32_t part) const {
  return std::ranges::any_of(
      sides_, [&](const Side& side) { return of(rigid, part)(side) && side.sheet.has_value(); });
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
