#include "read_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "ppu/matching/regions.h"
#include "ppu/matching/stiffness.h"
#include "ppu/numbers/deterministic_math.h"
#include "read_common.h"
#include "softcell/base/nearest_name.h"

namespace softcell::demos {
namespace {

// Lower limits: with smaller cells, or with a density far below that of air, masses and inertias would soon be too small for floats.
constexpr Range kCellSize{.low = kLeastCellSize, .high = kFar};
constexpr Range kDensity{.low = 0.001, .high = 1e6};
constexpr Range kFriction{.low = 0, .high = 100};
constexpr Range kFrequency{.low = 0, .high = 1e6};
constexpr Range kModulus{.low = 0, .high = 1e9, .low_excluded = true};
constexpr Range kDampingTime{.low = 0, .high = 1e6};
constexpr Range kYield{.low = 0, .high = 1, .low_excluded = true};
constexpr Range kCreep{.low = 0, .high = 1e6, .low_excluded = true};
constexpr Range kStretch{.low = 0, .high = 10, .low_excluded = true};
constexpr Range kBreakingTurn{.low = 0, .high = 180, .low_excluded = true};  // degrees
constexpr int kMostLeastCells = 1'000'000;                                   // more than any scene has
constexpr Range kPlasticLimit{.low = 0, .high = 10, .low_excluded = true};

/// Checks that at most one of the names is given. @return whether one is
bool one_of(const FieldReader& fields, std::initializer_list<std::string_view> names) {
  std::string_view first;
  for (const std::string_view name : names) {
    if (!fields.has(name)) continue;
    if (!first.empty()) {
      throw SceneError(fields.location(name),
                       fmt::format("{} has both {} and {}; give one", fields.what(), first, name));
    }
    first = name;
  }
  return !first.empty();
}

/// @param cell_size  whether the fields must include it
void read_fields(FieldReader& fields, Material& material, Need cell_size) {
  ppu::SoftBodySettings& s = material.settings;
  // A stated field replaces what the material before stated in another way.
  if (one_of(fields, {"alpha", "frequency", "modulus"})) s.frequency.reset(), material.modulus.reset();
  if (one_of(fields, {"damping", "damping_time"})) s.damping_time.reset();
  fields.number("cell_size", s.cell_size, kCellSize, cell_size)
      .integer("half_width", s.half_width, 0, ppu::kMaxHalfWidth)
      .number("density", s.density, kDensity)
      .number("alpha", s.alpha, kShare)
      .number("frequency", s.frequency, kFrequency)
      .number("modulus", material.modulus, kModulus)
      .number("damping", s.damping, kShare)
      .number("damping_time", s.damping_time, kDampingTime)
      .number("friction", s.friction, kFriction)
      .number("restitution", s.restitution, kShare)
      .flag("self_contacts", s.self_contacts);
  if (const Value* const value = fields.field("plasticity")) {
    ppu::Plasticity plasticity;
    FieldReader of_plasticity(*value, "the plasticity of " + fields.what());
    of_plasticity.number("yield", plasticity.yield, kYield)
        .number("creep", plasticity.creep, kCreep)
        .number("limit", plasticity.limit, kPlasticLimit)
        .finish();
    s.plasticity = plasticity;
  }
  if (const Value* const value = fields.field("fracture")) {
    ppu::Fracture fracture;
    std::optional<float> degrees;
    auto least_cells = static_cast<int>(fracture.least_cells);
    FieldReader of_fracture(*value, "the fracture of " + fields.what());
    of_fracture.number("stretch", fracture.stretch, kStretch)
        .number("turn", degrees, kBreakingTurn)
        .integer("least_cells", least_cells, 1, kMostLeastCells)
        .finish();
    if (degrees) fracture.turn = *degrees * (static_cast<float>(ppu::kPi) / 180);
    fracture.least_cells = static_cast<std::uint32_t>(least_cells);
    s.fracture = fracture;
  }
}

}  // namespace

ppu::SoftBodySettings Material::settings_for(double step) const {
  ppu::SoftBodySettings result = settings;
  if (modulus) {
    const double stiffest = ppu::specific_modulus(double{settings.cell_size}, step, 1, settings.half_width);
    result.alpha = stiffest > 0 ? static_cast<float>(std::min(1.0, double{*modulus} / stiffest)) : 1;
  }
  return result;
}

Materials::Materials(const Value* table) {
  if (table == nullptr) return;
  for (const auto& [name, value] : as_table(*table, "materials")) {
    FieldReader fields(value, "material '" + name + "'");
    read_fields(fields, by_name_[name], Need::kOptional);
    fields.finish();
  }
}

Material Materials::read(FieldReader& body, Need cell_size) const {
  Material material;
  std::string name;
  body.text("material", name);
  if (body.has("material")) {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) {
      std::vector<std::string_view> known;
      for (const auto& [known_name, ignored] : by_name_) known.push_back(known_name);
      const std::string_view meant = base::nearest_name(name, known);
      throw SceneError(body.location("material"),
                       fmt::format("there is no material '{}'{}", name,
                                   meant.empty() ? "" : fmt::format("; did you mean '{}'?", meant)));
    }
    material = found->second;
  }
  read_fields(body, material, material.settings.cell_size > 0 ? Need::kOptional : cell_size);
  return material;
}

}  // namespace softcell::demos
