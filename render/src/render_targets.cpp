#include "render_targets.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace softcell::render {

RenderTargets::RenderTargets(const GladGLContext& gl, const std::string& backend,
                             const RenderTargetSettings& settings)
    : gl_(gl), settings_(settings) {
  const auto limit = [this](GLenum name) {
    GLint value = 0;
    gl_.GetIntegerv(name, &value);
    return value;
  };
  largest_side_ = std::min(limit(GL_MAX_RENDERBUFFER_SIZE), limit(GL_MAX_TEXTURE_SIZE));
  for (const int side : {settings_.width, settings_.height, settings_.shadow_map_size})
    require_drawable(side);
  const int most_samples = std::min(
      {limit(GL_MAX_SAMPLES), limit(GL_MAX_COLOR_TEXTURE_SAMPLES), limit(GL_MAX_DEPTH_TEXTURE_SAMPLES)});
  settings_.samples = std::clamp(settings_.samples, 1, std::max(most_samples, 1));
  description_ = backend + ", " + reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER)) + ", " +
                 std::to_string(settings_.samples) + " samples";
  resize(settings_.width, settings_.height);
  make_shadow_map();
}

void RenderTargets::require_drawable(int side) const {
  if (side >= 1 && side <= largest_side_) return;
  throw std::runtime_error("a picture or shadow map of " + std::to_string(side) +
                           " pixels a side cannot be drawn; 1 to " + std::to_string(largest_side_) + " can");
}

void RenderTargets::resize(int width, int height) {
  const auto refuse = [&](const std::string& what) {
    gl_.GetError();  // clears the error, which the context would keep
    throw std::runtime_error(description_ + ": " + what + " of " + std::to_string(width) + " by " +
                             std::to_string(height) + " pixels");
  };
  gl_.GetError();  // clears an error of earlier calls
  PictureBuffers made;
  try {
    made.frame =
        std::make_unique<PostProcess>(gl_, PostProcessSettings{.width = width,
                                                               .height = height,
                                                               .samples = settings_.samples,
                                                               .occlusion_pixels = settings_.occlusion_pixels,
                                                               .frame_binding = settings_.frame_binding});
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  made.shown_framebuffer = make_framebuffer(gl_);
  made.shown_colour = make_renderbuffer(gl_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, made.shown_colour.name());
  gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, made.shown_framebuffer.name());
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              made.shown_colour.name());
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) refuse("no framebuffer");
  if (gl_.GetError() != GL_NO_ERROR) refuse("no memory");

  picture_ = Image(width, height);
  picture_buffers_ = std::move(made);
  settings_.width = width;
  settings_.height = height;
}

void RenderTargets::make_shadow_map() {
  shadow_map_ = make_texture(gl_);
  gl_.BindTexture(GL_TEXTURE_2D, shadow_map_.name());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, settings_.shadow_map_size,
                 settings_.shadow_map_size, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  // Beyond the map the sun shines.
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const std::array<float, 4> far_away{1, 1, 1, 1};
  gl_.TexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, far_away.data());

  shadow_framebuffer_ = make_framebuffer(gl_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, shadow_framebuffer_.name());
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_map_.name(), 0);
  gl_.DrawBuffer(GL_NONE);
  gl_.ReadBuffer(GL_NONE);
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(description_ + ": no shadow map of " +
                             std::to_string(settings_.shadow_map_size) + " texels a side");
  }
}

void RenderTargets::show(GLuint framebuffer) const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, picture_buffers_.shown_framebuffer.name());
  gl_.BlitFramebuffer(0, 0, width(), height(), 0, 0, width(), height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

const Image& RenderTargets::pixels() {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, shown_framebuffer());
  gl_.ReadPixels(0, 0, width(), height(), GL_RGBA, GL_UNSIGNED_BYTE, picture_.rgba.data());
  // OpenGL counts rows from the bottom.
  const std::ptrdiff_t row_bytes = std::ptrdiff_t{4} * width();
  for (int y = 0; y < height() / 2; ++y) {
    std::uint8_t* const upper = picture_.pixel(0, y);
    std::swap_ranges(upper, upper + row_bytes, picture_.pixel(0, height() - 1 - y));
  }
  return picture_;
}

}  // namespace softcell::render
