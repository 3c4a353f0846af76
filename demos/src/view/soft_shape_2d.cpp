#include "soft_shape_2d.h"

#include <algorithm>
#include <map>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr float kSeam = 0.6f;  // of the light of two colours that meet

float margin_of(const SoftBody2dPlacement& body) {
  return std::min(body.contact_radius, ppu::kMaxSkinMargin);
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
    skin_ = own_skin(
        wholes, [&](const ppu::Lattice<2>& lattice) { return ppu::make_skin_2d(lattice, margin_of(body)); });
    vertices_.resize(skin_.vertices.size());
    add_parts(renderer);
  }
  positions_.resize(skin_.vertices.size());
  slopes_.resize(skin_.vertices.size());
  for (const auto& loop : skin_.outlines) {
    outlines_.push_back({.vertices = loop,
                         .points = std::vector<Vector2f>(loop.size()),
                         .normals = std::vector<Vector2f>(model.is_piece() ? 0 : loop.size())});
  }
  if (has_face()) add_face(*body.face);
}

void SoftShape2d::remove_from(render::Renderer& renderer) const {
  for (const Part& part : parts_) renderer.remove_shape(part.shape);
}

/// @param make  the skin of a whole lattice
template <class Make>
ppu::Skin2d SoftShape2d::own_skin(WholeSkins& wholes, const Make& make) const {
  if (!model_.is_piece()) return make(model_.lattice());
  const ppu::Lattice<2>& whole = model_.whole()->lattice();
  return ppu::skin_of_piece(wholes.get(body_, [&] { return make(whole); }), whole, model_.lattice());
}

/// Of pieces the one that has the cell in the middle of the face.
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

/// One shape for each colour, in the order in which the scene has them.
void SoftShape2d::add_parts(render::Renderer& renderer) {
  const auto colour_of = [&](std::uint32_t cell) {
    const Vector2i& at = model_.lattice().cells[cell];
    for (std::size_t i = body_.coloured_cells.size(); i-- > 0;) {
      const ColouredCells2d& cells = body_.coloured_cells[i];
      if ((at.array() >= cells.low.array()).all() && (at.array() <= cells.high.array()).all()) return i + 1;
    }
    return std::size_t{0};
  };
  std::map<std::size_t, std::vector<render::Triangle>> triangles;
  using Edge = std::array<std::uint32_t, 2>;
  std::map<Edge, std::size_t> first_colours;  // of the first triangle at each edge
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Edge>> seams;
  for (std::size_t t = 0; t < skin_.triangles.size(); ++t) {
    const std::size_t colour = colour_of(skin_.cells[t]);
    const auto& corners = skin_.triangles[t];
    triangles[colour].push_back(corners);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(corners[k], corners[(k + 1) % 3]);
      const auto [first, is_new] = first_colours.try_emplace({a, b}, colour);
      if (!is_new && part_colour(first->second) != part_colour(colour))
        seams[std::minmax(first->second, colour)].push_back({a, b});
    }
  }
  for (const auto& [colour, list] : triangles)
    parts_.push_back({.shape = renderer.add_shape(list), .colour = part_colour(colour)});
  for (auto& [colours, edges] : seams)
    seams_.push_back({.edges = std::move(edges),
                      .colour = kSeam * (part_colour(colours.first) + part_colour(colours.second)) / 2});
}

/// @param part  0: the body's own colour, or 1 and the number of its coloured cells
render::Colour SoftShape2d::part_colour(std::size_t part) const {
  return part == 0 ? body_.colour : body_.coloured_cells[part - 1].colour;
}

void SoftShape2d::add_picture(render::Renderer& renderer, Stickers& stickers, WholeSkins& wholes) {
  const Picture2d& picture = *body_.picture;
  const auto& [sticker, texture] =
      stickers.get(picture.image, margin_of(body_) * picture.cell_pixels, renderer);
  // In grid coordinates: where the sticker, which is larger than the picture, begins and how large it is.
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
  skin_ = own_skin(
      wholes, [&](const ppu::Lattice<2>& lattice) { return ppu::make_cover_2d(lattice, has_something); });
  vertices_.resize(skin_.vertices.size());
  for (std::size_t i = 0; i < skin_.vertices.size(); ++i)
    vertices_[i].texture = (skin_.rest[i] - low).cwiseQuotient(size);
  parts_.push_back({.shape = renderer.add_shape(skin_.triangles), .colour = body_.colour});
  texture_ = texture;
}

void SoftShape2d::add_face(const Face2d& face) {
  const ppu::Lattice<2>& lattice = model_.lattice();
  const auto at = [&](float x, float y) {
    return ppu::point_in_cells(lattice, face.centre + face.size * Vector2f(x, y));
  };
  const float size = face.size * lattice.spacing;  // metres
  const render::Colour ink = render::srgb(0x1E2530), white = render::srgb(0xFFFFFF);
  const float eye = 0.215f, height = 0.10f;  // where the eyes are, and all that follows: shares of the size
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

void SoftShape2d::place(std::span<const Vector2f> particles) {
  SC_ASSERT(particles.size() == model_.particles(), "{} particles of body '{}' with {}", particles.size(),
            body_.name, model_.particles());
  ppu::place(skin_, particles, positions_, slopes_);
  box_.setEmpty();
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    vertices_[i].position = positions_[i];
    vertices_[i].slope = slopes_[i];
    box_.extend(positions_[i]);
  }
  for (Outline& outline : outlines_) {
    for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
      outline.points[i] = positions_[outline.vertices[i]];
      if (!outline.normals.empty()) outline.normals[i] = slopes_[outline.vertices[i]];
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
  for (const Part& part : parts_)
    drawing.shapes.push_back({.shape = part.shape,
                              .vertices = vertices_,
                              .colour = part.colour,
                              .opacity = opacity,
                              .texture = texture_});
  if (opacity >= 1) {
    for (const Seam& seam : seams_)
      drawing.links.push_back(
          {.points = positions_, .links = seam.edges, .width = 0.7f * line_width, .colour = seam.colour});
  }
  for (const Outline& outline : outlines_)
    drawing.lines.push_back({.points = outline.points,
                             .normals = outline.normals,
                             .closed = true,
                             .width = line_width,
                             .colour = ink_of(body_.colour)});
  if (opacity < 1) return;
  for (const Stroke& stroke : strokes_)
    drawing.lines.push_back({.points = stroke.points, .width = stroke.width, .colour = stroke.colour});
  for (const Spots& spots : spots_)
    drawing.dots.push_back(
        {.centres = spots.centres, .radius = spots.radius, .colour = spots.colour, .opacity = spots.opacity});
}

}  // namespace softcell::demos
