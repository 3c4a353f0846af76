#pragma once
// Reads where bodies of a scene break more easily, and what cuts them.

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "read_common.h"
#include "scene/breaking.h"

namespace softcell::demos {

/// Reads the tables `strength` of a body: where it is weaker or stronger than its material.
template <int Dimension>
void read_strengths(FieldReader& fields, std::vector<StrengthSlab<Dimension>>& strengths) {
  constexpr std::size_t kMaxSlabs = 64;
  constexpr Range kStrength{.low = 0, .high = 1000};
  const auto slabs = fields.items("strength", kMaxSlabs);
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    StrengthSlab<Dimension>& slab = strengths.emplace_back();
    FieldReader of_slab(slabs[i], fmt::format("strength {} of {}", i + 1, fields.what()));
    of_slab.template vector<Dimension>("point", slab.point, kCoordinate)
        .template vector<Dimension>("normal", slab.normal, kCoordinate)
        .number("thickness", slab.thickness, kLength, Need::kRequired)
        .number("factor", slab.strength, kStrength, Need::kRequired)
        .finish();
    if (slab.normal.norm() < 1e-4f)
      throw SceneError(of_slab.location("normal"), "normal of " + of_slab.what() + " must not be 0");
  }
}

/// Reads a table `cut` of a scene: a plane, line or stroke that cuts a body. The soft bodies must have been read.
inline void read_cut(FieldReader& fields, ppu::Cut& where) {
  Eigen::Vector3f point{0, 0, 0}, normal{1, 0, 0}, edge{0, 0, 0}, way{0, 0, 0};
  fields.vector<3>("point", point, kCoordinate, Need::kRequired)
      .vector<3>("normal", normal, kCoordinate)
      .vector<3>("edge", edge, kCoordinate)
      .vector<3>("way", way, kCoordinate)
      .finish();
  const bool plane = fields.has("normal"), has_edge = fields.has("edge"), has_way = fields.has("way");
  if (!plane && !has_edge && !has_way)
    throw SceneError(fields.location(),
                     fields.what() + " needs either the field 'normal' or the fields 'edge' and 'way'");
  if (plane && (has_edge || has_way))
    throw SceneError(fields.location(has_edge ? "edge" : "way"),
                     fmt::format("{} has the field 'normal', so it may not have '{}'", fields.what(),
                                 has_edge ? "edge" : "way"));
  if (!plane && has_edge != has_way)
    throw SceneError(fields.location(),
                     fmt::format("{} has the field '{}', so it needs '{}', too", fields.what(),
                                 has_edge ? "edge" : "way", has_edge ? "way" : "edge"));
  if (plane && normal.norm() < 1e-6f)
    throw SceneError(fields.location("normal"), "normal of " + fields.what() + " must not be 0");
  if (!plane && edge.cross(way).norm() < 1e-6f)
    throw SceneError(fields.location(), fields.what() + " has no area: its edge and way are along one line");
  where = plane ? ppu::Cut::plane(point, normal) : ppu::Cut::stroke(point, edge, way);
}
inline void read_cut(FieldReader& fields, ppu::Cut2d& where) {
  Eigen::Vector2f point{0, 0}, normal{1, 0}, way{0, 0};
  fields.vector<2>("point", point, kCoordinate, Need::kRequired)
      .vector<2>("normal", normal, kCoordinate)
      .vector<2>("way", way, kCoordinate)
      .finish();
  const bool line = fields.has("normal"), has_way = fields.has("way");
  if (!line && !has_way)
    throw SceneError(fields.location(),
                     fields.what() + " needs either the field 'normal' or the field 'way'");
  if (line && has_way)
    throw SceneError(fields.location("way"),
                     fields.what() + " has the field 'normal', so it may not have 'way'");
  const char* const direction = line ? "normal" : "way";
  if ((line ? normal : way).norm() < 1e-6f)
    throw SceneError(fields.location(direction),
                     fmt::format("{} of {} must not be 0", direction, fields.what()));
  where = line ? ppu::Cut2d::line(point, normal) : ppu::Cut2d::stroke(point, way);
}

template <int Dimension, class SceneOf>
void read_cuts(std::span<const Value> items, SceneOf& scene) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    FieldReader fields(items[i], item_name("cut", i));
    ScriptedCut<Dimension>& cut = scene.cuts.emplace_back();
    cut.described = fields.described();
    cut.body = read_body(fields, scene);
    fields.number("time", cut.time, kTime, Need::kRequired);
    read_cut(fields, cut.where);
  }
}

}  // namespace softcell::demos
