#pragma once
// Skinning one vertex after the other in plain C++. In double precision it is the oracle of the kernel
// `skin`; in float it is what the kernel is measured against. trilinear.h has the equations.

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "ppu/lattice/embedding.h"
#include "skin_job.h"

namespace softcell::ppu {

/// One vertex evaluated in double precision straight from the equations: the oracle for the kernel.
/// x = sum N_k x_k; n = normalize(cof(F) N) with F the deformation gradient, N the rest normal where that
/// vanishes.
struct ReferenceVertex {
  Eigen::Vector3d position, normal;
};
ReferenceVertex evaluate_reference(const Embedding& embedding, const SkinPart& part, std::uint32_t group,
                                   int lane, std::span<const Eigen::Vector3f> particle_positions);

/// Evaluates every slot of a part in float: x = sum N_k x_k, n = normalize(cof(F) N), as evaluate_reference()
/// does in double.
/// @param positions  of the body's particles, metres
/// @param origin     subtracted from every position before it is rounded to binary16
/// @param out        4 * part.group_count vertices, slot 4 * part.first_group first
void skin_scalar(const Embedding& embedding, const SkinPart& part, std::span<const Eigen::Vector3f> positions,
                 const Eigen::Vector3f& origin, std::span<spu::SkinnedVertex> out);

}  // namespace softcell::ppu
