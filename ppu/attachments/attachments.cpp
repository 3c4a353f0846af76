#include "ppu/attachments/attachments.h"

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::ppu {

template <int kDimension>
void Attachments<kDimension>::clear() {
  all_.clear();
  solved_.clear();
  parted_.clear();
}

template <int kDimension>
void Attachments<kDimension>::add(const AttachmentInStep<kDimension>& attachment) {
  SC_ASSERT(attachment.rows != nullptr && attachment.a != attachment.b, "attachment {} of body {} to itself",
            all_.size(), attachment.a);
  all_.push_back(attachment);
  if (attachment.b != AttachmentInStep<kDimension>::kNone && !attachment.touch)
    parted_.emplace_back(std::min(attachment.a, attachment.b), std::max(attachment.a, attachment.b));
}

template <int kDimension>
bool Attachments<kDimension>::parts(std::uint32_t a, std::uint32_t b) const {
  return std::find(parted_.begin(), parted_.end(), std::pair(a, b)) != parted_.end();
}

template <int kDimension>
void Attachments<kDimension>::append_held(std::span<const Rigid> rigids, float step,
                                          std::vector<HeldParticle<kDimension>>& held) {
  constexpr std::uint32_t kNone = AttachmentInStep<kDimension>::kNone;
  for (std::uint32_t i = 0; i < all_.size(); ++i) {
    const AttachmentInStep<kDimension>& attachment = all_[i];
    if (attachment.b != kNone) continue;
    const Rigid* const rigid = attachment.rigid != kNone ? &rigids[attachment.rigid] : nullptr;
    const std::size_t first = held.size();
    attachment.rows->append_held(attachment.a, attachment.frame, rigid, step, held);
    for (HeldParticle<kDimension>& particle : std::span(held).subspan(first)) particle.attachment = i;
  }
}

template <int kDimension>
void Attachments<kDimension>::begin(std::span<const AttachedBody<kDimension>> bodies, std::span<Rigid> rigids,
                                    float step) {
  constexpr std::uint32_t kNone = AttachmentInStep<kDimension>::kNone;
  solved_.clear();
  for (const AttachmentInStep<kDimension>& attachment : all_) {
    const AttachedBody<kDimension>* const b = attachment.b != kNone ? &bodies[attachment.b] : nullptr;
    if (bodies[attachment.a].asleep && (b == nullptr || b->asleep)) continue;
    Rigid* const rigid = attachment.rigid != kNone ? &rigids[attachment.rigid] : nullptr;
    const bool moves = rigid != nullptr && rigid->inverse_mass > 0;
    attachment.rows->begin({bodies[attachment.a], b, b == nullptr ? &attachment.frame : nullptr, rigid},
                           step);
    solved_.push_back({attachment.rows, {attachment.a, attachment.b, moves ? attachment.rigid : kNone}});
  }
  find_those_alone(bodies.size(), rigids.size());
}

/// Finds attachments that share no side with another one: while attachments are solved, nothing else changes their sides. Also finds bodies
/// whose attachments contradict each other.
template <int kDimension>
void Attachments<kDimension>::find_those_alone(std::size_t bodies, std::size_t rigids) {
  attached_to_.assign(bodies + rigids, 0);
  const auto of_each_side = [&](const AttachmentSides& sides, const auto& work) {
    work(attached_to_[sides.a]);
    if (sides.b != AttachmentSides::kNone) work(attached_to_[sides.b]);
    if (sides.rigid != AttachmentSides::kNone) work(attached_to_[bodies + sides.rigid]);
  };
  contradicted_.assign(bodies, false);
  for (const Solved& solved : solved_) {
    of_each_side(solved.sides, [](std::uint32_t& count) { ++count; });
    if (!solved.rows->is_apart()) continue;
    contradicted_[solved.sides.a] = true;
    if (solved.sides.b != AttachmentSides::kNone) contradicted_[solved.sides.b] = true;
  }
  for (Solved& solved : solved_) {
    solved.once = solved.rows->is_direct();
    of_each_side(solved.sides, [&](const std::uint32_t& count) { solved.once = solved.once && count == 1; });
  }
}

template <int kDimension>
void Attachments<kDimension>::iterate(int iterations) {
  constexpr float kDone = 1e-8f;  // of the first iteration's error, squared
  float first = 0;
  for (int i = 0; i < iterations; ++i) {
    float error = 0;
    for (const Solved& solved : solved_) {
      if (solved.once && i > 0) continue;
      const float of_rows = solved.rows->iterate();
      if (!solved.once) error = std::max(error, of_rows);
    }
    if (i == 0) first = error;
    if (error <= kDone * first) return;
  }
}

template <int kDimension>
void Attachments<kDimension>::finish() {
  for (const Solved& solved : solved_) solved.rows->finish();
  take_back_spin();
}

template <int kDimension>
void Attachments<kDimension>::take_back_spin() {
  for (const Solved& solved : solved_)
    solved.rows->take_back_spin(attached_to_[solved.sides.a] == 1 || !contradicted_[solved.sides.a]);
}

template <int kDimension>
bool Attachments<kDimension>::takes_back_spin() const {
  return std::ranges::any_of(solved_, [](const Solved& solved) { return solved.rows->takes_back_spin(); });
}

template class Attachments<2>;
template class Attachments<3>;

}  // namespace softcell::ppu
