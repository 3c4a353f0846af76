#include "ppu/bodies/rest_shape.h"

#include <chrono>
#include <utility>

#include "ppu/bodies/workshop.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// The thread on which the rest shapes of all bodies flow. A body that yields flows after each look, and the result is needed only in the
/// next step.
Workshop& flows() {
  static Workshop workshop(Workshop::Start::kByClock);
  return workshop;
}

template <int kDimension>
auto rest_of_lattice(const SoftBodyModel<kDimension>& model) {
  std::vector<Eigen::Matrix<double, kDimension, 1>> positions;
  for (std::size_t i = 0; i < model.particles(); ++i)
    positions.push_back(model.lattice().rest_position(i).template cast<double>());
  return positions;
}

template <int kDimension>
auto exact(std::span<const Eigen::Vector<float, kDimension>> positions) {
  std::vector<Eigen::Matrix<double, kDimension, 1>> exact;
  for (const auto& position : positions) exact.push_back(position.template cast<double>());
  return exact;
}

}  // namespace

template <int kDimension>
RestShape<kDimension>::RestShape(const SoftBodyModel<kDimension>& model, const std::vector<Exact>& rest)
    : flow_(std::make_shared<PlasticFlow<kDimension>>(model.rest_lattice(), rest)) {}

template <int kDimension>
RestShape<kDimension>::RestShape(const SoftBodyModel<kDimension>& model)
    : RestShape(model, rest_of_lattice(model)) {}

template <int kDimension>
RestShape<kDimension>::RestShape(const SoftBodyModel<kDimension>& model, std::span<const Vector> rest)
    : RestShape(model, exact<kDimension>(rest)) {}

template <int kDimension>
RestShape<kDimension>::RestShape(const RestShape& other)
    : flow_((other.wait(), std::make_shared<PlasticFlow<kDimension>>(*other.flow_))),
      shape_(other.shape_),
      next_(other.next_),
      is_flowing_(other.is_flowing_) {}

template <int kDimension>
auto RestShape<kDimension>::plan() const -> std::shared_ptr<const Plan> {
  SC_ASSERT(is_own(), "the plan of a rest shape of {} particles that is the model's", flow_->rest().size());
  return {shape_, &shape_->plan};
}

template <int kDimension>
auto RestShape<kDimension>::positions() const -> std::span<const Vector> {
  SC_ASSERT(is_own(), "positions of a rest shape of {} particles that is the model's", flow_->rest().size());
  return shape_->positions;
}

template <int kDimension>
void RestShape<kDimension>::adopt(const Plan& of_model) {
  shape_ = shape_of(*flow_, of_model);
}

template <int kDimension>
auto RestShape<kDimension>::shape_of(const PlasticFlow<kDimension>& flow, Plan plan)
    -> std::shared_ptr<const Shape> {
  plan.set_rest(flow.rest());
  std::vector<Vector> positions;
  for (const auto& particle : plan.particle_constants())
    positions.push_back(plan.rest_centre() + particle.x0);
  return std::make_shared<const Shape>(Shape{std::move(plan), std::move(positions)});
}

/// Returns when a flow that was begun has a result.
template <int kDimension>
void RestShape<kDimension>::wait() const {
  if (!next_.valid() || next_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) return;
  flows().hurry();
  next_.wait();
}

template <int kDimension>
void RestShape<kDimension>::look(std::span<const Vector> x, std::optional<float> stretch,
                                 const Plasticity& plasticity, double share,
                                 const std::shared_ptr<const Plan>& plan) {
  // The thread of flows does the close look if this thread need not.
  bool looked = false;
  if (!is_flowing_) {
    std::optional<bool> yields = stretch ? flow_->may_yield(*stretch, plasticity.yield) : std::nullopt;
    looked = !yields;
    if (looked) yields = flow_->may_yield(x, plasticity.yield);
    if (!*yields) return;
  }
  // Memory that another thread frees comes back with new pages each time, which costs this thread more than the copy.
  seen_->assign(x.begin(), x.end());
  next_ = flows().begin([flow = flow_, seen = seen_, plan, plasticity, share, looked,
                         worn = std::move(worn_)]() -> std::shared_ptr<const Shape> {
    if (!looked && !flow->may_yield(*seen, plasticity.yield)) return nullptr;
    if (!flow->flow(*seen, plan->sums(), plasticity, share)) return nullptr;
    return shape_of(*flow, *plan);
  });
}

template <int kDimension>
auto RestShape<kDimension>::take(std::span<const Vector> x) -> Taken {
  if (!next_.valid()) return Taken::kNothing;
  wait();
  std::shared_ptr<const Shape> flowed = std::exchange(next_, {}).get();
  is_flowing_ = flowed != nullptr;
  worn_ = nullptr;
  if (!flowed) return Taken::kNothing;
  if (!flow_->takes_energy(x)) {
    flow_->take_back();
    worn_ = std::move(flowed);
    return Taken::kRefused;
  }
  worn_ = std::exchange(shape_, std::move(flowed));
  return Taken::kNewShape;
}

template class RestShape<2>;
template class RestShape<3>;

}  // namespace softcell::ppu
