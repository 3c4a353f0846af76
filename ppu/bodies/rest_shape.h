#pragma once
// The rest shape of one body that may yield, and the flows that change it.
//
//     SoftBody::flow()   look   take   2   3   look   take ...     the result is taken kFlowSteps calls later, or is waited for:
//     thread of flows    [ a flow ]            [ a flow ]           so it does not depend on how fast that thread is

#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/matching/matching_plan.h"
#include "ppu/matching/plastic_flow.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// Used by one thread at a time.
template <int kDimension>
class RestShape {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Plan = MatchingPlan<float, kDimension>;

  /// The model's rest shape.
  /// @throws std::runtime_error  the model has too many particles for plasticity
  explicit RestShape(const SoftBodyModel<kDimension>& model);
  /// Another one, which is used after adopt(). @param rest  of each particle, metres, in any frame   @throws as above
  RestShape(const SoftBodyModel<kDimension>& model, std::span<const Vector> rest);
  /// Waits for a flow of the other that was begun.
  RestShape(const RestShape& other);
  RestShape& operator=(const RestShape&) = delete;

  /// Whether it differs from the model's.
  bool is_own() const { return shape_ != nullptr; }
  /// The constants of shape matching for it. @pre is_own()
  std::shared_ptr<const Plan> plan() const;
  /// Of each particle, metres, with the model's centre of mass. @pre is_own()
  std::span<const Vector> positions() const;

  /// As PlasticFlow::cells_that_contacts_hold().
  std::size_t cells_that_contacts_hold() const { return flow_->cells_that_contacts_hold(); }
  /// Uses the shape that the constructor was given. @param of_model  the constants of the model's rest shape
  void adopt(const Plan& of_model);

  /// Whether the last flow changed the shape. Then the next look() does no close look on this thread: the thread of flows does it.
  bool is_flowing() const { return is_flowing_; }
  /// Begins a flow on another thread if the body may have yielded.
  /// @param x        positions, metres
  /// @param stretch  as SoftBody::flow()
  /// @param share    0..1: how much of the strain above the yield flows
  /// @param plan     the constants of the present rest shape
  void look(std::span<const Vector> x, std::optional<float> stretch, const Plasticity& plasticity,
            double share, const std::shared_ptr<const Plan>& plan);
  enum class Taken {
    kNothing,  ///< no flow was begun, or it did not change the shape
    kRefused,  ///< the body has sprung back so far that the new shape would add energy: the shape stays
    kNewShape,
  };
  /// Takes the result of the flow that the last look() has begun, for which it may have to wait. @param x  positions now, metres
  Taken take(std::span<const Vector> x);

 private:
  using Exact = Eigen::Matrix<double, kDimension, 1>;
  /// A rest shape after yielding. Immutable, as copies of a body share it.
  struct Shape {
    Plan plan;
    std::vector<Vector> positions;  // metres
  };

  RestShape(const SoftBodyModel<kDimension>& model, const std::vector<Exact>& rest);
  static std::shared_ptr<const Shape> shape_of(const PlasticFlow<kDimension>& flow, Plan plan);
  void wait() const;

  // The thread of flows uses these two while `next_` is not ready.
  std::shared_ptr<PlasticFlow<kDimension>> flow_;
  std::shared_ptr<std::vector<Vector>> seen_ = std::make_shared<std::vector<Vector>>();  // positions, metres

  std::shared_ptr<const Shape> shape_;  // null: the model's
  // Result of a flow that was begun; null: the shape has not changed.
  std::shared_future<std::shared_ptr<const Shape>> next_;
  bool is_flowing_ = false;
  // The previous shape: the thread of flows destroys it with the next flow.
  std::shared_ptr<const Shape> worn_;
};

extern template class RestShape<2>;
extern template class RestShape<3>;

}  // namespace softcell::ppu
