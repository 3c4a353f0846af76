#pragma once
// Reads scenes from the root tables of their files.

#include <optional>

#include "document/field_reader.h"
#include "scene/scene.h"
#include "scene/scene_2d.h"
#include "scene_library.h"
#include "scene_source.h"

namespace softcell::demos {

/// Reads a 3D scene. @param model  replaces the body that states `own_model_side`.
/// @throws SceneError  @throws NoPlaceForModel
Scene read_scene_3d(FieldReader& root, const SceneSource& source, const std::optional<OwnModel>& model);

/// Reads a 2D scene. @param picture  replaces the body that states `own_image_side`.
/// @throws SceneError  @throws NoPlaceForModel
Scene2d read_scene_2d(FieldReader& root, const SceneSource& source, const std::optional<OwnPicture>& picture);

/// Adds one more soft body after those that the scene has. @throws SceneError  the scene must not be used after that
void read_another_body(const Value& item, const SceneSource& source, Scene& scene);
void read_another_body(const Value& item, const SceneSource& source, Scene2d& scene);

}  // namespace softcell::demos
