#pragma once

#include <map>
#include <optional>
#include <string>

#include "document/field_reader.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// What a soft body is made of, before its cell size and the length of a substep decide on numbers per step.
struct Material {
  ppu::SoftBodySettings settings;
  std::optional<float> modulus;  ///< m^2/s^2, in place of alpha or frequency

  /// @param step  seconds of a substep
  ppu::SoftBodySettings settings_for(double step) const;
};

/// The materials of a scene by name.
class Materials {
 public:
  /// @param table  the scene's `materials`; null: none. @throws SceneError
  explicit Materials(const Value* table);

  /// A soft body's material: the one it names, and over it the fields that it states itself.
  /// @param cell_size  whether one must be stated in either: where not, the body's finish() says so
  /// @throws SceneError
  Material read(FieldReader& body, Need cell_size) const;

 private:
  std::map<std::string, Material, std::less<>> by_name_;
};

}  // namespace softcell::demos
