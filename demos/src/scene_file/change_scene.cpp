#include "change_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "document/table_edit.h"
#include "picture_cells.h"
#include "read_common.h"
#include "read_scene.h"
#include "scene_document.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

namespace fs = std::filesystem;

constexpr int kCellsAlong = 8;  // as with --mesh

/// Gives the scene a document of its own, which may be changed.
template <class SceneOf>
SceneDocument& own_document(SceneOf& scene) {
  auto own = std::make_shared<SceneDocument>(*scene.document);
  SceneDocument& document = *own;
  scene.document = std::move(own);
  return document;
}

Table& root_of(SceneDocument& document) { return std::get<Table>(document.root.data); }

template <int Dimension, class SceneOf>
SceneOf changed_by_run(const SceneOf& scene, const PresentScene<Dimension>& now) {
  SceneOf changed = scene;
  root_of(own_document(changed)) = present_root(scene, now);
  changed.begin = std::make_shared<const Beginning<Dimension>>(now.moment);
  changed.substeps = now.substeps;
  for (std::size_t b = 0; b < now.materials.size(); ++b) changed.soft_bodies[b].settings = now.materials[b];
  return changed;
}

/// "cat"; if a body already has that name, "cat 2".
template <class SceneOf>
std::string free_name(const SceneOf& scene, const std::string& name) {
  const auto taken = [&](const std::string& candidate) {
    return std::ranges::any_of(scene.soft_bodies, [&](const auto& body) { return body.name == candidate; });
  };
  std::string free = name;
  for (int number = 2; taken(free); ++number) free = fmt::format("{} {}", name, number);
  return free;
}

std::string printable_stem(const fs::path& file) {
  std::string stem = file.stem().string();
  std::ranges::replace_if(
      stem, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, '?');
  return stem.empty() ? "body" : stem;
}

/// The new body's item: it has the material of the scene's first body, except for the size of its cells.
template <int Dimension, class SceneOf>
Table new_item(const SceneOf& scene, const std::string& name, const NewBody<Dimension>& body,
               float cell_size) {
  Table item;
  set_field(item, "name", text_value(free_name(scene, name)));
  set_field(item, "cell_size", number_value(cell_size));
  set_field(item, "alpha", number_value(body.alpha));
  if (!scene.soft_bodies.empty()) {
    const ppu::SoftBodySettings& first = scene.soft_bodies.front().settings;
    set_field(item, "half_width", integer_value(first.half_width));
    set_field(item, "density", number_value(first.density));
    set_field(item, first.damping_time ? "damping_time" : "damping",
              number_value(first.damping_time.value_or(first.damping)));
    set_field(item, "friction", number_value(first.friction));
    set_field(item, "restitution", number_value(first.restitution));
    if (!first.self_contacts) set_field(item, "self_contacts", Value{.data = false, .location = {}});
  }
  set_field(item, "position", vector_value(body.middle));
  return item;
}

/// Reads the item as the scene's last soft body, and puts it into the document.
template <class SceneOf>
void add_item(SceneOf& scene, Table item, const std::vector<fs::path>& files) {
  if (scene.soft_bodies.size() == kMaxSoftBodies)
    throw std::runtime_error(fmt::format("a scene has at most {} soft bodies", kMaxSoftBodies));
  const Value value{.data = std::move(item), .location = {}};
  SceneOf changed = scene;
  try {
    read_another_body(value, SceneSource::of_user(files), changed);
  } catch (const SceneError& error) {
    // The mistake is in no scene file, so the message has no location.
    const std::string sentence = error.what(), location = to_string(value.location) + ": ";
    throw std::runtime_error(sentence.starts_with(location) ? sentence.substr(location.size()) : sentence);
  }
  Table& root = root_of(own_document(changed));
  if (items_in(root, "soft_body") == nullptr) set_field(root, "soft_body", {.data = Array{}, .location = {}});
  items_in(root, "soft_body")->push_back(value);
  changed.files.insert(changed.files.end(), files.begin(), files.end());
  scene = std::move(changed);
}

/// @param field  the field that names the file
template <int Dimension, class SceneOf>
void add_file_as(const std::string& field, int cells_along, SceneOf& scene, const fs::path& file,
                 const NewBody<Dimension>& body) {
  const fs::path path = fs::absolute(file);
  Table item =
      new_item(scene, printable_stem(file), body, body.longest_side / static_cast<float>(cells_along));
  set_field(item, field, text_value(path.string()));
  set_field(item, "longest_side", number_value(body.longest_side));
  add_item(scene, std::move(item), {path});
}

Value shape_value(std::string_view kind, std::initializer_list<std::pair<std::string, Value>> fields) {
  Table shape;
  set_field(shape, "kind", text_value(kind));
  for (const auto& [name, value] : fields) set_field(shape, name, value);
  return {.data = std::move(shape), .location = {}};
}

constexpr std::array<std::string_view, 6> kShapes3d{"box", "sphere", "torus", "cylinder", "cone", "penguin"};
constexpr std::array<std::string_view, 3> kShapes2d{"rectangle", "disc", "ring"};

/// Removes the items that name the body.
void erase_naming(Table& root, std::string_view array, std::initializer_list<std::string_view> fields,
                  const std::string& name) {
  Array* const items = items_in(root, array);
  if (items == nullptr) return;
  std::erase_if(*items, [&](Value& item) {
    return std::ranges::any_of(fields, [&](std::string_view field) {
      const Value* const value = find_field(std::get<Table>(item.data), field);
      const auto* const text = value != nullptr ? std::get_if<std::string>(&value->data) : nullptr;
      return text != nullptr && *text == name;
    });
  });
  if (items->empty()) erase_fields(root, {array});
}

/// Removes what belongs to the body, and renumbers what belongs to bodies after it.
template <class Items>
void erase_of_body(Items& items, std::size_t body) {
  std::erase_if(items, [&](const auto& item) { return item.body == body; });
  for (auto& item : items)
    if (item.body > body) --item.body;
}

/// Removes the attachments of the body, renumbers the bodies after it, and renumbers the attachments that have ended.
template <int Dimension>
void erase_attachments(std::vector<AttachmentPlacement<Dimension>>& attachments, std::size_t body,
                       std::vector<std::uint32_t>* ended) {
  const auto of_body = [&](const AttachmentPlacement<Dimension>& attachment) {
    return attachment.body == body || attachment.other == body;
  };
  if (ended != nullptr) {
    std::vector<std::uint32_t> still_ended;
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < attachments.size(); ++i) {
      if (of_body(attachments[i])) continue;
      if (std::ranges::binary_search(*ended, i)) still_ended.push_back(kept);
      ++kept;
    }
    *ended = std::move(still_ended);
  }
  std::erase_if(attachments, of_body);
  for (AttachmentPlacement<Dimension>& attachment : attachments) {
    if (attachment.body > body) --attachment.body;
    if (attachment.other && *attachment.other > body) --*attachment.other;
  }
}

template <int Dimension, class SceneOf>
void remove_from(SceneOf& scene, std::size_t body, std::string_view own_side) {
  SC_ASSERT(body < scene.soft_bodies.size(), "body {} of {}", body, scene.soft_bodies.size());
  const std::string name = scene.soft_bodies[body].name;
  SceneDocument& document = own_document(scene);
  Table& root = root_of(document);
  Array& items = *items_in(root, "soft_body");
  // The model of the command line replaces the first body that lets it.
  const auto lets = [&](Value& item) { return find_field(std::get<Table>(item.data), own_side) != nullptr; };
  const auto first = std::ranges::find_if(items, lets);
  if (first != items.end() && static_cast<std::size_t>(first - items.begin()) == body) document.own.reset();
  // Names that bodies have by their number do not change.
  for (std::size_t b = 0; b < items.size(); ++b)
    set_field(std::get<Table>(items[b].data), "name", text_value(scene.soft_bodies[b].name));
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(body));
  if (items.empty()) erase_fields(root, {"soft_body"});
  erase_naming(root, "attach", {"body", "to"}, name);
  erase_naming(root, "impulse", {"body"}, name);
  erase_naming(root, "drag", {"body"}, name);
  erase_naming(root, "cut", {"body"}, name);
  scene.soft_bodies.erase(scene.soft_bodies.begin() + static_cast<std::ptrdiff_t>(body));
  erase_of_body(scene.script.impulses, body);
  erase_of_body(scene.script.drags, body);
  erase_of_body(scene.cuts, body);
  auto begin = scene.begin ? std::make_shared<Beginning<Dimension>>(*scene.begin) : nullptr;
  erase_attachments<Dimension>(scene.attachments, body, begin ? &begin->ended_attachments : nullptr);
  if (begin && body < begin->soft_bodies.size())
    begin->soft_bodies.erase(begin->soft_bodies.begin() + static_cast<std::ptrdiff_t>(body));
  if (begin) erase_of_body(begin->pins, body);
  scene.begin = std::move(begin);
}

template <class SceneOf>
void set_density_of(SceneOf& scene, std::size_t body, float density) {
  SC_ASSERT(body < scene.soft_bodies.size() && density > 0, "body {} of {} gets a density of {}", body,
            scene.soft_bodies.size(), density);
  scene.soft_bodies[body].settings.density = density;
  Array& items = *items_in(root_of(own_document(scene)), "soft_body");
  set_field(std::get<Table>(items.at(body).data), "density", number_value(density));
}

}  // namespace

Scene scene_now(const Scene& scene, const PresentScene<3>& now) { return changed_by_run<3>(scene, now); }
Scene2d scene_now(const Scene2d& scene, const PresentScene<2>& now) { return changed_by_run<2>(scene, now); }

std::span<const std::string_view> spawned_shapes(int dimension) {
  if (dimension == 3) return kShapes3d;
  return kShapes2d;
}

void add_file(Scene& scene, const fs::path& file, const NewBody<3>& body) {
  add_file_as("mesh", kCellsAlong, scene, file, body);
}
void add_file(Scene2d& scene, const fs::path& file, const NewBody<2>& body) {
  add_file_as("image", kCellsAlongPicture, scene, file, body);
}

void add_shape(Scene& scene, std::string_view shape, const NewBody<3>& body) {
  const float side = body.longest_side, half = side / 2;
  Table item = new_item(scene, std::string(shape), body, side / kCellsAlong);
  set_field(item, "colour", text_value("#E0803C"));
  Value value;
  if (shape == "box") {
    value = shape_value(shape, {{"size", vector_value(Eigen::Vector3f(side, side, side))},
                                {"step", number_value(side / kCellsAlong)}});
  } else if (shape == "sphere") {
    value = shape_value(shape, {{"radius", number_value(half)}});
  } else if (shape == "torus") {
    value = shape_value(shape, {{"major", number_value(0.7f * half)}, {"minor", number_value(0.3f * half)}});
  } else if (shape == "penguin") {
    value = shape_value(shape, {{"height", number_value(side)}});
  } else {
    SC_ASSERT(shape == "cylinder" || shape == "cone", "no shape is called '{}'", shape);
    value = shape_value(shape, {{"radius", number_value(half)}, {"height", number_value(side)}});
  }
  set_field(item, "shape", std::move(value));
  add_item(scene, std::move(item), {});
}

void add_shape(Scene2d& scene, std::string_view shape, const NewBody<2>& body) {
  constexpr int kCells = 10;
  Table item = new_item(scene, std::string(shape), body, body.longest_side / kCells);
  set_field(item, "colour", text_value("#E0803C"));
  Value value;
  if (shape == "rectangle") {
    value = shape_value(shape, {{"width", integer_value(kCells)}, {"height", integer_value(kCells)}});
  } else {
    SC_ASSERT(shape == "disc" || shape == "ring", "no shape is called '{}'", shape);
    value = shape_value(shape, {{"diameter", integer_value(kCells)}});
  }
  set_field(item, "shape", std::move(value));
  add_item(scene, std::move(item), {});
}

void remove_body(Scene& scene, std::size_t body) { remove_from<3>(scene, body, "own_model_side"); }
void remove_body(Scene2d& scene, std::size_t body) { remove_from<2>(scene, body, "own_image_side"); }

void set_density(Scene& scene, std::size_t body, float density) { set_density_of(scene, body, density); }
void set_density(Scene2d& scene, std::size_t body, float density) { set_density_of(scene, body, density); }

}  // namespace softcell::demos
