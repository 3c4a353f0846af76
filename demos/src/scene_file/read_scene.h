#pragma once
// Scenes from the roots of their files.

#include <optional>

#include "document/field_reader.h"
#include "scene/scene.h"
#include "scene/scene_2d.h"
#include "scene_library.h"
#include "scene_source.h"

namespace softcell::demos {

/// A 3D scene. @param model  takes the place of the body that states `own_model_side`.
/// @throws SceneError  @throws NoPlaceForModel
Scene read_scene_3d(FieldReader& root, const SceneSource& source, const std::optional<OwnModel>& model);

/// A 2D scene. @param picture  takes the place of the body that states `own_image_side`.
/// @throws SceneError  @throws NoPlaceForModel
Scene2d read_scene_2d(FieldReader& root, const SceneSource& source, const std::optional<OwnPicture>& picture);

/// One more soft body, behind those that the scene has. @throws SceneError  the scene is of no use then
void read_another_body(const Value& item, const SceneSource& source, Scene& scene);
void read_another_body(const Value& item, const SceneSource& source, Scene2d& scene);

}  // namespace softcell::demos
