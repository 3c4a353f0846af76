#include "ppu/bodies/break_body.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include <utility>

#include "ppu/bodies/piece_model.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

std::vector<Eigen::Vector3f> own_rest_of(const SoftBody<3>& body) {
  if (!body.has_own_rest()) return {};
  return body.rest_positions();
}

std::span<const std::uint32_t> strained_faces(const SoftBody<3>& body, BreakTest& test) {
  SC_ASSERT(body.settings().fracture.has_value(), "a body of {} particles that does not break is tested",
            body.positions().size());
  return test.find(body.model().lattice(), body.model().cracks(), body.positions(), own_rest_of(body),
                   *body.settings().fracture);
}

std::vector<std::uint32_t> faces_across(const SoftBody<3>& body, const Cut& cut) {
  if (!cut.corner.allFinite() || !cut.along.allFinite() || !cut.across.allFinite() ||
      !(cut.along.cast<double>().cross(cut.across.cast<double>()).norm() > 0))
    throw std::invalid_argument("a soft body is cut along a parallelogram that is not finite or has no area");
  return faces_across(body.model().lattice(), body.model().cracks(), body.positions(), cut.corner, cut.along,
                      cut.across, !cut.has_end);
}

std::vector<PlannedPiece> plan_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                                      std::span<const std::uint32_t> faces) {
  SC_ASSERT(model != nullptr, "{} faces of no body break", faces.size());
  std::vector<PlannedPiece> planned;
  for (CrackedPiece& piece : break_faces(model->lattice(), model->cracks(), faces)) {
    std::vector<std::uint32_t> particle_of = std::move(piece.part.particle_of);
    planned.push_back({make_piece_model(model, std::move(piece)), std::move(particle_of)});
  }
  return planned;
}

void take_part(SoftBody<3>& piece, const SoftBody<3>& whole, std::span<const Eigen::Vector3f> rest,
               std::span<const std::uint32_t> particle_of) {
  SC_ASSERT(piece.positions().size() == particle_of.size(), "{} particles of a piece of {}",
            particle_of.size(), piece.positions().size());
  piece.set_material(whole.settings());
  for (std::size_t i = 0; i < particle_of.size(); ++i)
    piece.set_particle(i, whole.position(particle_of[i]), whole.velocities()[particle_of[i]]);
  if (rest.empty()) return;
  std::vector<Eigen::Vector3f> own_rest;
  for (const std::uint32_t particle : particle_of) own_rest.push_back(rest[particle]);
  piece.set_rest_positions(own_rest);
}

std::vector<BodyPiece> pieces_of(const SoftBody<3>& body, std::span<const std::uint32_t> faces) {
  std::vector<BodyPiece> pieces;
  const std::vector<Eigen::Vector3f> rest = own_rest_of(body);
  for (PlannedPiece& planned : plan_pieces(body.shared_model(), faces)) {
    pieces.push_back({SoftBody<3>(planned.model), std::move(planned.particle_of)});
    BodyPiece& piece = pieces.back();
    take_part(piece.body, body, rest, piece.particle_of);
  }
  return pieces;
}

namespace {

std::vector<SoftBody<3>> break_into_pieces(SoftBody<3>& body, std::span<const std::uint32_t> faces) {
  std::vector<SoftBody<3>> others;
  if (faces.empty()) return others;
  std::vector<BodyPiece> pieces = pieces_of(body, faces);
  for (std::size_t i = 1; i < pieces.size(); ++i) others.push_back(std::move(pieces[i].body));
  body = pieces.front().body;
  return others;
}

}  // namespace

Cut Cut::plane(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f along = normal.unitOrthogonal();
  return {.corner = point, .along = along, .across = normal.cross(along), .has_end = false};
}

std::vector<SoftBody<3>> break_where_strained(SoftBody<3>& body) {
  if (!body.settings().fracture) return {};
  BreakTest test;
  return break_into_pieces(body, strained_faces(body, test));
}

std::vector<SoftBody<3>> cut(SoftBody<3>& body, const Cut& where) {
  return break_into_pieces(body, faces_across(body, where));
}

}  // namespace softcell::ppu
