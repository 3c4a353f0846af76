#include "body_samples.h"

#include <algorithm>
#include <string>
#include <vector>

#include "contact_samples.h"
#include "match_2d_job.h"
#include "match_job.h"
#include "ppu/lattice/embedding.h"
#include "ppu/plans/match_plan.h"
#include "ppu/plans/match_plan_2d.h"
#include "ppu/reference/shape_matching.h"
#include "ppu/spe_bodies/job_records.h"
#include "ppu/spe_bodies/tiled_memory.h"
#include "skin_job.h"
#include "softcell/base/assert.h"
#include "softcell/dma/buffer.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/shapes.h"

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
    sample.run(job.ea());
  }
}

/// One SPE's share of a step of one body, as MatchBodies makes it.
void run_match(SampleRun& sample) {
  const ppu::Lattice<3> lattice = ppu::voxelize(ppu::make_sphere(1, 20), 0.5f);
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
  // Rotations from nothing, then from the last step: the deepest ways through the kernel.
  for (const std::uint32_t cold : {1u, 0u}) {
    SC_ASSERT(state.size_bytes() >= sizeof(spu::MatchResult), "a state of {} bytes has no room for a result",
              state.size_bytes());
    reinterpret_cast<spu::MatchResult*>(state.data())->cold = cold;
    sample.run(job.ea());
  }
}

/// A step of three bodies, as MatchBodies makes it.
void run_match_2d(SampleRun& sample) {
  constexpr std::uint32_t kBodies = 3;
  const std::vector<std::string> rows(9, "#########");
  const ppu::Lattice<2> lattice = ppu::lattice_from_cells(ppu::cells_from_rows(rows), 0.5f);
  const ppu::MatchPlan2d plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)});
  dma::Buffer<std::byte> plan_bytes(sample.memory(), "plan", plan.bytes().size(), {.record = plan.record()});
  std::copy(plan.bytes().begin(), plan.bytes().end(), plan_bytes.span().begin());
  const std::size_t stride = spu::match_2d_positions_stride(plan.header()) / sizeof(spu::MatchVector2d);
  SC_ASSERT(stride >= lattice.particles.size(), "bodies of {} particles, {} apart", lattice.particles.size(),
            stride);
  dma::Buffer<spu::MatchVector2d> positions(sample.memory(), "positions", kBodies * stride, kFloats);
  for (std::size_t body = 0; body < kBodies; ++body)
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      positions[body * stride + i] = {-lattice.rest_position(i).x(), lattice.rest_position(i).y()};
  const dma::Buffer<std::byte> states(sample.memory(), "states",
                                      kBodies * spu::match_2d_state_stride(plan.header()), kFloats);
  dma::Buffer<spu::MatchJob2d> job(sample.memory(), "job", 1, {.record = ppu::kMatchJob2dRecord});
  job[0] = {plan_bytes.ea().value, positions.ea().value, states.ea().value, kBodies, 30, 0.1f, {}};
  sample.run(job.ea());
}

/// All passes over a body in tiles, rotations from nothing and then from the last step.
void run_match_tiles(SampleRun& sample) {
  const ppu::Lattice<3> lattice = ppu::voxelize(ppu::make_sphere(1, 20), 0.5f);
  const ppu::TilePlan plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)},
                           {.planes = 3, .rows = 3});
  ppu::TiledMemory body(sample.memory(), plan);
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    body.positions()[plan.place_of()[i]] = {-x.x(), x.y(), x.z(), 0};
  }
  for (int step = 0; step < 2; ++step) {
    body.begin_step({.pull = 30, .damping = 0.1f});
    for (const spu::TilePass pass : ppu::kTilePasses)
      for (std::size_t tile = 0; tile < body.tiles(); ++tile)
        if (const auto job = body.job(pass, tile)) sample.run(*job);
    body.end_step();
  }
}

}  // namespace

std::span<const KernelSample> body_samples() {
  static constexpr KernelSample kSamples[] = {
      {"contact_find", run_contact_find}, {"contact_solve", run_contact_solve}, {"match", run_match},
      {"match_2d", run_match_2d},         {"match_tiles", run_match_tiles},     {"skin", run_skin}};
  return kSamples;
}

}  // namespace softcell::tool
