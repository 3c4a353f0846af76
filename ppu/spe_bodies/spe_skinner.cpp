#include "softcell/spe_bodies/spe_skinner.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/spe_bodies/skin_orchestrator.h"
#include "softcell/base/assert.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {

static_assert(sizeof(HalfVertex) == sizeof(spu::SkinnedVertex) &&
              offsetof(HalfVertex, normal) == offsetof(spu::SkinnedVertex, normal));

DrawOrder draw_order(const SoftBodyModel<3>& model) {
  const Embedding& embedding = model.embedding();
  return {embedding.indices, embedding.vertex_of_slot};
}

struct SpeSkinner::State {
  State(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin)
      : orchestrator(memory, jobs, skin) {}

  /// @throws std::invalid_argument  the body was not added.
  std::size_t number_of(const SoftBody<3>& body) const {
    const auto found = std::find(bodies.begin(), bodies.end(), &body);
    if (found == bodies.end()) throw std::invalid_argument("the soft body was not added to this skinner");
    return static_cast<std::size_t>(found - bodies.begin());
  }

  std::vector<const SoftBody<3>*> bodies;                       // in the orchestrator's order
  std::vector<std::shared_ptr<const SoftBodyModel<3>>> models;  // of the bodies when they were added
  std::vector<std::span<const Eigen::Vector4f>> positions;
  SkinOrchestrator orchestrator;
};

SpeSkinner::SpeSkinner(SpeRuntime& spes) : SpeSkinner(spes.memory(), spes.jobs(), spes.kernel("skin")) {}
SpeSkinner::SpeSkinner(dma::AddressSpace& memory, JobSystem& jobs, const ls_sim::KernelImage& skin)
    : state_(std::make_unique<State>(memory, jobs, skin)) {}
SpeSkinner::~SpeSkinner() = default;

void SpeSkinner::add(const SoftBody<3>& body) {
  const SoftBodyModel<3>& model = body.model();
  if (model.embedding().groups.empty())
    throw std::invalid_argument("a soft body without a mesh cannot be skinned; make its model from a mesh");
  if (std::find(state_->bodies.begin(), state_->bodies.end(), &body) != state_->bodies.end())
    throw std::invalid_argument("the soft body was added to this skinner before");
  state_->orchestrator.add(std::shared_ptr<const Embedding>(body.shared_model(), &model.embedding()),
                           model.particles());
  state_->bodies.push_back(&body);
  state_->models.push_back(body.shared_model());
  state_->positions.resize(state_->bodies.size());
}

void SpeSkinner::remove(const SoftBody<3>& body) {
  const std::size_t number = state_->number_of(body);
  state_->bodies.erase(state_->bodies.begin() + static_cast<std::ptrdiff_t>(number));
  state_->models.erase(state_->models.begin() + static_cast<std::ptrdiff_t>(number));
  state_->positions.resize(state_->bodies.size());
  state_->orchestrator.remove(number);
}

bool SpeSkinner::begin_frame() {
  for (std::size_t b = 0; b < state_->bodies.size(); ++b) {
    if (state_->bodies[b]->shared_model() != state_->models[b])
      throw std::runtime_error(
          "SpeSkinner: body " + std::to_string(b) + " of " + std::to_string(state_->bodies.size()) +
          " has another model than when it was added: it has broken, was cut, or got a body of another "
          "model; call remove() and add() for it");
    state_->positions[b] = state_->bodies[b]->padded_positions();
  }
  return state_->orchestrator.kick(state_->positions);
}

void SpeSkinner::finish_frame() { state_->orchestrator.drain(); }

SkinnedVertices SpeSkinner::vertices(const SoftBody<3>& body) const {
  SC_ASSERT(state_->bodies.size() == state_->positions.size(), "{} bodies, positions of {}",
            state_->bodies.size(), state_->positions.size());
  const SkinnedBody shown = state_->orchestrator.shown(state_->number_of(body));
  // Both types hold eight numbers of 16 bits. The PPU never writes them: an SPE does, by DMA.
  return {{reinterpret_cast<const HalfVertex*>(shown.vertices.data()), shown.vertices.size()}, shown.origin};
}

}  // namespace softcell::ppu
