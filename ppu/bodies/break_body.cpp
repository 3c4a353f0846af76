#include "ppu/bodies/break_body.h"

#include <Eigen/Geometry>
#include <stdexcept>
#include <utility>

#include "ppu/bodies/piece_model.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

template <int kDimension>
std::vector<Eigen::Vector<float, kDimension>> own_rest_of(const SoftBody<kDimension>& body) {
  if (!body.has_own_rest()) return {};
  return body.rest_positions();
}

template <int kDimension>
std::span<const std::uint32_t> strained_faces(const SoftBody<kDimension>& body, BreakTest<kDimension>& test) {
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

std::vector<std::uint32_t> faces_across(const SoftBody<2>& body, const Cut2d& cut) {
  if (!cut.from.allFinite() || !cut.way.allFinite() || !(cut.way.cast<double>().norm() > 0))
    throw std::invalid_argument("a soft body is cut along a line that is not finite or has no length");
  return faces_across(body.model().lattice(), body.model().cracks(), body.positions(), cut.from, cut.way,
                      !cut.has_end);
}

template <int kDimension>
std::vector<PlannedPiece<kDimension>> plan_pieces(
    const std::shared_ptr<const SoftBodyModel<kDimension>>& model, std::span<const std::uint32_t> faces) {
  SC_ASSERT(model != nullptr, "{} faces of no body break", faces.size());
  std::vector<PlannedPiece<kDimension>> planned;
  for (CrackedPiece<kDimension>& piece : break_faces(model->lattice(), model->cracks(), faces)) {
    std::vector<std::uint32_t> particle_of = std::move(piece.part.particle_of);
    planned.push_back({make_piece_model(model, std::move(piece)), std::move(particle_of)});
  }
  return planned;
}

template <int kDimension>
void take_part(SoftBody<kDimension>& piece, const SoftBody<kDimension>& whole,
               const std::vector<Eigen::Vector<float, kDimension>>& rest,
               std::span<const std::uint32_t> particle_of) {
  SC_ASSERT(piece.positions().size() == particle_of.size(), "{} particles of a piece of {}",
            particle_of.size(), piece.positions().size());
  piece.set_material(whole.settings());
  for (std::size_t i = 0; i < particle_of.size(); ++i)
    piece.set_particle(i, whole.position(particle_of[i]), whole.velocities()[particle_of[i]]);
  if (rest.empty()) return;
  std::vector<Eigen::Vector<float, kDimension>> own_rest;
  for (const std::uint32_t particle : particle_of) own_rest.push_back(rest[particle]);
  piece.set_rest_positions(own_rest);
}

template <int kDimension>
std::vector<BodyPiece<kDimension>> pieces_of(const SoftBody<kDimension>& body,
                                             std::span<const std::uint32_t> faces) {
  std::vector<BodyPiece<kDimension>> pieces;
  const auto rest = own_rest_of(body);
  for (PlannedPiece<kDimension>& planned : plan_pieces(body.shared_model(), faces)) {
    pieces.push_back({SoftBody<kDimension>(planned.model), std::move(planned.particle_of)});
    BodyPiece<kDimension>& piece = pieces.back();
    take_part(piece.body, body, rest, piece.particle_of);
  }
  return pieces;
}

namespace {

template <int kDimension>
std::vector<SoftBody<kDimension>> break_into_pieces(SoftBody<kDimension>& body,
                                                    std::span<const std::uint32_t> faces) {
  std::vector<SoftBody<kDimension>> others;
  if (faces.empty()) return others;
  std::vector<BodyPiece<kDimension>> pieces = pieces_of(body, faces);
  for (std::size_t i = 1; i < pieces.size(); ++i) others.push_back(std::move(pieces[i].body));
  body = pieces.front().body;
  return others;
}

template <int kDimension>
std::vector<SoftBody<kDimension>> break_strained(SoftBody<kDimension>& body) {
  if (!body.settings().fracture) return {};
  BreakTest<kDimension> test;
  return break_into_pieces(body, strained_faces(body, test));
}

}  // namespace

Cut Cut::plane(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f along = normal.unitOrthogonal();
  return {.corner = point, .along = along, .across = normal.cross(along), .has_end = false};
}

std::vector<SoftBody<3>> break_where_strained(SoftBody<3>& body) { return break_strained(body); }
std::vector<SoftBody<2>> break_where_strained(SoftBody<2>& body) { return break_strained(body); }

std::vector<SoftBody<3>> cut(SoftBody<3>& body, const Cut& where) {
  return break_into_pieces(body, faces_across(body, where));
}
std::vector<SoftBody<2>> cut(SoftBody<2>& body, const Cut2d& where) {
  return break_into_pieces(body, faces_across(body, where));
}

#define SOFTCELL_INSTANTIATE(D)                                                                          \
  template std::vector<Eigen::Vector<float, D>> own_rest_of(const SoftBody<D>&);                         \
  template std::span<const std::uint32_t> strained_faces(const SoftBody<D>&, BreakTest<D>&);             \
  template std::vector<PlannedPiece<D>> plan_pieces(const std::shared_ptr<const SoftBodyModel<D>>&,      \
                                                    std::span<const std::uint32_t>);                     \
  template void take_part(SoftBody<D>&, const SoftBody<D>&, const std::vector<Eigen::Vector<float, D>>&, \
                          std::span<const std::uint32_t>);                                               \
  template std::vector<BodyPiece<D>> pieces_of(const SoftBody<D>&, std::span<const std::uint32_t>)
SOFTCELL_INSTANTIATE(2);
SOFTCELL_INSTANTIATE(3);
#undef SOFTCELL_INSTANTIATE

}  // namespace softcell::ppu
