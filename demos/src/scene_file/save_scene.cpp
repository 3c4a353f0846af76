#include "save_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "document/table_edit.h"
#include "document/write_toml.h"
#include "scene_source.h"
#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"
#include "state_file.h"

namespace softcell::demos {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStateEnding = ".state";

std::vector<Value*> soft_bodies_in(Table& root) {
  std::vector<Value*> bodies;
  if (Array* const items = items_in(root, "soft_body"))
    for (Value& item : *items) bodies.push_back(&item);
  return bodies;
}

/// A scene that is being saved.
class SavedScene {
 public:
  /// @param root  of the document, with the present values
  SavedScene(const SceneDocument& document, Table root, const fs::path& scene_file)
      : document_(document),
        root_(std::move(root)),
        file_(scene_file),
        folder_(fs::weakly_canonical(fs::absolute(scene_file)).parent_path()) {}

  Table& root() { return root_; }
  std::vector<Value*> soft_bodies() { return soft_bodies_in(root_); }

  /// The name of the command line's file in the saved scene.
  std::string own_file() const { return relative(document_.own->file); }

  /// Rewrites the name of a file that a body names so that the saved scene finds it.
  void make_file_findable(Table& item, std::string_view field) {
    Value* const value = find_field(item, field);
    if (value == nullptr) return;
    const auto& name = std::get<std::string>(value->data);
    if (name.starts_with("/usr/share/")) return;  // installed
    if (fs::path(name).is_absolute()) {           // dropped onto the window
      *value = text_value(relative(name));
      return;
    }
    if (document_.folder) {
      *value = text_value(relative(*document_.folder / name));
      return;
    }
    const base::EmbeddedFile* const embedded = base::find_embedded(embedded_scenes(), name);
    SC_ASSERT(embedded != nullptr, "the built-in scene names the file '{}', which is none", name);
    const fs::path copy = fs::path(file_).replace_extension().string() + "_" + name;
    if (std::ranges::find(copies_, copy, &SceneFile::path) == copies_.end())
      copies_.push_back({copy, std::string(embedded->text)});
    *value = text_value(copy.filename().string());
  }

  template <int Dimension>
  std::vector<SceneFile> files(const Beginning<Dimension>& moment, const std::string& scene_name) {
    const fs::path state = fs::path(file_).replace_extension(kStateEnding);
    set_field(table_in(root_, "begin"), "state", text_value(state.filename().string()));
    std::vector<SceneFile> all{{file_, fmt::format("# The scene {} after {} frames, as softcell saved it.\n",
                                                   printable(scene_name), moment.frames) +
                                           write_toml({.data = root_, .location = {}})},
                               {state, state_to_text(moment)}};
    std::ranges::move(copies_, std::back_inserter(all));
    return all;
  }

 private:
  static std::string printable(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; }, '?');
    return name;
  }

  std::string relative(const fs::path& file) const {
    const fs::path location = fs::weakly_canonical(fs::absolute(file));
    const fs::path way = location.lexically_relative(folder_);
    if (way.empty() || *way.begin() == "..")
      throw std::runtime_error(
          fmt::format("the scene cannot be saved as {}: it uses {}, and a scene names files below its own "
                      "folder only; save it "
                      "in {}",
                      file_.string(), file.string(), location.parent_path().string()));
    return way.generic_string();
  }

  const SceneDocument& document_;
  Table root_;
  fs::path file_, folder_;
  std::vector<SceneFile> copies_;
};

/// Copies the fields of the body's material into the body itself, so that the body can leave some out.
void copy_material_into(Table& body, Table& root) {
  const Value* const name = find_field(body, "material");
  if (name == nullptr) return;
  Table& materials = table_in(root, "materials");
  const Value* const material = find_field(materials, std::get<std::string>(name->data));
  SC_ASSERT(material != nullptr, "a soft body of a material '{}' that its scene lacks",
            std::get<std::string>(name->data));
  // Fields that state the same thing in different ways: with one of them the body does not need the others.
  static constexpr std::array<std::array<std::string_view, 3>, 2> kAlternatives{
      {{"alpha", "frequency", "modulus"}, {"damping", "damping_time", ""}}};
  const auto says = [&body](std::string_view field) {
    for (const auto& names : kAlternatives)
      if (std::ranges::find(names, field) != names.end())
        return std::ranges::any_of(names,
                                   [&body](std::string_view n) { return find_field(body, n) != nullptr; });
    return find_field(body, field) != nullptr;
  };
  Table missing;
  for (const Field& field : std::get<Table>(material->data))
    if (!says(field.name)) missing.push_back(field);
  erase_fields(body, {"material"});
  body.insert(body.end(), missing.begin(), missing.end());
}

void save_plasticity(Table& body, const std::optional<ppu::Plasticity>& plasticity, Table& root) {
  if (!plasticity) {
    copy_material_into(body, root);
    erase_fields(body, {"plasticity"});
    return;
  }
  Table& table = table_in(body, "plasticity");
  set_field(table, "yield", number_value(plasticity->yield));
  set_field(table, "creep", number_value(plasticity->creep));
  set_field(table, "limit", number_value(plasticity->limit));
}

/// Replaces in a body's material what the user has changed by sliders.
void save_material(Table& body, Table& root, const ppu::SoftBodySettings& was,
                   const ppu::SoftBodySettings& now, bool other_substeps) {
  if (now.alpha != was.alpha || now.frequency != was.frequency || (other_substeps && !now.frequency)) {
    erase_fields(body, {"alpha", "frequency", "modulus"});
    set_field(body, now.frequency ? "frequency" : "alpha", number_value(now.frequency.value_or(now.alpha)));
  }
  if (now.damping != was.damping || now.damping_time != was.damping_time) {
    erase_fields(body, {"damping", "damping_time"});
    set_field(body, now.damping_time ? "damping_time" : "damping",
              number_value(now.damping_time.value_or(now.damping)));
  }
  if (now.friction != was.friction) set_field(body, "friction", number_value(now.friction));
  if (now.density != was.density) set_field(body, "density", number_value(now.density));
  if (now.plasticity != was.plasticity) save_plasticity(body, now.plasticity, root);
  ppu::SoftBodySettings rest = now;
  rest.alpha = was.alpha, rest.frequency = was.frequency;
  rest.damping = was.damping, rest.damping_time = was.damping_time;
  rest.friction = was.friction, rest.density = was.density;
  rest.plasticity = was.plasticity;
  SC_ASSERT(rest == was, "a soft body of cells of {} m has changed in what no scene file would say",
            was.cell_size);
}

/// Names the command line's file in the first body that it can replace, and keeps the other files that the bodies need.
/// @param side      the field by which a body lets a file replace it: the length of the file's model
/// @param own       the field that names the file
/// @param replaced  the fields that the file replaces
/// @param others    the fields of the other bodies that name files
template <class SceneOf>
void save_files_of_bodies(const SceneOf& scene, SavedScene& saved, std::string_view side,
                          const std::string& own, std::initializer_list<std::string_view> replaced,
                          std::initializer_list<std::string_view> others) {
  bool is_named = !scene.document->own;
  std::size_t number = 0;
  for (Value* const body : saved.soft_bodies()) {
    auto& table = std::get<Table>(body->data);
    const float cell_size = scene.soft_bodies[number++].settings.cell_size;
    const Value* const length = is_named ? nullptr : find_field(table, side);
    if (length == nullptr) {
      for (const std::string_view field : others) saved.make_file_findable(table, field);
      continue;
    }
    is_named = true;
    const Value longest = *length;
    erase_fields(table, {side});
    erase_fields(table, replaced);
    const auto& its_own = scene.document->own->longest_side;
    set_field(table, "longest_side", its_own ? number_value(*its_own) : longest);
    set_field(table, own, text_value(saved.own_file()));
    if (scene.document->own->z_up) set_field(table, "up", text_value("z"));
    if (const auto& tessellation = scene.document->own->tessellation)
      set_field(table, "tessellate", number_value(*tessellation));
    set_field(table, "cell_size", number_value(cell_size));
  }
}

template <class Vector>
bool is_downwards(const Vector& gravity) {
  Vector sideways = gravity;
  sideways.y() = 0;
  return sideways.isZero(0);
}

void require_document(const std::shared_ptr<const SceneDocument>& document, const std::string& name) {
  if (!document)
    throw std::runtime_error(fmt::format("the scene {} cannot be saved: a program has made it", name));
}

template <int Dimension, class SceneOf>
Table root_now(const SceneOf& scene, const PresentScene<Dimension>& now) {
  require_document(scene.document, scene.name);
  Table root = std::get<Table>(scene.document->root.data);
  erase_fields(root, {"pictures", "begin"});  // they belong to other frames
  Table& world = table_in(root, "world");
  SC_ASSERT(now.moment.gravity, "a moment of scene '{}' without gravity", scene.name);
  if (is_downwards(*now.moment.gravity))
    set_field(world, "gravity", number_value(0 - now.moment.gravity->y()));
  set_field(world, "substeps", integer_value(now.substeps));
  const std::vector<Value*> bodies = soft_bodies_in(root);
  SC_ASSERT(bodies.size() == scene.soft_bodies.size() && bodies.size() == now.materials.size(),
            "{} soft bodies in the document of scene '{}', {} in the scene and {} in the run", bodies.size(),
            scene.name, scene.soft_bodies.size(), now.materials.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    save_material(std::get<Table>(bodies[b]->data), root, scene.soft_bodies[b].settings, now.materials[b],
                  now.substeps != scene.substeps);
  return root;
}

template <int Dimension>
void save_moment(Table& root, const Beginning<Dimension>& moment) {
  Table& begin = table_in(root, "begin");
  if (!is_downwards(*moment.gravity)) set_field(begin, "gravity", vector_value(*moment.gravity));
  if (moment.time_scale != 1) set_field(begin, "time_scale", number_value(moment.time_scale));
  set_field(begin, "frames", integer_value(moment.frames));
}

void save_camera(Table& root, const render::Camera& camera) {
  Table& table = table_in(root, "camera");
  set_field(table, "eye", vector_value(camera.eye));
  set_field(table, "target", vector_value(camera.target));
  set_field(table, "up", vector_value(camera.up));
  set_field(table, "tan_half_fov_y", number_value(camera.tan_half_fov_y));
  set_field(table, "near", number_value(camera.near_plane));
  set_field(table, "far", number_value(camera.far_plane));
}

void save_contacts(Table& root, ppu::ContactMethod contacts) {
  set_field(table_in(root, "world"), "contacts",
            text_value(kContactMethods.at(static_cast<std::size_t>(contacts))));
}

}  // namespace

Table present_root(const Scene& scene, const PresentScene<3>& now) { return root_now<3>(scene, now); }
Table present_root(const Scene2d& scene, const PresentScene<2>& now) { return root_now<2>(scene, now); }

std::vector<SceneFile> saved_scene(const Scene& scene, const PresentScene<3>& now,
                                   const render::Camera& camera, ppu::ContactMethod contacts,
                                   const fs::path& scene_file) {
  Table now_root = present_root(scene, now);
  SavedScene saved(*scene.document, std::move(now_root), scene_file);
  save_moment(saved.root(), now.moment);
  Table& root = saved.root();
  if (contacts != scene.contacts) save_contacts(root, contacts);
  if (now.moment.tilt) set_field(table_in(root, "begin"), "tilt", vector_value(*now.moment.tilt));
  if (now.moment.seconds > 0)
    set_field(table_in(root, "begin"), "seconds", number_value(static_cast<float>(now.moment.seconds)));
  save_camera(root, camera);
  save_files_of_bodies(scene, saved, "own_model_side", "mesh", {"shape", "mesh", "scale", "up", "colour"},
                       {"mesh"});
  if (Array* const obstacles = items_in(root, "obstacle"))
    for (Value& obstacle : *obstacles) saved.make_file_findable(std::get<Table>(obstacle.data), "mesh");
  return saved.files(now.moment, scene.name);
}

std::vector<SceneFile> saved_scene(const Scene2d& scene, const PresentScene<2>& now,
                                   ppu::ContactMethod contacts, const fs::path& scene_file) {
  Table now_root = present_root(scene, now);
  SavedScene saved(*scene.document, std::move(now_root), scene_file);
  save_moment(saved.root(), now.moment);
  if (contacts != scene.contacts) save_contacts(saved.root(), contacts);
  save_files_of_bodies(scene, saved, "own_image_side", "image",
                       {"shape", "rows", "lattice", "image", "face", "cell_colours"}, {"lattice", "image"});
  return saved.files(now.moment, scene.name);
}

void write_scene_files(std::span<const SceneFile> files) {
  base::WholeFiles written;
  for (const SceneFile& file : files) written.open(file.path).write(file.bytes);
  written.commit();
}

fs::path free_scene_file(const SceneDocument* document, const std::string& scene_name) {
  fs::path folder;
  if (document != nullptr && document->own) {
    folder = document->own->file.parent_path();
  } else if (document != nullptr && document->folder) {
    folder = *document->folder;
  }
  for (int number = 1;; ++number) {
    fs::path path = folder / fmt::format("{}_{}.toml", scene_name, number);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) return path;
  }
}

}  // namespace softcell::demos
