#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/attachment_placement.h"
#include "shown.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::demos {

/// Appends the ropes of a scene that have not broken.
/// @param placements   of the scene   @param attachments  made from them, in their order
/// @tparam SoftBodies  BulletSoftBodies or Box2dSoftBodies
template <int Dimension, class SoftBodies>
void append_ropes(std::span<const AttachmentPlacement<Dimension>> placements,
                  std::span<const ppu::AttachmentId> attachments, const SoftBodies& bodies,
                  std::vector<ShownRope<Dimension>>& ropes) {
  SC_ASSERT(placements.size() == attachments.size(), "{} attachments of {}", attachments.size(),
            placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i) {
    if (placements[i].settings.kind != ppu::AttachmentKind::kRope) continue;
    if (const auto ends = bodies.attachment_ends(attachments[i]))
      ropes.push_back({.ends = {ends->patch, ends->other},
                       .length = ends->length,
                       .thickness = placements[i].thickness,
                       .colour = placements[i].colour});
  }
}

}  // namespace softcell::demos
