#include "ppu/reference/skin_scalar.h"

#include <array>

#include "ppu/numbers/half.h"
#include "ppu/reference/skin_slots.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

ReferenceVertex evaluate_reference(const Embedding& embedding, const SkinPart& part, std::uint32_t group,
                                   int lane, std::span<const Eigen::Vector3f> particle_positions) {
  SC_ASSERT(group < embedding.groups.size() && lane >= 0 && lane < 4, "vertex {} of group {} of {}", lane,
            group, embedding.groups.size());
  const spu::SkinGroup& g = embedding.groups[group];
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t k = 0; k < 8; ++k)
    corners[k] = particle_positions[part.particle(g.corner[k])].cast<double>();
  const auto point =
      evaluate_trilinear<double>({g.xi[lane], g.eta[lane], g.zeta[lane]},
                                 {g.normal_x[lane], g.normal_y[lane], g.normal_z[lane]}, corners);
  return {point.position, point.normal};
}

void skin_scalar(const Embedding& embedding, const SkinPart& part, std::span<const Eigen::Vector3f> positions,
                 const Eigen::Vector3f& origin, std::span<spu::SkinnedVertex> out) {
  SC_ASSERT(out.size() == 4 * std::size_t{part.group_count}, "{} vertices for {} groups of four", out.size(),
            part.group_count);
  for_each_slot(
      embedding, part,
      [&](std::uint32_t particle) -> Eigen::Vector3f { return positions[particle] - origin; },
      [&](std::uint32_t slot, const SurfacePoint<float>& point) {
        spu::SkinnedVertex& vertex = out[slot - 4 * part.first_group];
        for (int d = 0; d < 3; ++d) {
          vertex.position[d] = half_from_float(point.position[d]);
          vertex.normal[d] = half_from_float(point.normal[d]);
        }
        vertex.position[3] = half_from_float(1.0f);
        vertex.normal[3] = half_from_float(0.0f);
      });
}

}  // namespace softcell::ppu
