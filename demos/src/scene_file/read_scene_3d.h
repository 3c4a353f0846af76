#pragma once

#include <optional>

#include "field_reader.h"
#include "scene/scene.h"
#include "scene_library.h"
#include "scene_source.h"

namespace softcell::demos {

/// A 3D scene from a file's root. @param model  takes the place of the body that states `own_model_side`.
/// @throws SceneError  @throws std::runtime_error  a model, and no place for it.
Scene read_scene_3d(FieldReader& root, const SceneSource& source, const std::optional<OwnModel>& model);

}  // namespace softcell::demos
