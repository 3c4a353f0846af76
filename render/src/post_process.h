#pragma once
// From the samples that were drawn to a picture: ambient occlusion, resolved samples, smooth edges.

#include <memory>

#include "gl_objects.h"
#include "softcell/render/frame.h"

namespace softcell::render {

/// How a PostProcess is made.
struct PostProcessSettings {
  int width = 0, height = 0;  ///< of the picture, pixels, above 0
  int samples = 1;            ///< a pixel, 1 or more; with 1, edges are smoothed
  int occlusion_pixels = 2;   ///< a texel of ambient occlusion has so many pixels a side; 0: there is none
  GLuint frame_binding = 0;   ///< of the uniform block Frame
};

/// Owns what a frame in three dimensions is drawn into, and the picture that is made of it. Used with its context current.
class PostProcess {
 public:
  /// `gl` must outlive it. @throws std::runtime_error  no memory for a picture of this size
  PostProcess(const GladGLContext& gl, const PostProcessSettings& settings);
  ~PostProcess();
  PostProcess(const PostProcess&) = delete;
  PostProcess& operator=(const PostProcess&) = delete;

  /// The framebuffer to draw into: a colour and a depth for each sample.
  GLuint drawn() const;
  /// The finished picture, one sample a pixel.
  GLuint picture() const;

  /// Makes `part` of the picture anew from what was drawn, and its surroundings as far as occlusion reaches. Changes the bound
  /// framebuffer, program, vertex array and textures, the viewport and the scissor.
  /// @pre part is within the picture; nothing outside of it was drawn differently since the last call
  void run(const PixelRect& part, bool with_occlusion);

  /// Pixels from which a point of a picture is occluded, at most: occlusion.z of shaders.h. @param height  of the picture
  static float max_reach(int height) { return 0.1f * static_cast<float>(height); }

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::render
