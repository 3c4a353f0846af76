#pragma once
// Reads the items of `attach`, in two dimensions and three.

#include <fmt/ranges.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "document/field_reader.h"
#include "read_common.h"
#include "scene/attachment_placement.h"

namespace softcell::demos {

/// Refuses a field that has no meaning for this kind of attachment. @throws SceneError
inline void refuse_field_of_others(const FieldReader& fields, ppu::AttachmentKind kind) {
  const bool rope = kind == ppu::AttachmentKind::kRope, hinge = kind == ppu::AttachmentKind::kHinge;
  const auto refuse_unless = [&](bool allowed, const char* name, std::string_view owners) {
    if (allowed || !fields.has(name)) return;
    throw SceneError(fields.location(name),
                     fmt::format("{} is a {} and has the field '{}'; only {} have it", fields.what(),
                                 kAttachmentKinds.at(static_cast<std::size_t>(kind)), name, owners));
  };
  refuse_unless(hinge, "axis", "hinges");
  refuse_unless(hinge || rope, "point", "hinges and ropes");
  for (const char* const name : {"thickness", "colour"}) refuse_unless(rope, name, "ropes");
}

/// Reads all fields except those that name the rigid body, which the caller has read.
/// @throws SceneError
template <int kDimension, class SceneOf>
void read_attachment(FieldReader& fields, const SceneOf& scene, AttachmentPlacement<kDimension>& attachment) {
  constexpr Range kCompliance{.low = 0, .high = 1e6};
  constexpr Range kForce{.low = 0, .high = 1e12, .low_excluded = true};
  ppu::AttachmentSettings<kDimension>& settings = attachment.settings;
  attachment.body = read_body(fields, scene);
  std::string other;
  std::size_t kind = 0;
  Eigen::Vector<float, kDimension> point = Eigen::Vector<float, kDimension>::Zero();
  bool touch = false;
  fields.text("to", other)
      .choice("kind", kind, kAttachmentKinds)
      .template vector<kDimension>("at", attachment.at, kCoordinate, Need::kRequired)
      .number("radius", attachment.radius, kLength, Need::kRequired);
  attachment.other_at = attachment.at;
  attachment.other_radius = attachment.radius;
  if constexpr (kDimension == 3) fields.template vector<3>("axis", settings.axis, kCoordinate);
  fields.template vector<kDimension>("other_at", attachment.other_at, kCoordinate)
      .number("other_radius", attachment.other_radius, kLength)
      .template vector<kDimension>("point", point, kCoordinate)
      .number("length", settings.length, kLength)
      .number("compliance", settings.compliance, kCompliance)
      .number("break_force", settings.break_force, kForce)
      .flag("touch", touch)
      .number("thickness", attachment.thickness, kLength)
      .colour("colour", attachment.colour)
      .finish();
  settings.kind = static_cast<ppu::AttachmentKind>(kind);
  refuse_field_of_others(fields, settings.kind);
  if (fields.has("point")) settings.point = point;
  if (fields.has("touch")) settings.touch = touch;
  std::vector<std::string_view> given;
  for (const char* const name : {"to", "box", "rigid"})
    if (fields.has(name)) given.emplace_back(name);
  if (given.size() > 1) {
    throw SceneError(fields.location(),
                     fmt::format("{} has {}; give only one of to{} rigid", fields.what(),
                                 fmt::join(given, " and "), kDimension == 3 ? ", box and" : " and"));
  }
  if (fields.has("to")) attachment.other = find_body(other, fields.location("to"), scene);
  if (attachment.other == attachment.body)
    throw SceneError(fields.location("to"), fields.what() + " attaches '" + other + "' to itself");
  try {
    ppu::validate(settings);
  } catch (const std::invalid_argument& error) {
    throw SceneError(fields.location(), fields.what() + ": " + error.what());
  }
  if (settings.kind == ppu::AttachmentKind::kRope && !settings.point && !attachment.box &&
      !attachment.rigid && !attachment.other)
    throw SceneError(fields.location(),
                     fields.what() + " is a rope to the world; it needs the point of its other end");
}

}  // namespace softcell::demos
