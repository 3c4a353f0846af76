#pragma once
// Presents a body of two dimensions to contacts in three, as a layer of cells around z = 0, one cell thick.
//
//                        o  a particle: two in the layer, one half a cell above it and one below
//     . . . . . . .      .  the drawn edge, half a cell outside of the cells: margin cells (m) hold it, which move with the
//     . o-----o   .         cells beside them
//     m |  c  | m .      c  a cell of the body
//     . o-----o   .
//     . . . . . . .
//
// Nothing leads out of the plane: all contacts lie at z = 0, and distances are the same all through the layer. So impulses are the same
// above and below, and the kernels in fact solve the contact in two dimensions.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ppu/surfaces/contact_surface.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// The outline with which bodies of a model collide if their user has not said how they are drawn: make_skin_2d() with the model's contact
/// radius. A piece has its part of the whole.
Skin2d touching_skin(const SoftBodyModel<2>& model);

/// A cell beside a body into which the body's drawn edge reaches. It moves with the body's cell beside it.
struct MarginCell {
  std::uint32_t beside = 0;      ///< the body's cell; for one of the body's own cells: itself
  Eigen::Vector3f off{0, 0, 0};  ///< from that cell to this one, in cells
};

/// The layer of a model in two dimensions. Immutable.
class FlatLayer {
 public:
  /// @param skin  how bodies of the model are drawn, with outlines: these collide
  FlatLayer(const SoftBodyModel<2>& model, const Skin2d& skin);

  /// The body's cells come first, then margin cells. Particle i of the plane becomes particles 2 i below it and 2 i + 1 above. `fill` and
  /// `neighbours` are empty.
  const std::shared_ptr<const Lattice<3>>& lattice() const { return lattice_; }
  const ContactSurface& surface() const { return surface_; }
  /// kg, of each particle; 0 for particles that only margin cells have.
  std::span<const float> masses() const { return masses_; }
  std::span<const MarginCell> margin_cells() const { return margin_cells_; }  ///< of each cell
  std::size_t own_cells() const;  ///< how many of the cells are the body's: the first ones
  /// What crack_sides() returns for each cell; 0 for margin cells.
  std::span<const std::uint32_t> crack_sides() const { return crack_sides_; }

  /// Copies places or velocities in the plane to all particles of the layer; places get z = -half and z = +half.
  /// @param flat  of each particle in the plane  @param half  half a cell, metres; 0 for velocities
  void lift(std::span<const Eigen::Vector2f> flat, float half, std::vector<Eigen::Vector3f>& lifted) const;
  /// The velocity in the plane that corresponds to velocities of the layer. @param particle  in the plane
  static Eigen::Vector2f lower(std::span<const Eigen::Vector3f> lifted, std::size_t particle) {
    return 0.5f * (lifted[2 * particle] + lifted[2 * particle + 1]).head<2>();
  }

 private:
  class Maker;
  explicit FlatLayer(Maker maker);

  std::shared_ptr<const Lattice<3>> lattice_;
  ContactSurface surface_;
  std::vector<float> masses_;
  std::vector<MarginCell> margin_cells_;
  std::vector<std::uint32_t> crack_sides_;
  /// For each place that only margin cells have: it is the mean of these points.
  std::vector<CellPoint2d> beyond_;
  std::vector<std::uint32_t> first_beyond_{0};
};

}  // namespace softcell::ppu
