#pragma once

#include "field_reader.h"
#include "scene/scene_2d.h"
#include "scene_source.h"

namespace softcell::demos {

/// A 2D scene from a file's root. @throws SceneError
Scene2d read_scene_2d(FieldReader& root, const SceneSource& source);

}  // namespace softcell::demos
