#pragma once

#include <map>
#include <optional>
#include <string>

#include "document/field_reader.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// The material of a soft body, before its cell size and the length of a substep determine the numbers per step.
struct Material {
  ppu::SoftBodySettings settings;
  std::optional<float> modulus;  ///< m^2/s^2, instead of alpha or frequency

  /// @param step  seconds per substep
  ppu::SoftBodySettings settings_for(double step) const;
};

/// The materials of a scene by name.
class Materials {
 public:
  /// @param table  the scene's `materials`; null: there are none. @throws SceneError
  explicit Materials(const Value* table);

  /// A soft body's material: the one that it names, with the fields that the body itself states on top.
  /// @param cell_size  whether the body or its material must state one; if it is missing, the body's finish() reports it
  /// @throws SceneError
  Material read(FieldReader& body, Need cell_size) const;

 private:
  std::map<std::string, Material, std::less<>> by_name_;
};

}  // namespace softcell::demos
