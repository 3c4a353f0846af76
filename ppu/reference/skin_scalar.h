#pragma once
// Skinning one vertex after the other in plain C++: what the kernel `skin` is measured against, and a second
// opinion on it.

#include <Eigen/Core>
#include <span>

#include "ppu/lattice/embedding.h"
#include "skin_job.h"

namespace softcell::ppu {

/// Evaluates every slot of a part in float: x = sum N_k x_k, n = normalize(cof(F) N), as evaluate_reference()
/// does in double.
/// @param positions  of the body's particles, metres
/// @param origin     subtracted from every position before it is rounded to binary16
/// @param out        4 * part.group_count vertices, slot 4 * part.first_group first
void skin_scalar(const Embedding& embedding, const SkinPart& part, std::span<const Eigen::Vector3f> positions,
                 const Eigen::Vector3f& origin, std::span<spu::SkinnedVertex> out);

}  // namespace softcell::ppu
