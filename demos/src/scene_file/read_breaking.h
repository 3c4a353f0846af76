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
      throw SceneError(of_slab.place("normal"), "normal of " + of_slab.what() + " must not be 0");
  }
}

/// Reads a table `cut` of a scene: a plane, line or stroke that cuts a body. The soft bodies must have been read.
inline void read_cut(FieldReader& fields, const Place& place, ppu::Cut& where) {
  Eigen::Vector3f point{0, 0, 0}, normal{1, 0, 0}, edge{0, 0, 0}, way{0, 0, 0};
  fields.vector<3>("point", point, kCoordinate, Need::kRequired)
      .vector<3>("normal", normal, kCoordinate)
      .vector<3>("edge", edge, kCoordinate)
      .vector<3>("way", way, kCoordinate)
      .finish();
  if (fields.has("edge") != fields.has("way") || fields.has("edge") == fields.has("normal"))
    throw SceneError(place, fields.what() + " needs a normal, or an edge and a way");
  const bool plane = fields.has("normal");
  if ((plane ? normal.norm() : edge.cross(way).norm()) < 1e-6f)
    throw SceneError(place, plane ? "normal of " + fields.what() + " must not be 0"
                                  : fields.what() + " has no area: its edge and way are along one line");
  where = plane ? ppu::Cut::plane(point, normal) : ppu::Cut::stroke(point, edge, way);
}
inline void read_cut(FieldReader& fields, const Place& place, ppu::Cut2d& where) {
  Eigen::Vector2f point{0, 0}, normal{1, 0}, way{0, 0};
  fields.vector<2>("point", point, kCoordinate, Need::kRequired)
      .vector<2>("normal", normal, kCoordinate)
      .vector<2>("way", way, kCoordinate)
      .finish();
  if (fields.has("way") == fields.has("normal"))
    throw SceneError(place, fields.what() + " needs a normal, or a way");
  const bool line = fields.has("normal");
  if ((line ? normal.norm() : way.norm()) < 1e-6f)
    throw SceneError(place, (line ? "normal of " : "way of ") + fields.what() + " must not be 0");
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
    read_cut(fields, items[i].place, cut.where);
  }
}

}  // namespace softcell::demos
