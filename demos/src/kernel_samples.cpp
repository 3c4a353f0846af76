#include "kernel_samples.h"

#include <algorithm>
#include <stdexcept>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/spe_pool.h"
#include "softcell/ppu/lattice.h"
#include "softcell/ppu/match_orchestrator.h"
#include "softcell/ppu/shape_matching.h"
#include "softcell/ppu/shapes.h"
#include "softcell/ppu/skin_orchestrator.h"
#include "softcell/spu_kernels/images.h"
#include "transfers_job.h"

namespace softcell::demos {
namespace {

void run_skin_sample(const ls_sim::KernelImage& kernel, dma::AddressSpace& memory, ls_sim::SpePool& pool) {
  // A sphere about the origin has normals and positions of every sign and size, zero and subnormal halves
  // among them.
  const ppu::TriangleMesh mesh = ppu::make_sphere(1, 20);
  const ppu::Lattice lattice = ppu::voxelize(mesh, 0.25f);
  const auto embedding = std::make_shared<ppu::Embedding>(ppu::embed(mesh, lattice));
  std::vector<spu::SkinCorner> corners;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    corners.push_back({x.x(), x.y(), x.z(), 0});
  }
  ppu::SkinOrchestrator orchestrator(memory, pool, kernel);
  orchestrator.add(embedding, corners.size());
  const std::span<const spu::SkinCorner> positions(corners);
  orchestrator.kick({&positions, 1});
  orchestrator.drain();
}

void run_match_sample(const ls_sim::KernelImage& kernel, dma::AddressSpace& memory, ls_sim::SpePool& pool) {
  // Rotations from nothing, then from the last step: the deepest ways through the kernel.
  const ppu::Lattice lattice = ppu::voxelize(ppu::make_sphere(1, 20), 0.5f);
  const ppu::MatchingPlan<float> matching(lattice, 2, ppu::particle_masses(lattice, 1000));
  ppu::MatchOrchestrator orchestrator(memory, pool, kernel, ppu::MatchPlan(lattice, matching), 1);
  for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
    const Eigen::Vector3f x = lattice.rest_position(i);
    orchestrator.positions(0)[i] = {-x.x(), x.y(), x.z(), 0};
  }
  orchestrator.step({.pull = 30, .damping = 0.1f});
  orchestrator.step({.pull = 30, .damping = 0.1f});
}

void run_transfers_sample(const ls_sim::KernelImage& kernel, dma::AddressSpace& memory,
                          ls_sim::SpePool& pool) {
  dma::Buffer<std::byte> data(memory, "data", 1024);
  dma::Buffer<spu::TransfersJob> descriptor(memory, "job", 1);
  descriptor.span()[0] = {data.ea().value, 128, 16, 8, spu::kTransferGet, {}};
  const ls_sim::Job job{&kernel, descriptor.ea(), {}};
  ls_sim::JobBatch batch;
  pool.submit(batch, {&job, 1});
  batch.wait();
  if (!batch.failures().empty()) throw std::runtime_error(batch.failures().front().message);
}

}  // namespace

std::vector<ls_sim::KernelImage> load_kernels() {
  std::vector<ls_sim::KernelImage> kernels;
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files())
    kernels.push_back(ls_sim::load_image(file.name, file.elf));
  std::sort(kernels.begin(), kernels.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return kernels;
}

ls_sim::KernelImage load_kernel(std::string_view name, bool checked) {
  for (const spu_kernels::ImageFile& file : spu_kernels::image_files()) {
    if (file.name != name) continue;
    if (checked && file.checked_elf.empty()) {
      throw std::runtime_error("kernel " + std::string(name) +
                               " has no checked flavour: it would not fit in a local store");
    }
    return ls_sim::load_image(file.name, checked ? file.checked_elf : file.elf);
  }
  throw std::runtime_error("there is no kernel " + std::string(name));
}

std::uint32_t measure_stack(const ls_sim::KernelImage& kernel) {
  dma::AddressSpace memory;
  ls_sim::SpePool pool(memory, {.spes = 1, .measure_stack = true});
  if (kernel.name == "match") {
    run_match_sample(kernel, memory, pool);
  } else if (kernel.name == "skin") {
    run_skin_sample(kernel, memory, pool);
  } else if (kernel.name == "transfers") {
    run_transfers_sample(kernel, memory, pool);
  } else {
    throw std::runtime_error("kernel " + kernel.name + " has no sample of work to measure its stack with");
  }
  return pool.statistics()[0].stack_high_water;
}

}  // namespace softcell::demos
