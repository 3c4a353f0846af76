#pragma once
// The attachments that are solved in a substep, between contacts.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ppu/contacts/attachment_rows.h"

namespace softcell::ppu {

/// An attachment and its sides, by their numbers in the substep.
template <int kDimension>
struct AttachmentInStep {
  static constexpr std::uint32_t kNone = ~0u;
  AttachmentRows<kDimension>* rows = nullptr;
  std::uint32_t a = 0, b = kNone;       ///< soft bodies; b kNone: a frame
  std::uint32_t rigid = kNone;          ///< of a frame: kNone: only the program moves it
  AttachmentFrame<kDimension> frame{};  ///< of a frame
  bool touch = false;                   ///< its two soft bodies touch each other
};

/// Used by one thread. A coupling fills it before each substep.
template <int kDimension>
class Attachments {
 public:
  using Rigid = typename AttachedRigid<kDimension>::Rigid;

  /// Empty, with the room that it has.
  void clear();
  void add(const AttachmentInStep<kDimension>& attachment);
  bool empty() const { return all_.empty(); }

  /// Whether two soft bodies do not touch each other because they are attached. @pre a < b
  bool parts(std::uint32_t a, std::uint32_t b) const;

  /// @param bodies, rigids  stay where they are until finish()
  void begin(std::span<const AttachedBody<kDimension>> bodies, std::span<Rigid> rigids, float step);
  /// Up to as many iterations; fewer when nothing changes any more.
  void iterate(int iterations);
  void finish();

 private:
  std::vector<AttachmentInStep<kDimension>> all_;
  std::vector<AttachmentRows<kDimension>*> solved_;  // of them: those with a side that may move
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parted_;
};

extern template class Attachments<2>;
extern template class Attachments<3>;

}  // namespace softcell::ppu
