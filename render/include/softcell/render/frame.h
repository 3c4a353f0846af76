#pragma once
// One frame as plain data: the objects to draw, the camera, and the light. Metres, y up. Spans must live until render() returns.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "softcell/render/camera.h"
#include "softcell/render/colour.h"
#include "softcell/render/material.h"

namespace softcell::render {

/// Handle to a mesh of one Renderer whose vertices change.
struct MeshId {
  std::uint32_t value = 0;
  std::uint32_t generation = 0;  ///< 0: the handle names nothing
};
/// Handle to a mesh of one Renderer that does not change.
struct StaticMeshId {
  std::uint32_t value = 0;
  std::uint32_t generation = 0;  ///< 0: the handle names nothing
};

enum class Pattern : std::uint8_t {
  kPlain,
  kTiles,  ///< squares of 1 m in two shades on the mesh's own xz plane, with fine lines between them
};

/// A skinned mesh at its current vertices.
struct SkinnedDraw {
  MeshId mesh = {};
  Eigen::Vector3f origin{0, 0, 0};  ///< added to every vertex
  Colour colour{0.8f, 0.8f, 0.8f};
  float opacity = 1;       ///< 0..1; below 1 the mesh is blended over what is behind it and casts no shadow
  bool two_sided = false;  ///< draw inner sides, too, for meshes with holes; takes about 1.6 times as long
  /// A box around the drawn mesh, metres. None: all its triangles are drawn, however small.
  std::optional<Eigen::AlignedBox3f> box = {};
  std::optional<TextureId> texture = {};  ///< its colours are multiplied with `colour`; none: `colour` alone
  /// Parts with their own materials, instead of `colour` and `texture`; triangles in no part are not drawn. None: the whole mesh has one
  /// colour.
  std::span<const PartDraw> parts = {};
};

/// A mesh that does not change, moved as a whole.
struct StaticDraw {
  StaticMeshId mesh = {};
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();  ///< affine, determinant above 0
  Colour colour{0.8f, 0.8f, 0.8f};
  float opacity = 1;  ///< 0..1; below 1 front sides are blended over what is behind them
  Pattern pattern = Pattern::kPlain;
  bool always_shadow = false;            ///< it casts a shadow also with an opacity below 1
  std::span<const PartDraw> parts = {};  ///< as in SkinnedDraw, instead of `colour` and `pattern`
};

/// A particle lattice: spheres and the links between them.
struct LatticeDraw {
  std::span<const Eigen::Vector3f> particles;
  std::span<const std::array<std::uint32_t, 2>> links;  ///< indices into `particles`
  float radius = 0.02f;                                 ///< of a sphere
  Colour colour{0.9f, 0.5f, 0.1f};
};

/// The sun and the sky. Together they light a surface that faces the sun with about 1, so that it shows its own colour. Only objects in the
/// shadow sphere cast and receive shadows: keep it around the scene, and fixed, or shadow edges flicker.
struct Light {
  Eigen::Vector3f toward{-0.5f, 0.8f, 0.3f};  ///< direction from the scene to the light; any length but 0
  Colour colour{0.86f, 0.80f, 0.70f};
  Colour sky{0.36f, 0.41f, 0.48f};     ///< ambient light from above
  Colour ground{0.17f, 0.15f, 0.13f};  ///< ambient light from below
  Eigen::Vector3f shadow_centre{0, 0, 0};
  float shadow_radius = 10;  ///< above 0
  /// 0 or above: how strongly surfaces within 6 % of the shadow radius keep light off each other. 0: not at all.
  float occlusion = 1;
};

/// Pixels, counted from the upper left corner of the picture; `right` and `bottom` are the first outside.
struct PixelRect {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Everything that one picture shows. Data that the spans refer to must live until render() returns.
struct FrameDescription {
  Camera camera = {};
  Light light = {};
  std::span<const SkinnedDraw> skinned = {};
  std::span<const StaticDraw> statics = {};
  std::span<const LatticeDraw> lattices = {};
  Colour background_top = srgb(0x5B7FA6);     ///< of the sky far above the horizon
  Colour background_bottom = srgb(0xDCE6EE);  ///< of the haze on the horizon; `camera.up` is upwards
  /// The caller states that outside of this rectangle the picture, shadows included, is the same as in the
  /// renderer's last frame, so that only the rectangle must be drawn. Pixels at its edge may be drawn or not.
  /// None: everything may differ.
  std::optional<PixelRect> changes = {};
};

}  // namespace softcell::render
