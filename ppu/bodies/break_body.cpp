#include "ppu/bodies/break_body.h"

#include <Eigen/Geometry>
#include <optional>
#include <stdexcept>
#include <utility>

#include "ppu/bodies/piece_model.h"
#include "ppu/matching/matching_plan.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

template <int kDimension>
std::span<const std::uint32_t> strained_faces(const SoftBody<kDimension>& body, BreakTest<kDimension>& test) {
  SC_ASSERT(body.settings().fracture.has_value(), "a body of {} particles that does not break is tested",
            body.positions().size());
  return test.find(body.model().lattice(), body.model().cracks(), body.positions(), body.own_rest(),
                   *body.settings().fracture);
}

std::vector<std::uint32_t> faces_across(const SoftBody<3>& body, const Cut& cut) {
  if (!cut.corner.allFinite() || !cut.along.allFinite() || !cut.across.allFinite() ||
      !(cut.along.cast<double>().cross(cut.across.cast<double>()).norm() > 0))
    throw std::invalid_argument("a cut's plane or parallelogram is not finite or has no area");
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
std::uint32_t least_cells_of(const SoftBody<kDimension>& body) {
  const std::optional<Fracture>& fracture = body.settings().fracture;
  return fracture ? fracture->least_cells : Fracture{}.least_cells;
}

template <int kDimension>
PlannedPieces<kDimension> plan_pieces(const std::shared_ptr<const SoftBodyModel<kDimension>>& model,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells) {
  SC_ASSERT(model != nullptr, "{} faces of no body break", faces.size());
  CrackedPieces<kDimension> cracked = break_faces(model->lattice(), model->cracks(), faces, least_cells);
  PlannedPieces<kDimension> planned{.stay = {}, .vanished = std::move(cracked.vanished)};
  for (CrackedPiece<kDimension>& piece : cracked.stay) {
    std::vector<std::uint32_t> particle_of = std::move(piece.part.particle_of);
    planned.stay.push_back(
        {SoftBody<kDimension>(make_piece_model(model, std::move(piece))), std::move(particle_of)});
  }
  return planned;
}

template <int kDimension>
std::vector<BodyPiece<kDimension>> pieces_of(const SoftBody<kDimension>& body,
                                             std::span<const std::uint32_t> faces) {
  std::vector<BodyPiece<kDimension>> pieces =
      plan_pieces(body.shared_model(), faces, least_cells_of(body)).stay;
  const auto centre = body.precise_centre_of_mass();
  for (BodyPiece<kDimension>& piece : pieces) piece.body.inherit_state(body, piece.particle_of, centre);
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
  body = std::move(pieces.front().body);
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

#define SOFTCELL_INSTANTIATE(D)                                                              \
  template std::span<const std::uint32_t> strained_faces(const SoftBody<D>&, BreakTest<D>&); \
  template std::uint32_t least_cells_of(const SoftBody<D>&);                                 \
  template PlannedPieces<D> plan_pieces(const std::shared_ptr<const SoftBodyModel<D>>&,      \
                                        std::span<const std::uint32_t>, std::uint32_t);      \
  template std::vector<BodyPiece<D>> pieces_of(const SoftBody<D>&, std::span<const std::uint32_t>)
SOFTCELL_INSTANTIATE(2);
SOFTCELL_INSTANTIATE(3);
#undef SOFTCELL_INSTANTIATE

}  // namespace softcell::ppu
