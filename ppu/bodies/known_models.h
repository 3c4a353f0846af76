#pragma once
// What a coupling keeps of each model: made once, for all bodies of the model, and freed with the last of them.

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

  /// What is kept of a model, null at first. The reference stays valid when others are added.
  std::shared_ptr<const Known>& operator[](const Model* model) { return known_[model]; }

  /// Keeps what was made elsewhere, unless there is something of its model already.
  void adopt(std::unique_ptr<const Known> known) {
    SC_ASSERT(known != nullptr, "nothing was made, beside {} models", known_.size());
    const Model* const model = known->model().get();
    known_.try_emplace(model, std::move(known));
  }

  /// Frees what is kept of one model, if it is unused, and after a piece also that of the whole. The time does not depend on the number of
  /// models.
  /// @param model   need not exist any longer  @param before  called with each before it is freed
  template <typename Before>
  void forget(const Model* model, const Before& before) {
    for (auto there = known_.find(model); there != known_.end() && is_unused(*there);
         there = known_.find(model)) {
      model = there->first->whole().get();
      before(*there->second);
      known_.erase(there);
    }
  }

  /// Frees all that is unused. @param before  as above
  template <typename Before>
  void forget_unused(const Before& before) {
    const auto forget = [&](const auto& entry) {
      if (!is_unused(entry)) return false;
      before(*entry.second);
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

  std::unordered_map<const Model*, std::shared_ptr<const Known>> known_;
};

}  // namespace softcell::ppu
