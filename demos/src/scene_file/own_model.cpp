#include "own_model.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

#include "mesh_files.h"
#include "read_common.h"
#include "softcell/base/assert.h"
#include "softcell/mesh_import/mesh_import.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::demos {
namespace {

/// @param longest  side of the model's box
double cell_size(const OwnModelOptions& options, double longest) {
  SC_ASSERT(longest > 0 && options.cells > 0, "{} cells along {}", options.cells, longest);
  if (!options.cell) return longest / options.cells;
  const double cell = *options.cell;
  constexpr double kNearlyAll = 0.999;  // of the model: the rest would be a rounding error of a cell
  if (cell > kNearlyAll * longest) {
    throw std::runtime_error(fmt::format(
        "--cell {}: one cell would hold the whole model, which is {:.4g} long; give less than that", cell,
        longest));
  }
  if (cell * ppu::kMaxLatticeCellsPerAxis < longest) {
    throw std::runtime_error(fmt::format(
        "--cell {}: the model is {:.4g} long and may be at most {} cells long; give {:.4g} or more", cell,
        longest, ppu::kMaxLatticeCellsPerAxis, longest / ppu::kMaxLatticeCellsPerAxis * 1.001));
  }
  return cell;
}

/// The number of particles of the lattice with such cells; none if there is no such lattice.
std::optional<std::size_t> particles_of(const ppu::TriangleMesh& mesh, double cell) {
  try {
    return ppu::count_particles(mesh, static_cast<float>(cell));
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

bool fit_a_scene(std::optional<std::size_t> particles) {
  return particles && *particles <= kMaxParticlesOfScene;
}

/// Throws if cells of this size or the model itself cannot be used. The model is refused here, before the scene scales the model and its
/// cells.
void check_lattice(const OwnModelOptions& options, const ppu::TriangleMesh& mesh, double longest,
                   double cell) {
  const std::optional<std::size_t> particles = particles_of(mesh, cell);
  if (fit_a_scene(particles)) return;
  // Cells of twice the size leave an eighth of the particles or more, so that cells smaller than this need not be tried.
  const double least =
      particles ? cell * std::cbrt(static_cast<double>(*particles) / kMaxParticlesOfScene) : cell;
  constexpr double kCoarser = 1.2;  // needs few tries, and is precise enough
  double enough = cell * kCoarser;
  while (enough < longest && (enough < least || !fit_a_scene(particles_of(mesh, enough)))) enough *= kCoarser;
  if (enough >= longest) ppu::voxelize(mesh, static_cast<float>(cell));  // its message is about the mesh
  const std::string too_many =
      fmt::format("the lattice would have more than {} particles", kMaxParticlesOfScene);
  if (options.cell) {
    throw std::runtime_error(
        fmt::format("--cell {}: {}; {:.4g} is large enough", *options.cell, too_many, enough));
  }
  throw std::runtime_error(fmt::format("--cells {}: {}; {} are few enough", options.cells, too_many,
                                       static_cast<int>(longest / enough)));
}

/// The longest side in metres. @param longest  side of the model's box, in its units
float own_size(double unit, double longest, double cell) {
  if (cell * unit < static_cast<double>(kLeastCellSize)) {
    throw std::runtime_error(
        fmt::format("--unit {}: a lattice cell would be {:.4g} m long; give {:.4g} or more", unit,
                    cell * unit, kLeastCellSize / cell * 1.001));
  }
  if (longest * unit > static_cast<double>(kFar)) {
    throw std::runtime_error(fmt::format("--unit {}: the model would be {:.4g} m long; give {:.4g} or less",
                                         unit, longest * unit, kFar / longest * 0.999));
  }
  return static_cast<float>(longest * unit);
}

}  // namespace

std::optional<OwnModel> load_own_model(const OwnModelOptions& options) {
  if (!options.mesh) return std::nullopt;
  ppu::ImportReport report;
  OwnModel model{.mesh = ppu::import_mesh(*options.mesh, &report)};
  model.files = report.files;
  model.file = *options.mesh;
  model.z_up = options.z_up;
  if (!report.not_read.empty()) model.notes = {not_read_of(options.mesh->string(), report)};
  if (options.z_up) ppu::turn_z_up(model.mesh);
  const ppu::Bounds<3> box = ppu::bounds(model.mesh);
  const double longest = (box.high - box.low).maxCoeff();
  constexpr double kLeastSide = 1e-30;  // a float holds its inverse
  if (!(longest >= kLeastSide))
    throw std::runtime_error(fmt::format("{}: its longest side is {:.3g}; {} or more was expected",
                                         options.mesh->string(), longest, kLeastSide));
  const double cell = cell_size(options, longest);
  ppu::fit(model.mesh, static_cast<float>(longest));  // centred, its size unchanged
  check_lattice(options, model.mesh, longest, cell);
  model.cell_size = static_cast<float>(cell);
  if (options.unit) model.longest_side = own_size(*options.unit, longest, cell);
  model.tessellation = options.tessellation;
  return model;
}

}  // namespace softcell::demos
