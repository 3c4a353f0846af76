#include "body_samples.h"

#include <algorithm>
#include <string>
#include <vector>

#include "attach_samples.h"
#include "contact_samples.h"
#include "match_2d_job.h"
#include "match_job.h"
#include "ppu/lattice/embedding.h"
#include "ppu/plans/match_plan.h"
#include "ppu/plans/match_plan_2d.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/job_records.h"
#include "ppu/spe_bodies/strain_looks.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "skin_job.h"
#include "softcell/base/assert.h"
#include "softcell/dma/buffer.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::tool {
namespace {

constexpr dma::BufferOptions kFloats{.element_bytes = sizeof(float)};

void run_skin(SampleRun& sample) {
  // A sphere about the origin has normals and positions of every sign and size, zero and subnormal halves
  // among them.
  const ppu::TriangleMesh mesh = ppu::make_sphere(1, 20);
  const ppu::Lattice<3> lattice = ppu::voxelize(mesh, 0.25f);
  const ppu::Embedding embedding = ppu::embed(mesh, lattice);
  dma::Buffer<spu::SkinCorner> corners(sample.memory(), "corners", lattice.particles.size(), kFloats);
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    corners[i] = {x.x(), x.y(), x.z(), 0};
  }
  dma::Buffer<spu::SkinGroup> groups(sample.memory(), "groups", embedding.groups.size(),
                                     {.record = ppu::kSkinGroupRecord});
  std::copy(embedding.groups.begin(), embedding.groups.end(), groups.span().begin());
  const dma::Buffer<spu::SkinnedVertex> vertices(sample.memory(), "vertices", 4 * embedding.groups.size(),
                                                 {.element_bytes = 2});
  dma::Buffer<spu::SkinJob> job(sample.memory(), "job", 1, {.record = ppu::kSkinJobRecord});
  const auto skin = [&](float origin) {
    for (const ppu::SkinPart& part : embedding.parts) {
      job[0] = {};
      job[0].groups_ea = groups.ea(part.first_group).value;
      job[0].vertices_ea = vertices.ea(std::size_t{part.first_group} * 4).value;
      for (std::size_t w = 0; w < 2; ++w) {
        job[0].window[w].ea = corners.ea(part.window[w].first_particle).value;
        job[0].window[w].count = part.window[w].count;
      }
      SC_ASSERT(part.group_count > 0 && part.first_group + part.group_count <= embedding.groups.size(),
                "groups {} to {} of {}", part.first_group, part.first_group + part.group_count,
                embedding.groups.size());
      job[0].group_count = part.group_count;
      std::fill_n(job[0].origin, 3, origin);
      sample.run(job.ea(), std::size_t{part.group_count} * 4);
    }
  };
  skin(0);
  sample.begin_timing();
  skin(-1.5f);  // below the body, as the skinners choose it
}

/// A block of 1,000 particles.
ppu::Lattice<3> block() { return ppu::voxelize(ppu::make_box({0.899f, 0.899f, 0.899f}, 1), 0.1f); }

/// The position of a particle when the block is a little bent.
Eigen::Vector3f bent(const Eigen::Vector3f& x) {
  return {x.x() + 0.05f * x.y() * x.y(), x.y() - 0.03f * x.z(), x.z() + 0.02f * x.x() * x.y()};
}

/// One SPE's share of a step of one body, in the form that MatchBodies makes.
void run_match(SampleRun& sample) {
  const ppu::Lattice<3> lattice = block();
  const std::size_t particles = lattice.particles.size();
  const ppu::MatchPlan plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)});
  dma::Buffer<std::byte> plan_bytes(sample.memory(), "plan", plan.bytes().size(), {.record = plan.record()});
  std::copy(plan.bytes().begin(), plan.bytes().end(), plan_bytes.span().begin());
  dma::Buffer<spu::SkinCorner> positions(sample.memory(), "positions", particles, kFloats);
  for (std::size_t i = 0; i < particles; ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    positions[i] = {-x.x(), x.y(), x.z(), 0};
  }
  dma::Buffer<std::byte> state(sample.memory(), "state", spu::match_state_bytes(plan.header()), kFloats);
  dma::Buffer<spu::MatchBody> body(sample.memory(), "body", 1, {.record = ppu::kMatchBodyRecord});
  body[0] = {positions.ea().value, state.ea().value};
  dma::Buffer<spu::MatchJob> job(sample.memory(), "job", 1, {.record = ppu::kMatchJobRecord});
  job[0].plan_ea = plan_bytes.ea().value;
  job[0].bodies_ea = body.ea().value;
  job[0].body_count = 1;
  job[0].pull = 30;
  job[0].damping = 0.1f;
  job[0].most_iterations = 6;
  // First with unknown rotations, then with those of the last step: these are the deepest paths through the kernel.
  const auto step = [&](bool is_cold) {
    SC_ASSERT(state.size_bytes() >= sizeof(spu::MatchResult), "a state of {} bytes has no room for a result",
              state.size_bytes());
    reinterpret_cast<spu::MatchResult*>(state.data())->cold = is_cold ? 1 : 0;
    sample.run(job.ea(), particles);
  };
  step(true);
  step(false);
  // Then with the body moved as from one step to the next.
  for (std::size_t i = 0; i < particles; ++i) {
    const Eigen::Vector3f x = bent(lattice.rest_position(i));
    positions[i] = {x.x(), x.y(), x.z(), 0};
  }
  step(true);
  sample.begin_timing();
  step(false);
}

/// A step of three bodies, in the form that MatchBodies makes.
void run_match_2d(SampleRun& sample) {
  constexpr std::uint32_t kBodiesOfJob = 3;
  const std::vector<std::string> rows(9, "#########");
  const ppu::Lattice<2> lattice = ppu::lattice_from_cells(ppu::cells_from_rows(rows), 0.5f);
  const ppu::MatchPlan2d plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)});
  dma::Buffer<std::byte> plan_bytes(sample.memory(), "plan", plan.bytes().size(), {.record = plan.record()});
  std::copy(plan.bytes().begin(), plan.bytes().end(), plan_bytes.span().begin());
  const std::size_t stride = spu::match_2d_positions_stride(plan.header()) / sizeof(spu::MatchVector2d);
  SC_ASSERT(stride >= lattice.particles.size(), "bodies of {} particles, {} apart", lattice.particles.size(),
            stride);
  dma::Buffer<spu::MatchVector2d> positions(sample.memory(), "positions", kBodiesOfJob * stride, kFloats);
  for (std::size_t body = 0; body < kBodiesOfJob; ++body)
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      positions[body * stride + i] = {-lattice.rest_position(i).x(), lattice.rest_position(i).y()};
  const dma::Buffer<std::byte> states(sample.memory(), "states",
                                      kBodiesOfJob * spu::match_2d_state_stride(plan.header()), kFloats);
  dma::Buffer<spu::MatchJob2d> job(sample.memory(), "job", 1, {.record = ppu::kMatchJob2dRecord});
  job[0] = {plan_bytes.ea().value, positions.ea().value, states.ea().value, kBodiesOfJob, 30, 0.1f, {}};
  sample.run(job.ea(), kBodiesOfJob * lattice.particles.size());
}

/// All passes over a body in tiles, first with unknown rotations and then with those of the last step.
void run_match_tiles(SampleRun& sample) {
  const ppu::Lattice<3> lattice = block();
  const ppu::TilePlan plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)},
                           {.planes = 5, .rows = 10});
  ppu::TiledMemory body(sample.memory(), plan);
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    body.positions()[plan.place_of()[i]] = {-x.x(), x.y(), x.z(), 0};
  }
  const auto step = [&] {
    body.begin_step({.pull = 30, .damping = 0.1f});
    for (const spu::TilePass pass : ppu::kTilePasses)
      for (std::size_t tile = 0; tile < body.tiles(); ++tile)
        if (const auto job = body.job(pass, tile)) sample.run(*job, 0);
    body.end_step();
  };
  step();
  step();
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = bent(lattice.rest_position(i));
    body.positions()[plan.place_of()[i]] = {x.x(), x.y(), x.z(), 0};
  }
  step();
  sample.begin_timing();
  step();
  sample.worked(lattice.particles.size());
}

/// A body that may break, and one that is tested for yielding.
void run_strain(SampleRun& sample) {
  ppu::SoftBodySettings glass{.cell_size = 0.1f, .half_width = 2}, tin = glass;
  glass.fracture = ppu::Fracture{.stretch = 0.3f, .turn = 0.8f};
  tin.plasticity = ppu::Plasticity{.yield = 0.1f};
  ppu::SoftBody<3> brittle(ppu::make_soft_body_model(block(), glass)),
      plastic(ppu::make_soft_body_model(block(), tin));
  while (!plastic.will_look()) plastic.flow(1.0f / 120);
  const std::size_t particles = brittle.positions().size();
  dma::Buffer<spu::SkinCorner> positions(sample.memory(), "positions", particles, kFloats);
  for (std::size_t i = 0; i < particles; ++i) {
    const Eigen::Vector3f x = bent(brittle.model().lattice().rest_position(i));
    positions[i] = {x.x(), x.y(), x.z(), 0};
  }
  const auto look_at = [&](const ppu::SoftBody<3>& body) {
    ppu::StrainLooks<3> looks(sample.memory(), body.shared_model(), {}, particles, 1);
    looks.job(0, body, positions.ea());  // the distances in the rest shape are only there at the second call
    const auto job = looks.job(0, body, positions.ea());
    SC_ASSERT(job.has_value(), "nothing to look for in a body of {} particles", particles);
    sample.run(*job, particles);
  };
  look_at(plastic);
  sample.begin_timing();
  look_at(brittle);
}

}  // namespace

std::span<const KernelSample> body_samples() {
  static constexpr KernelSample kSamples[] = {
      {"attach", "particle", run_attach},
      {"contact_find", "pair of bodies", run_contact_find},
      {"contact_solve", "contact", run_contact_solve},
      {"match", "particle", run_match},
      {"match_2d", "particle", run_match_2d},
      {"match_tiles", "particle", run_match_tiles},
      {"skin", "vertex", run_skin},
      {"strain", "particle", run_strain},
  };
  return kSamples;
}

}  // namespace softcell::tool
