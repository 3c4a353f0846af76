#pragma once
// A body with random places, distances and faces, as the kernel `strain` reads them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>

#include "ppu/spe_bodies/job_records.h"
#include "softcell/dma/buffer.h"
#include "strain_job.h"

namespace softcell::test {

struct StrainedBody {
  struct Counts {
    std::uint32_t particles = 61;
    std::uint32_t edge_groups = 5, diagonal_groups = 7, face_groups = 9;
  };

  StrainedBody(dma::AddressSpace& memory, const Counts& counts, bool flat = false)
      : positions(memory, "positions", std::size_t{(counts.particles + 3) / 4} * (flat ? 8 : 16),
                  {.element_bytes = sizeof(float)}),
        lengths(memory, "lengths", std::max(1u, counts.edge_groups + counts.diagonal_groups),
                ppu::of_record(ppu::kStrainLengthsRecord)),
        faces(memory, "faces", std::max(1u, counts.face_groups), ppu::of_record(ppu::kStrainFacesRecord)),
        result(memory, "result", 1, ppu::of_record(ppu::kStrainResultRecord)),
        job(memory, "job", 1, ppu::of_record(ppu::kStrainJobRecord)) {
    const std::uint32_t width = flat ? 2 : 4;
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = i % width == 3 ? 0 : number(-3, 3);
    for (spu::StrainLengths& group : lengths.span())
      for (std::size_t k = 0; k < 4; ++k) {
        group.from[k] = particle(counts.particles);
        group.to[k] = particle(counts.particles);
        group.inverse_square[k] = number(0.02f, 0.1f);
      }
    for (spu::StrainFaces& group : faces.span())
      for (std::size_t face = 0; face < 4; ++face) {
        for (std::size_t k = 0; k < 4; ++k) {
          group.low[face][k] = particle(counts.particles);
          group.between[face][k] = particle(counts.particles);
          group.high[face][k] = particle(counts.particles);
        }
        group.strength[face] = number(0, 2);
      }
    result[0] = {-1, -1, ~0u, 7};
    job[0] = {.positions_ea = positions.ea().value,
              .lengths_ea = lengths.ea().value,
              .faces_ea = faces.ea().value,
              .result_ea = result.ea().value,
              .particles = counts.particles,
              .flat = flat ? 1u : 0u,
              .edge_groups = counts.edge_groups,
              .diagonal_groups = counts.diagonal_groups,
              .face_groups = counts.face_groups,
              .spacing = 0.6f,
              .stretch = 0.5f,
              .turn = 2,
              .pad = {}};
  }

  float number(float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(random_);
  }
  std::uint16_t particle(std::uint32_t particles) {
    return static_cast<std::uint16_t>(
        std::uniform_int_distribution<std::uint32_t>(0, particles - 1)(random_));
  }

 private:
  std::mt19937 random_{17};

 public:
  dma::Buffer<float> positions;
  dma::Buffer<spu::StrainLengths> lengths;
  dma::Buffer<spu::StrainFaces> faces;
  dma::Buffer<spu::StrainResult> result;
  dma::Buffer<spu::StrainJob> job;
};

}  // namespace softcell::test
