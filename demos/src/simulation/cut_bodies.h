#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/breaking.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// Cuts bodies of a world, the pieces that they have broken into included. New pieces appear some substeps later or, if `at_once`, at once,
/// after all other bodies.
/// @param sources     for each body the scene's body that it is, or is a piece of
/// @param source      the scene's body that is cut with its pieces; none: all bodies are cut
/// @tparam SoftBodies BulletSoftBodies or Box2dSoftBodies   @tparam Where  its Cut or Cut2d
template <class SoftBodies, class Where>
void cut_bodies(SoftBodies& bodies, std::span<const std::size_t> sources, std::optional<std::size_t> source,
                bool at_once, const Where& where) {
  SC_ASSERT(sources.size() == bodies.size(), "the sources of {} soft bodies of {}", sources.size(),
            bodies.size());
  for (std::size_t b = 0; b < sources.size(); ++b) {
    if (source && sources[b] != *source) continue;
    if (at_once)
      bodies.cut(bodies[b], where);
    else
      bodies.begin_cut(bodies[b], where);
  }
}

/// Makes the cuts that a scene plans for the beginning of a frame. @param cut  takes a cut and the number of the scene's body
template <int Dimension, class Cut>
void cut_as_planned(const std::vector<ScriptedCut<Dimension>>& cuts, std::int64_t at_frame, const Cut& cut) {
  for (const ScriptedCut<Dimension>& planned : cuts)
    if (std::llround(double{planned.time} * 60) == at_frame) cut(planned.where, planned.body);
}

}  // namespace softcell::demos
