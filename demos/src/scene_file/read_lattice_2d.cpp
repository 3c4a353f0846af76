#include "read_lattice_2d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "document/documents.h"
#include "document/lua_sandbox.h"
#include "picture_cells.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2i;
using Cells = std::vector<Vector2i>;

constexpr int kMaxCells = ppu::kMaxLatticeCellsPerAxis;
constexpr int kMaxGridIndex = 1'000'000;

Cells cells_where(const Vector2i& size, auto is_cell) {
  Cells cells;
  for (int x = 0; x < size.x(); ++x) {
    for (int y = 0; y < size.y(); ++y) {
      if (is_cell(x, y)) cells.push_back({x, y});
    }
  }
  return cells;
}

void rectangle(FieldReader& fields, SoftBody2dPlacement& body) {
  int width = 4, height = 4;
  fields.integer("width", width, 1, kMaxCells).integer("height", height, 1, kMaxCells).finish();
  body.cells = cells_where({width, height}, [](int, int) { return true; });
}

/// The cells whose centres lie in a ring; a disc is a ring without a hole.
void ring_of(int diameter, int hole, SoftBody2dPlacement& body) {
  SC_ASSERT(diameter > 0 && hole >= 0 && hole < diameter, "a ring of {} cells with a hole of {}", diameter,
            hole);
  body.cells = cells_where({diameter, diameter}, [&](int x, int y) {
    // Twice the distances from the middle, so that they are whole numbers.
    const int dx = 2 * x + 1 - diameter, dy = 2 * y + 1 - diameter, squared = dx * dx + dy * dy;
    return squared <= diameter * diameter && squared >= hole * hole;
  });
  // Between the nearest and the farthest points of the cells' edge, so that it neither covers what the body lies on nor ends far above it.
  const float half = 0.5f * static_cast<float>(diameter);
  float farthest = half;
  for (const Vector2i& cell : body.cells) {
    const Eigen::Vector2f middle = cell.cast<float>() + Eigen::Vector2f::Constant(0.5f - half);
    farthest = std::max(farthest, (middle.cwiseAbs() + Eigen::Vector2f::Constant(0.5f)).norm());
  }
  body.ring = {.middle = Eigen::Vector2f::Constant(half),
               .radius = half + 0.25f * (farthest - half),
               .hole = 0.5f * static_cast<float>(hole)};
}

void disc(FieldReader& fields, SoftBody2dPlacement& body) {
  int diameter = 8;
  fields.integer("diameter", diameter, 1, kMaxCells).finish();
  ring_of(diameter, 0, body);
}

void ring(FieldReader& fields, SoftBody2dPlacement& body) {
  int diameter = 10, hole = 4;
  fields.integer("diameter", diameter, 3, kMaxCells).integer("hole", hole, 0, kMaxCells).finish();
  if (hole > diameter - 2) {
    throw SceneError(
        fields.location("hole"),
        fmt::format("hole of {} is {}; it must be at least 2 less than diameter", fields.what(), hole));
  }
  ring_of(diameter, hole, body);
}

constexpr std::array<std::string_view, 3> kLatticeKinds{"disc", "rectangle", "ring"};
constexpr std::array<void (*)(FieldReader&, SoftBody2dPlacement&), 3> kLatticeMakers{disc, rectangle, ring};

void read_shape(const Value& value, const std::string& owner, SoftBody2dPlacement& body) {
  FieldReader fields(value, "the shape of " + owner);
  std::size_t kind = kLatticeKinds.size();
  fields.choice("kind", kind, kLatticeKinds, Need::kRequired);
  if (kind == kLatticeKinds.size())
    throw SceneError(value.location, fields.what() + " needs the field 'kind'");
  kLatticeMakers[kind](fields, body);
}

Cells read_rows(std::span<const Value> items, const std::string& owner) {
  SC_ASSERT(!items.empty(), "the rows of {} are none", owner);
  std::vector<std::string> rows;
  for (const Value& item : items) {
    const auto* text = std::get_if<std::string>(&item.data);
    if (text == nullptr || text->size() > kMaxCells) {
      throw SceneError(item.location, fmt::format("row {} of {} must be a text of at most {} characters",
                                                  rows.size() + 1, owner, kMaxCells));
    }
    rows.push_back(*text);
  }
  try {
    return ppu::cells_from_rows(rows);
  } catch (const std::runtime_error& error) {
    throw SceneError(items.front().location, error.what());
  }
}

Cells read_cells(std::span<const Value> items, const std::string& owner) {
  Cells cells;
  for (const Value& item : items) {
    const std::string name = fmt::format("cell {} of {}", cells.size() + 1, owner);
    const auto* pair = std::get_if<Array>(&item.data);
    if (pair == nullptr || pair->size() != 2)
      throw SceneError(item.location, name + " must be an array of 2 numbers");
    cells.push_back({read_integer((*pair)[0], "x of " + name, -kMaxGridIndex, kMaxGridIndex),
                     read_integer((*pair)[1], "y of " + name, -kMaxGridIndex, kMaxGridIndex)});
  }
  return cells;
}

/// Reads what a lattice's Lua file returns: `cells` or `rows`.
Cells read_lattice_file(const SourceText& file, const Location& location) {
  if (!file.is_lua())
    throw SceneError(location, fmt::format("lattice '{}' must be a file that ends in .lua", *file.name));
  const Value value = run_lua(file.text, file.name);
  FieldReader fields(value, "a lattice");
  const auto cells = fields.items("cells", ppu::kMaxLatticeParticles<2>);
  const auto rows = fields.items("rows", static_cast<std::size_t>(kMaxCells));
  fields.finish();
  if (cells.empty() == rows.empty()) throw SceneError(value.location, "a lattice needs either cells or rows");
  return rows.empty() ? read_cells(cells, "a lattice") : read_rows(rows, "a lattice");
}

/// If rounding of floats has made the quotient slightly different from a whole number, returns that number: the picture is cut into the
/// same cells.
double cells_along(float side, float cell_size) {
  const double cells = double{side} / double{cell_size}, whole = std::round(cells);
  return std::abs(cells - whole) < 1e-6 * whole ? whole : cells;
}

/// Processor time of the child processes that have ended.
double childrens_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

LatticeFiles::LatticeFiles(const SceneSource& source) : source_(source), begin_(childrens_seconds()) {}

const Cells& LatticeFiles::cells(const std::string& file, const Location& location) {
  if (const auto found = known_.find(file); found != known_.end()) return found->second;
  if (childrens_seconds() - begin_ > kLuaSeconds)
    throw SceneError(location, fmt::format("the scripts of the scene's lattices ran for more than {} second",
                                           kLuaSeconds));
  return known_.emplace(file, read_lattice_file(source_.text(file, location), location)).first->second;
}

std::shared_ptr<const render::Image> LatticeFiles::picture(const std::string& file,
                                                           const Location& location) {
  if (const auto found = pictures_.find(file); found != pictures_.end()) return found->second;
  constexpr std::size_t kMaxPictureFiles = 32;
  if (pictures_.size() == kMaxPictureFiles)
    throw SceneError(location, fmt::format("the scene names more than {} pictures", kMaxPictureFiles));
  const std::filesystem::path path = source_.picture(file, location);
  try {
    return pictures_.emplace(file, load_picture(path)).first->second;
  } catch (const std::runtime_error& error) {
    throw SceneError(location, error.what());
  }
}

void read_lattice_2d(FieldReader& fields, LatticeFiles& files, const OwnPicturePlace& own,
                     SoftBody2dPlacement& body) {
  const auto rows = fields.items("rows", static_cast<std::size_t>(kMaxCells));
  const Value* shape = fields.field("shape");
  std::string file, image;
  std::optional<float> longest_side;
  fields.text("lattice", file).text("image", image).number("longest_side", longest_side, kLength).finish();
  const int given = (rows.empty() ? 0 : 1) + (shape != nullptr ? 1 : 0) + (fields.has("lattice") ? 1 : 0) +
                    (fields.has("image") ? 1 : 0);
  if (given != 1)
    throw SceneError(fields.location(), fields.what() + (given == 0 ? " needs one of" : " has several of") +
                                            " rows, shape, lattice and image" +
                                            (given == 0 ? "" : "; it may have one of them"));
  if (longest_side && !fields.has("image"))
    throw SceneError(fields.location("longest_side"),
                     fields.what() + " has longest_side, which only an image has");
  const auto from_picture = [&](std::shared_ptr<const render::Image> picture, float side, double cells,
                                const Location& location) {
    try {
      PictureCells made = cells_of_picture(std::move(picture), cells);
      body.cells = std::move(made.cells);
      body.picture = std::make_shared<const Picture2d>(std::move(made.picture));
      body.settings.cell_size = static_cast<float>(side / cells);
    } catch (const std::runtime_error& error) {
      if (own.picture != nullptr)
        throw std::runtime_error(fmt::format("{}: {}", own.picture->file.string(), error.what()));
      throw SceneError(location, fmt::format("{}: {}", fields.what(), error.what()));
    }
  };
  if (own.picture != nullptr) {
    from_picture(own.picture->image, own.longest_side, own.picture->cells, fields.location());
  } else if (fields.has("image")) {
    const Location& location = fields.location("image");
    const float side = longest_side.value_or(2), stated = body.settings.cell_size;
    from_picture(files.picture(image, location), side,
                 stated > 0 ? cells_along(side, stated) : double{kCellsAlongPicture}, location);
  } else if (shape != nullptr) {
    read_shape(*shape, fields.what(), body);
  } else if (!rows.empty()) {
    body.cells = read_rows(rows, fields.what());
  } else {
    body.cells = files.cells(file, fields.location("lattice"));
  }
}

}  // namespace softcell::demos
