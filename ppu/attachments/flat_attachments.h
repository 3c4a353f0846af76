#pragma once
// Attachments in two dimensions among contacts of flat layers (flat_layer.h): both particles of a column get what the attachment does to
// the particle in the plane.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attachments.h"

namespace softcell::ppu {

/// Used by one thread. A coupling fills it before each substep.
class FlatAttachments final : public AttachmentSolver<3> {
 public:
  /// Removes all attachments and keeps the allocated room.
  void clear();
  /// The attachment's bodies and rigid body have their numbers of the substep.
  void add(const AttachmentInStep<2>& attachment);

  bool empty() const override { return in_plane_.empty(); }
  bool parts(std::uint32_t a, std::uint32_t b) const override { return in_plane_.parts(a, b); }
  void append_held(std::span<const ContactRigid> rigids, float step,
                   std::vector<HeldParticle<3>>& held) override;
  void press(std::uint32_t attachment, bool breaks) override { in_plane_.press(attachment, breaks); }
  void begin(std::span<const AttachedBody<3>> bodies, std::span<ContactRigid> rigids, float step) override;
  void iterate(int iterations) override;
  void finish() override;
  std::size_t solved() const override { return in_plane_.solved(); }
  AttachmentSides sides(std::size_t attachment) const override { return in_plane_.sides(attachment); }
  bool write(std::size_t attachment, AttachUnit& unit) const override {
    return in_plane_.write(attachment, unit);
  }
  void read(std::size_t attachment, const spu::AttachLink& link, std::span<const spu::AttachPoint> points,
            std::span<const spu::AttachRow> rows) override {
    in_plane_.read(attachment, link, points, rows);
  }
  void take_back_spin() override;

 private:
  /// A body of the substep in the plane: only its held particles are set.
  struct InPlane {
    std::vector<std::uint32_t> held;
    std::vector<Eigen::Vector2f> positions, velocities, pushes;
    std::vector<float> inverse_masses;
  };

  void hold(std::uint32_t body, std::span<const std::uint32_t> particles);
  static void begin(InPlane& plane, const AttachedBody<3>& body);
  void place_rigids(std::span<const ContactRigid> rigids);
  void lower();
  void raise() const;

  Attachments<2> in_plane_;
  std::vector<InPlane> planes_;  // for each body of the substep, or for the first ones
  std::vector<AttachedBody<2>> bodies_;
  std::vector<AttachedRigid2d> rigids_;
  std::vector<HeldParticle<2>> held_;
  std::span<const AttachedBody<3>> lifted_;  // of the substep
  std::span<ContactRigid> lifted_rigids_;
};

}  // namespace softcell::ppu
