#pragma once
// What a renderer draws into: the picture and the shadow map.

#include <memory>
#include <string>

#include "gl_objects.h"
#include "post_process.h"
#include "softcell/render/image.h"

namespace softcell::render {

/// How RenderTargets are made.
struct RenderTargetSettings {
  int width = 0, height = 0;  ///< of the picture, pixels
  int shadow_map_size = 0;    ///< texels a side
  int samples = 1;            ///< a pixel; limited to what the context supports
  int occlusion_pixels = 2;   ///< as PostProcessSettings
  GLuint frame_binding = 0;   ///< likewise
};

/// Used with its context current. A function that throws leaves all as it was.
class RenderTargets {
 public:
  /// `gl` must outlive it. @param backend  the name of the context
  /// @throws std::runtime_error  the context does not support the sizes, or has no memory for them
  RenderTargets(const GladGLContext& gl, const std::string& backend, const RenderTargetSettings& settings);

  /// Makes another picture. What was drawn is gone.
  /// @throws std::runtime_error  no memory for a picture of this size
  void resize(int width, int height);
  /// @throws std::runtime_error  a picture or shadow map cannot have so many pixels a side
  void require_drawable(int side) const;

  int width() const { return settings_.width; }
  int height() const { return settings_.height; }
  int shadow_map_size() const { return settings_.shadow_map_size; }
  int samples() const { return settings_.samples; }
  /// What Renderer::description() returns.
  const std::string& description() const { return description_; }
  int largest_side() const { return largest_side_; }  ///< of a picture or texture, pixels

  PostProcess& frame() const { return *picture_buffers_.frame; }
  GLuint shadow_framebuffer() const { return shadow_framebuffer_.name(); }
  GLuint shadow_map() const { return shadow_map_.name(); }
  /// The finished picture under an overlay.
  GLuint shown_framebuffer() const { return picture_buffers_.shown_framebuffer.name(); }
  /// Copies a finished picture there.
  void show(GLuint framebuffer) const;
  /// Reads back what is shown. @return valid until the next call
  const Image& pixels();

 private:
  void make_shadow_map();

  /// What a picture is drawn in, and what is shown.
  struct PictureBuffers {
    std::unique_ptr<PostProcess> frame;
    GlObject shown_framebuffer, shown_colour;
  };

  const GladGLContext& gl_;
  RenderTargetSettings settings_;
  int largest_side_ = 0;
  std::string description_;
  PictureBuffers picture_buffers_;
  GlObject shadow_framebuffer_, shadow_map_;
  Image picture_;  // that pixels() returns
};

}  // namespace softcell::render
