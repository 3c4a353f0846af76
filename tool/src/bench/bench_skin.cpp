// Skinning on an SPE, compared with its scalar twin.

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "ppu/reference/skin_scalar.h"
#include "ppu/spe_bodies/skin_orchestrator.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/shapes.h"
#include "spe_waker.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kSkinnedBodies = 8;  // in one frame, so that the time to wake the SPE is negligible

/// A body in bent poses, so that nothing is a special case. It moves, because a body that is where it was two frames before is not skinned
/// again.
struct SkinCase {
  static constexpr std::size_t kPoses = 3;  // used in turn

  SkinCase(const ppu::TriangleMesh& body_mesh, float cell_size)
      : lattice(ppu::voxelize(body_mesh, cell_size)),
        embedding(std::make_shared<ppu::Embedding>(ppu::embed(body_mesh, lattice))),
        kernel(load_kernel("skin")),
        job_loop(load_kernel("job_loop")),
        jobs(memory, {.spes = 1}, job_loop),
        waker(jobs),
        orchestrator(memory, jobs, kernel),
        scalar_out(kSkinnedBodies, std::vector<spu::SkinnedVertex>(4 * embedding->groups.size())) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      Eigen::Vector3f x = lattice.rest_position(i);
      x.x() += 0.1f * x.y() * x.y();
      x.z() += 0.05f * x.x() * x.y();
      positions.push_back(x);
      for (std::size_t pose = 0; pose < kPoses; ++pose)
        corners[pose].push_back({x.x() + 0.001f * static_cast<float>(pose), x.y(), x.z(), 0});
    }
    SC_ASSERT(corners[0].size() == positions.size() && !positions.empty(), "{} corners at {} places",
              corners[0].size(), positions.size());
    for (std::size_t body = 0; body < kSkinnedBodies; ++body) {
      orchestrator.add(embedding, positions.size());
      for (std::size_t pose = 0; pose < kPoses; ++pose) all_corners[pose].push_back(corners[pose]);
    }
  }

  void run_spe() {
    const bool has_begun = orchestrator.kick(all_corners[frame++ % kPoses]);
    SC_ASSERT(has_begun, "{} bodies are skinned while the frame before is", kSkinnedBodies);
    orchestrator.drain();
  }

  void run_scalar() {
    const Eigen::Vector3f origin(-2, -2, -2);
    for (auto& out : scalar_out) {
      for (const ppu::SkinPart& part : embedding->parts) {
        SC_ASSERT(4 * (std::size_t{part.first_group} + part.group_count) <= out.size(),
                  "groups {} to {} in {} vertices", part.first_group, part.first_group + part.group_count,
                  out.size());
        ppu::skin_scalar(
            *embedding, part, positions, origin,
            std::span(out).subspan(4 * std::size_t{part.first_group}, 4 * std::size_t{part.group_count}));
      }
    }
  }

  ppu::Lattice<3> lattice;
  std::shared_ptr<ppu::Embedding> embedding;
  dma::AddressSpace memory;
  ls_sim::KernelImage kernel, job_loop;
  ppu::JobSystem jobs;
  SpeWaker waker;
  ppu::SkinOrchestrator orchestrator;
  std::vector<Eigen::Vector3f> positions;
  std::array<std::vector<Eigen::Vector4f>, kPoses> corners;
  std::array<std::vector<std::span<const Eigen::Vector4f>>, kPoses> all_corners;  // one for each body
  std::size_t frame = 0;
  std::vector<std::vector<spu::SkinnedVertex>> scalar_out;  // of each body
};

void add_skin(std::vector<Benchmark>& all, const std::string& name,
              std::function<std::shared_ptr<SkinCase>()> make) {
  const Shared<SkinCase> shared(std::move(make));
  const auto add = [&](const char* how, auto run, bool on_spes = false) {
    all.push_back({"skin/" + name + "/" + how, [=] {
                     const auto rig = shared.get();
                     Work work{kSkinnedBodies * rig->embedding->slot_of_vertex.size(), [=] { run(*rig); }};
                     if (on_spes) work.before = [=] { rig->waker.wake(); };
                     return work;
                   }});
  };
  add(
      "spe", [](SkinCase& rig) { rig.run_spe(); }, true);
  add("scalar", [](SkinCase& rig) { rig.run_scalar(); });
}

}  // namespace

void add_skin_benchmarks(std::vector<Benchmark>& all) {
  add_skin(all, "sphere", [] { return std::make_shared<SkinCase>(ppu::make_sphere(0.7f, 48), 0.28f); });
  add_skin(all, "torus",
           [] { return std::make_shared<SkinCase>(ppu::make_torus(0.72f, 0.28f, 192, 80), 0.2f); });
}

}  // namespace softcell::tool
