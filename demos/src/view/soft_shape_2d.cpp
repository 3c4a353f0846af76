#include "soft_shape_2d.h"

#include <algorithm>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

// Lines between colours: factors on the colour's light and on the outline's width. Lines have smooth edges, which triangles do not have.
constexpr float kSeam = 0.6f, kSeamWidth = 0.7f;

/// For each cell 0 if it has the body's own colour; else 1 plus the number of the first of the coloured cells with the same colour as the
/// last one that contains the cell.
std::vector<std::uint32_t> colours_of(const SoftBody2dPlacement& body, const ppu::Lattice<2>& lattice) {
  // Rectangles of the same colour form one shape.
  const auto first_alike = [&](std::uint32_t i) {
    if (body.coloured_cells[i].colour == body.colour) return std::uint32_t{0};
    std::uint32_t first = 0;
    while (body.coloured_cells[first].colour != body.coloured_cells[i].colour) ++first;
    return first + 1;
  };
  std::vector<std::uint32_t> colours(lattice.cells.size());
  for (std::size_t c = 0; c < colours.size(); ++c) {
    const auto cell = lattice.cells[c].array();
    for (std::uint32_t i = 0; i < body.coloured_cells.size(); ++i) {
      const ColouredCells2d& cells = body.coloured_cells[i];
      if ((cell >= cells.low.array()).all() && (cell <= cells.high.array()).all())
        colours[c] = first_alike(i);
    }
  }
  return colours;
}

}  // namespace

void Drawing2d::clear() {
  lines_below.clear();
  shapes.clear();
  links.clear();
  lines.clear();
  dots.clear();
}

const Stickers::Entry& Stickers::get(const std::shared_ptr<const render::Image>& picture, float border,
                                     render::Renderer& renderer) {
  SC_ASSERT(picture != nullptr, "a sticker of no picture, with a border of {} pixels", border);
  const std::pair key(picture, border);
  if (const auto found = made_.find(key); found != made_.end()) return found->second;
  Sticker sticker = make_sticker(*picture, border);
  const render::TextureId texture = renderer.add_texture(sticker.image);
  return made_.emplace(key, Entry{std::move(sticker), texture}).first->second;
}

SoftShape2d::SoftShape2d(const SoftBody2dPlacement& body, const ppu::SoftBodyModel<2>& model,
                         render::Renderer& renderer, Stickers& stickers, WholeSkins& wholes)
    : body_(body), model_(model) {
  if (body.picture) {
    add_picture(renderer, stickers, wholes);
  } else {
    add_skins(renderer, wholes);
  }
  if (has_face()) add_face(*body.face);
}

void SoftShape2d::remove_from(render::Renderer& renderer) const {
  for (const Layer& layer : layers_) renderer.remove_shape(layer.shape);
}

/// @param make  makes the skins of a whole lattice
template <class Make>
std::vector<ppu::Skin2d> SoftShape2d::own_skins(WholeSkins& wholes, const Make& make) const {
  if (!model_.is_piece()) return make(model_.lattice());
  const ppu::Lattice<2>& whole = model_.whole()->lattice();
  std::vector<ppu::Skin2d> skins;
  for (const ppu::Skin2d& skin : wholes.get(body_, [&] { return make(whole); }))
    skins.push_back(ppu::skin_of_piece(skin, whole, model_.lattice()));
  return skins;
}

SoftShape2d::Layer& SoftShape2d::add_layer(ppu::Skin2d skin) {
  Layer& layer = layers_.emplace_back();
  layer.skin = std::move(skin);
  layer.positions.resize(layer.skin.rest.size());
  layer.slopes.resize(layer.skin.rest.size());
  layer.vertices.resize(layer.skin.rest.size());
  for (const auto& loop : layer.skin.outlines) {
    layer.outlines.push_back({.vertices = loop,
                              .points = std::vector<Vector2f>(loop.size()),
                              .normals = std::vector<Vector2f>(model_.is_piece() ? 0 : loop.size())});
  }
  return layer;
}

/// Adds the whole body in its own colour, and over it a layer for each colour, in the order in which the scene has them.
void SoftShape2d::add_skins(render::Renderer& renderer, WholeSkins& wholes) {
  std::vector<ppu::Skin2d> skins = own_skins(wholes, [&](const ppu::Lattice<2>& lattice) {
    std::vector<ppu::Skin2d> made;
    made.push_back(body_.skin(lattice));
    if (!body_.coloured_cells.empty()) {
      for (auto& part :
           ppu::make_skin_parts_2d(lattice, body_.skin_margin(), body_.outside(), colours_of(body_, lattice)))
        made.push_back(std::move(part));
    }
    return made;
  });
  for (std::size_t i = 0; i < skins.size(); ++i) {
    if (skins[i].triangles.empty()) continue;
    Layer& layer = add_layer(std::move(skins[i]));
    layer.shape = renderer.add_shape(layer.skin.triangles);
    layer.colour = i < 2 ? body_.colour : body_.coloured_cells[i - 2].colour;
    layer.is_part = i > 0;
    if (i < 2) continue;
    // Between colours an outline turns where the shape's edge does not, so its normals come from its own points.
    for (Outline& outline : layer.outlines) outline.normals.clear();
  }
  is_coloured_ = layers_.size() > 1;
}

/// Whether this piece has the face: of several pieces, the one with the cell in the middle of the face has it.
bool SoftShape2d::has_face() const {
  if (!body_.face || !model_.is_piece()) return body_.face.has_value();
  const auto& cells = model_.whole()->lattice().cells;
  const auto middle = std::ranges::find_if(cells, [&](const Vector2i& cell) {
    const Vector2f in = body_.face->centre - cell.cast<float>();
    return in.minCoeff() >= 0 && in.maxCoeff() <= 1;
  });
  return middle != cells.end() &&
         std::ranges::find(model_.lattice().cells, *middle) != model_.lattice().cells.end();
}

void SoftShape2d::add_picture(render::Renderer& renderer, Stickers& stickers, WholeSkins& wholes) {
  const Picture2d& picture = *body_.picture;
  const auto& [sticker, texture] =
      stickers.get(picture.image, body_.skin_margin() * picture.cell_pixels, renderer);
  // Where the sticker, which is larger than the picture, begins and how large it is, in grid coordinates.
  const Vector2f low =
      picture.low - Vector2f::Constant(static_cast<float>(sticker.border) /
                                       (picture.cell_pixels * static_cast<float>(sticker.scale)));
  const float cell = picture.cell_pixels * static_cast<float>(sticker.scale);
  const Vector2f size(static_cast<float>(sticker.image.width) / cell,
                      static_cast<float>(sticker.image.height) / cell);
  const auto has_something = [&, &sheet = sticker](const Vector2i& at) {
    return sheet.has_something((at.cast<float>() - low) * cell,
                               (at.cast<float>() + Vector2f::Ones() - low) * cell);
  };
  std::vector<ppu::Skin2d> skins = own_skins(wholes, [&](const ppu::Lattice<2>& lattice) {
    std::vector<ppu::Skin2d> made;
    made.push_back(ppu::make_cover_2d(lattice, has_something));
    return made;
  });
  Layer& layer = add_layer(std::move(skins.front()));
  for (std::size_t i = 0; i < layer.vertices.size(); ++i)
    layer.vertices[i].texture = (layer.skin.rest[i] - low).cwiseQuotient(size);
  layer.shape = renderer.add_shape(layer.skin.triangles);
  layer.colour = body_.colour;
  texture_ = texture;
}

void SoftShape2d::add_face(const Face2d& face) {
  const ppu::Lattice<2>& lattice = model_.lattice();
  const auto at = [&](float x, float y) {
    return ppu::point_in_cells(lattice, face.centre + face.size * Vector2f(x, y));
  };
  const float size = face.size * lattice.spacing;  // metres
  const render::Colour ink = render::srgb(0x1E2530), white = render::srgb(0xFFFFFF);
  const float eye = 0.215f, height = 0.10f;  // of the eyes; these and the next: fractions of the size
  const auto both = [&](float radius, const render::Colour& colour, const Vector2f& aside) {
    spots_.push_back({.places = {at(-eye, height), at(eye, height)},
                      .aside = {size * aside, size * aside},
                      .radius = radius * size,
                      .colour = colour});
  };
  const Vector2f light(-0.02f, 0.025f);
  spots_.push_back({.places = {at(-0.37f, -0.12f), at(0.37f, -0.12f)},
                    .aside = {Vector2f(0, 0), Vector2f(0, 0)},
                    .radius = 0.095f * size,
                    .colour = render::srgb(0xE8475A),
                    .opacity = 0.35f});
  both(0.150f, ink, {0, 0});
  both(0.125f, white, {0, 0});
  both(0.075f, ink, {0.015f, -0.005f});
  both(0.026f, white, light + Vector2f(0.015f, -0.005f));
  Stroke& mouth =
      strokes_.emplace_back(Stroke{.places = {}, .points = {}, .width = 0.045f * size, .colour = ink});
  constexpr int kPoints = 13;
  for (int i = 0; i < kPoints; ++i) {
    const float x = 2 * static_cast<float>(i) / (kPoints - 1) - 1;
    mouth.places.push_back(at(0.19f * x, -0.27f + 0.10f * x * x));
  }
  mouth.points.resize(mouth.places.size());
  for (Spots& spots : spots_) spots.centres.resize(spots.places.size());
}

void SoftShape2d::deform(std::span<const Vector2f> particles) {
  SC_ASSERT(particles.size() == model_.particles(), "{} particles of body '{}' with {}", particles.size(),
            body_.name, model_.particles());
  box_.setEmpty();
  for (Layer& layer : layers_) {
    ppu::deform(layer.skin, particles, layer.positions, layer.slopes);
    for (std::size_t i = 0; i < layer.positions.size(); ++i) {
      layer.vertices[i].position = layer.positions[i];
      layer.vertices[i].slope = layer.slopes[i];
      box_.extend(layer.positions[i]);
    }
    for (Outline& outline : layer.outlines) {
      for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
        outline.points[i] = layer.positions[outline.vertices[i]];
        if (!outline.normals.empty()) outline.normals[i] = layer.slopes[outline.vertices[i]];
      }
    }
  }
  for (Spots& spots : spots_) {
    for (std::size_t i = 0; i < spots.places.size(); ++i) {
      spots.centres[i] = spots.places[i].at(particles) + spots.aside[i];
      box_.extend(Box(spots.centres[i] - Vector2f::Constant(spots.radius),
                      spots.centres[i] + Vector2f::Constant(spots.radius)));
    }
  }
  for (Stroke& stroke : strokes_) {
    for (std::size_t i = 0; i < stroke.places.size(); ++i) {
      stroke.points[i] = stroke.places[i].at(particles);
      box_.extend(stroke.points[i]);
    }
  }
}

void SoftShape2d::draw(Drawing2d& drawing, float line_width, float opacity) const {
  SC_ASSERT(line_width > 0 && opacity >= 0 && opacity <= 1, "body '{}' with lines of {} m, opacity {}",
            body_.name, line_width, opacity);
  const auto add_lines = [&](const Layer& layer, float width, const render::Colour& colour) {
    for (const Outline& outline : layer.outlines)
      drawing.lines.push_back({.points = outline.points,
                               .normals = outline.normals,
                               .closed = true,
                               .width = width,
                               .colour = colour});
  };
  for (const Layer& layer : layers_) {
    // The whole body would show through a pale part.
    if (opacity < 1 && is_coloured_ && !layer.is_part) continue;
    drawing.shapes.push_back({.shape = layer.shape,
                              .vertices = layer.vertices,
                              .colour = layer.colour,
                              .opacity = opacity,
                              .texture = texture_});
    if (opacity >= 1 && layer.is_part && layer.colour != body_.colour)
      add_lines(layer, kSeamWidth * line_width, kSeam * layer.colour);
  }
  add_lines(layers_.front(), line_width, ink_of(body_.colour));
  if (opacity < 1) return;
  for (const Stroke& stroke : strokes_)
    drawing.lines.push_back({.points = stroke.points, .width = stroke.width, .colour = stroke.colour});
  for (const Spots& spots : spots_)
    drawing.dots.push_back(
        {.centres = spots.centres, .radius = spots.radius, .colour = spots.colour, .opacity = spots.opacity});
}

}  // namespace softcell::demos
