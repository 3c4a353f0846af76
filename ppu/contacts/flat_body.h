#pragma once
// A body of two dimensions as contacts in three see it: a layer of cells around z = 0, one cell thick.
//
//     . . . . . . .      o  a particle: two of the layer, one half a cell above it and one below
//     .+-------+ .       .  the drawn edge, half a cell outside of the cells: margin cells (m) hold it, which move with the
//     m| o   o |m           cells beside them
//     .+-------+ .
//     . . . . . . .
//
// Nothing leads out of the plane: what touches lies at z = 0, and distances are the same all through the layer. So
// impulses are the same above and below, and what kernels solve is the contact in two dimensions.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// Of a model in two dimensions. Immutable.
class FlatModel {
 public:
  /// @param skin  how its bodies are drawn, with outlines: what touches. Of a model that make_soft_body_model() made, or of a piece
  FlatModel(const SoftBodyModel<2>& model, const Skin2d& skin);

  const ContactModel& contact() const { return contact_; }

  /// Places or velocities of all particles in the plane, as those of the layer's; places also lie `half` a cell above and below.
  /// @param flat  of each particle  @param half  metres; 0 for velocities
  void lift(std::span<const Eigen::Vector2f> flat, float half, std::vector<Eigen::Vector3f>& lifted) const;
  /// What a velocity of the layer is in the plane. @param particle  of the flat body
  static Eigen::Vector2f lower(std::span<const Eigen::Vector3f> lifted, std::size_t particle) {
    return 0.5f * (lifted[2 * particle] + lifted[2 * particle + 1]).head<2>();
  }

 private:
  class Maker;
  /// A place that goes on beyond a cell: shares of its corners.
  struct Beyond {
    std::array<std::uint32_t, 4> particle;
    std::array<float, 4> share;
  };
  explicit FlatModel(Maker maker);

  ContactModel contact_;
  /// Of each place that margin cells alone have: the mean of these.
  std::vector<Beyond> beyond_;
  std::vector<std::uint32_t> first_beyond_{0};
};

}  // namespace softcell::ppu
