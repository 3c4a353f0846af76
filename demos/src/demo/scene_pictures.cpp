#include "scene_pictures.h"

#include <algorithm>
#include <span>

#include "softcell/base/assert.h"
#include "softcell/base/embedded_file.h"
#include "softcell/render/png_io.h"

namespace softcell::demos {

std::span<const base::EmbeddedFile> embedded_scene_pictures();

ScenePictures::ScenePictures() {
  const std::span<const base::EmbeddedFile> files = embedded_scene_pictures();
  sheet_ = render::Image(kWidth, kHeight * static_cast<int>(files.size()));
  int row = 0;
  for (const base::EmbeddedFile& file : files) {
    const render::Image picture =
        render::decode_picture(std::as_bytes(std::span(file.text)), std::string(file.name));
    SC_ASSERT(picture.width == kWidth && picture.height == kHeight, "{} has {} by {} pixels", file.name,
              picture.width, picture.height);
    std::ranges::copy(picture.rgba, sheet_.pixel(0, kHeight * row));
    row_.emplace(file.name.substr(0, file.name.rfind('.')), row++);
  }
}

std::optional<std::array<float, 4>> ScenePictures::rectangle(std::string_view scene) const {
  const auto found = row_.find(scene);
  if (found == row_.end()) return std::nullopt;
  const float share = 1 / static_cast<float>(row_.size()), top = share * static_cast<float>(found->second);
  // Half a pixel inside, so that colours of the neighbouring picture are not mixed in.
  const float inset = 0.5f / static_cast<float>(sheet_.height);
  return std::array{0.0f, top + inset, 1.0f, top + share - inset};
}

}  // namespace softcell::demos
