#pragma once
// The attachments of a substep, which are solved together with contacts.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ppu/attachments/attach_unit.h"
#include "ppu/attachments/attachment_records.h"
#include "ppu/attachments/attachment_rows.h"

namespace softcell::ppu {

/// An attachment and its sides, by their numbers in the substep.
template <int kDimension>
struct AttachmentInStep {
  static constexpr std::uint32_t kNone = ~0u;
  AttachmentRows<kDimension>* rows = nullptr;
  std::uint32_t a = 0, b = kNone;       ///< soft bodies; b kNone: a frame
  std::uint32_t rigid = kNone;          ///< the frame's rigid body; kNone: only the program moves the frame
  AttachmentFrame<kDimension> frame{};  ///< of a frame
  bool touch = false;                   ///< the two soft bodies also collide with each other
};

/// The sides of an attachment, by their numbers.
struct AttachmentSides {
  static constexpr std::uint32_t kNone = ~0u;
  std::uint32_t a = 0, b = kNone;  ///< soft bodies
  std::uint32_t rigid = kNone;     ///< a rigid body that impulses move
};

/// Solves attachments: call begin(), iterate() once or more often, finish(). Or a kernel solves them, between begin() and read() of each.
template <int kDimension>
class AttachmentSolver {
 public:
  using Rigid = typename AttachedRigid<kDimension>::Rigid;

  virtual ~AttachmentSolver() = default;
  virtual bool empty() const = 0;
  /// Whether two soft bodies do not collide because they are attached. @pre a < b
  virtual bool parts(std::uint32_t a, std::uint32_t b) const = 0;
  /// Appends the particles that are held by frames that impulses do not move. Call it first in each substep.
  virtual void append_held(std::span<const Rigid> rigids, float step,
                           std::vector<HeldParticle<kDimension>>& held) = 0;
  /// A rigid body presses on what an attachment holds. Call it before begin(). @param attachment  HeldParticle::attachment
  /// @param breaks  more than it carries: it breaks at the substep's end
  virtual void press(std::uint32_t attachment, bool breaks) = 0;
  /// @param bodies, rigids  must stay in place until finish()
  virtual void begin(std::span<const AttachedBody<kDimension>> bodies, std::span<Rigid> rigids,
                     float step) = 0;
  /// Iterates at most this often; stops when nothing changes any more.
  virtual void iterate(int iterations) = 0;
  virtual void finish() = 0;

  // For the kernel `attach`, after begin().

  virtual std::size_t solved() const = 0;  ///< how many attachments there are to solve
  virtual AttachmentSides sides(std::size_t attachment) const = 0;
  /// Appends the attachment's records. @return false: the kernel cannot solve it, and nothing is appended.
  virtual bool write(std::size_t attachment, AttachUnit& unit) const = 0;
  /// Reads back the kernel's results. Call it instead of finish().
  virtual void read(std::size_t attachment, const spu::AttachLink& link,
                    std::span<const spu::AttachPoint> points, std::span<const spu::AttachRow> rows) = 0;
  /// Call it after read() of all attachments, while bodies have the velocities that the kernel gave them.
  virtual void take_back_spin() = 0;
};

/// Used by one thread. A coupling fills it before each substep.
template <int kDimension>
class Attachments final : public AttachmentSolver<kDimension> {
 public:
  using typename AttachmentSolver<kDimension>::Rigid;

  /// Removes all attachments and keeps the allocated room.
  void clear();
  void add(const AttachmentInStep<kDimension>& attachment);

  bool empty() const override { return all_.empty(); }
  bool parts(std::uint32_t a, std::uint32_t b) const override;
  void append_held(std::span<const Rigid> rigids, float step,
                   std::vector<HeldParticle<kDimension>>& held) override;
  void press(std::uint32_t attachment, bool breaks) override { all_[attachment].rows->press(breaks); }
  void begin(std::span<const AttachedBody<kDimension>> bodies, std::span<Rigid> rigids, float step) override;
  void iterate(int iterations) override;
  void finish() override;
  std::size_t solved() const override { return solved_.size(); }
  AttachmentSides sides(std::size_t attachment) const override { return solved_[attachment].sides; }
  bool write(std::size_t attachment, AttachUnit& unit) const override {
    return AttachmentRecords<kDimension>(*solved_[attachment].rows).write(solved_[attachment].once, unit);
  }
  void read(std::size_t attachment, const spu::AttachLink& link, std::span<const spu::AttachPoint> points,
            std::span<const spu::AttachRow> rows) override {
    AttachmentRecords<kDimension>(*solved_[attachment].rows).read(link, points, rows);
  }
  void take_back_spin() override;
  /// Whether one of the attachments does.
  bool takes_back_spin() const;

 private:
  struct Solved {
    AttachmentRows<kDimension>* rows = nullptr;
    AttachmentSides sides;
    bool once = false;  // in a call of iterate(): further iterations would change nothing
  };
  void find_those_alone(std::size_t bodies, std::size_t rigids);

  std::vector<AttachmentInStep<kDimension>> all_;
  std::vector<Solved> solved_;  // the attachments with a side that may move
  std::vector<std::pair<std::uint32_t, std::uint32_t>> parted_;
  std::vector<std::uint32_t> attached_to_;  // soft bodies, then rigid ones: how many of solved_ each has
  std::vector<bool> contradicted_;          // of each body: the ends of one of its attachments are apart
};

extern template class Attachments<2>;
extern template class Attachments<3>;

}  // namespace softcell::ppu
