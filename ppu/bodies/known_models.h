#pragma once
// What a coupling keeps of each model: made once, for all bodies of the model, and freed with the last of them.

#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// @tparam Known  has `model()`, the std::shared_ptr to its SoftBodyModel. Bodies hold what they use by a std::shared_ptr.
template <int kDimension, typename Known>
class KnownModels {
 public:
  using Model = SoftBodyModel<kDimension>;

  /// @param before_freed  called with each before it is freed
  explicit KnownModels(std::function<void(const Known&)> before_freed)
      : before_freed_(std::move(before_freed)) {}

  /// What is kept of a model, null at first. The reference stays valid when others are added.
  std::shared_ptr<const Known>& operator[](const Model* model) { return known_[model]; }

  /// Keeps what was made elsewhere, unless there is something of its model already.
  void adopt(std::unique_ptr<const Known> known) {
    SC_ASSERT(known != nullptr, "nothing was made, beside {} models", known_.size());
    const Model* const model = known->model().get();
    known_.try_emplace(model, std::move(known));
  }

  /// Tells that a body has gone or has another model now. Frees what is kept of its model if that is unused, and after a piece also what is
  /// kept of the whole. The time does not depend on the number of models.
  /// @param model  that the body had; need not exist any longer
  void forget(const Model* model) {
    steps_left_ = kSteps;
    for (auto there = known_.find(model); there != known_.end() && is_unused(*there);
         there = known_.find(model)) {
      model = there->first->whole().get();
      before_freed_(*there->second);
      known_.erase(there);
    }
  }

  /// Call it in each step. If a body has gone not long ago, frees all that is unused in the first step after that, and in a later one: a
  /// solver holds the model until its next step, and a thread that disposes of a large body for some time.
  void forget_unused() {
    if (steps_left_ == 0) return;
    const bool is_first = steps_left_-- == kSteps;
    if (!is_first && steps_left_ > 0) return;
    const auto forget = [&](const auto& entry) {
      if (!is_unused(entry)) return false;
      before_freed_(*entry.second);
      return true;
    };
    // The last piece that goes lets go of the whole.
    while (std::erase_if(known_, forget) > 0) continue;
  }

 private:
  using Entry = std::pair<const Model* const, std::shared_ptr<const Known>>;

  /// Bodies of a model that somebody else still holds may come back; of a piece's they do not.
  static bool is_unused(const Entry& entry) {
    const auto& [model, known] = entry;
    const bool may_come_back = !model->is_piece() && known->model().use_count() > 1;
    return known.use_count() == 1 && !may_come_back;
  }

  static constexpr int kSteps = 120;

  std::function<void(const Known&)> before_freed_;
  std::unordered_map<const Model*, std::shared_ptr<const Known>> known_;
  int steps_left_ = 0;  // in which something may be found that is unused
};

}  // namespace softcell::ppu
