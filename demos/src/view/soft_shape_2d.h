#pragma once
// Draws a soft body in two dimensions: its skin in the colours of its cells or with its picture, outlines, and its face.

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/scene_2d.h"
#include "softcell/render/renderer.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body_model.h"
#include "sticker.h"

namespace softcell::demos {

/// The colour of the lines around an area of this colour.
inline render::Colour ink_of(const render::Colour& colour) { return 0.22f * colour; }

/// The elements of a picture. What it refers to belongs to the bodies.
struct Drawing2d {
  std::vector<render::Line2d> lines_below;
  std::vector<render::Shape2d> shapes;
  std::vector<render::Links2d> links;
  std::vector<render::Line2d> lines;
  std::vector<render::Dots2d> dots;

  void clear();
};

/// The stickers of a scene: bodies with the same picture and the same border share one.
class Stickers {
 public:
  struct Entry {
    Sticker sticker;
    render::TextureId texture;
  };
  /// @param border  in pixels of the picture  @return  valid as long as this object
  const Entry& get(const std::shared_ptr<const render::Image>& picture, float border,
                   render::Renderer& renderer);

 private:
  std::map<std::pair<std::shared_ptr<const render::Image>, float>, Entry> made_;
};

/// The skins of a scene's bodies before they break; pieces show parts of these. Each is made once.
class WholeSkins {
 public:
  /// @param make  makes the body's skins  @return  valid as long as this object
  template <class Make>
  const std::vector<ppu::Skin2d>& get(const SoftBody2dPlacement& body, const Make& make) {
    const auto known = made_.find(&body);
    return known != made_.end() ? known->second : made_.emplace(&body, make()).first->second;
  }

 private:
  std::map<const SoftBody2dPlacement*, std::vector<ppu::Skin2d>> made_;
};

/// The shape of a body or of a piece of it. Used by one thread, with the renderer that it was made with.
class SoftShape2d {
 public:
  using Box = Eigen::AlignedBox2f;

  /// @param body, model  must outlive this object
  SoftShape2d(const SoftBody2dPlacement& body, const ppu::SoftBodyModel<2>& model, render::Renderer& renderer,
              Stickers& stickers, WholeSkins& wholes);
  /// Frees its resources in the renderer. Do not draw it afterwards.
  void remove_from(render::Renderer& renderer) const;

  /// Deforms it to fit its particles.
  void deform(std::span<const Eigen::Vector2f> particles);

  /// Adds it to a drawing as of the last deform().
  /// @param line_width  metres  @param opacity  of the body, 0..1; a pale body has no face
  void draw(Drawing2d& drawing, float line_width, float opacity) const;

  /// A box around everything that draw() draws, line widths aside.
  const Box& box() const { return box_; }

 private:
  struct Outline {
    std::vector<std::uint32_t> vertices;
    std::vector<Eigen::Vector2f> points;
    std::vector<Eigen::Vector2f> normals;  // empty for a piece, whose cuts have no slopes
  };
  /// A skin with its outlines: of the whole body, or of its cells of one colour.
  struct Layer {
    ppu::Skin2d skin;
    render::Shape2dId shape = {};
    render::Colour colour{0, 0, 0};
    bool is_part = false;
    std::vector<Outline> outlines;
    std::vector<Eigen::Vector2f> positions, slopes;
    std::vector<render::Vertex2d> vertices;
  };
  /// Dots of one size on the body.
  struct Spots {
    std::vector<ppu::CellPoint2d> places;
    std::vector<Eigen::Vector2f> aside;  ///< of each, metres: towards the light, however the body turns
    float radius;                        ///< metres
    render::Colour colour;
    float opacity = 1;
    std::vector<Eigen::Vector2f> centres = {};
  };
  struct Stroke {
    std::vector<ppu::CellPoint2d> places;
    std::vector<Eigen::Vector2f> points;
    float width;  ///< metres
    render::Colour colour;
  };

  template <class Make>
  std::vector<ppu::Skin2d> own_skins(WholeSkins& wholes, const Make& make) const;
  void add_skins(render::Renderer& renderer, WholeSkins& wholes);
  void add_picture(render::Renderer& renderer, Stickers& stickers, WholeSkins& wholes);
  Layer& add_layer(ppu::Skin2d skin);
  bool has_face() const;
  void add_face(const Face2d& face);

  const SoftBody2dPlacement& body_;
  const ppu::SoftBodyModel<2>& model_;
  std::vector<Layer> layers_;  // the lowest first: the whole body, then its parts
  bool is_coloured_ = false;   // it has parts with their own colours
  std::optional<render::TextureId> texture_;
  std::vector<Spots> spots_;
  std::vector<Stroke> strokes_;
  Box box_;
};

}  // namespace softcell::demos
