#pragma once
// Somebody who finds and solves contacts in place of the thread that steps the world: the SPEs.
//
//     begin(bodies)    where bodies are and would be
//     find(pairs)      starts; the caller may find other contacts in the meantime
//     found()          waits: what has been found, of each pair
//     solve(stages)    changes the velocities and pushes of bodies, and the impulses of contacts
//     take(body)       what they are now

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact_solve_job.h"
#include "ppu/contacts/attach_unit.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// A pair's contacts as found by a worker.
struct FoundContacts {
  std::span<spu::SolveContact> contacts;  ///< in the worker's memory, good until the next begin()
  bool pushes = false;                    ///< one of them does
  bool by_caller = false;                 ///< the worker cannot do it: the caller has to
};

/// Contacts that are solved together, one after the other; then cells of a are stiffened. Or attachments, which are alone in their unit.
struct SolveGroup {
  static constexpr std::uint32_t kNobody = ~0u;
  std::uint32_t a = 0, b = kNobody;        ///< bodies; b kNobody: rigid bodies, or what nothing moves
  std::span<spu::SolveContact> contacts;   ///< from found() or room()
  std::span<spu::SolveRigid> rigids = {};  ///< from rigid_room(): those that contacts are with
  std::uint32_t iterations = 0;            ///< over the contacts
  bool pushes = false;
  std::span<const std::uint32_t> cells = {};  ///< of a, to be stiffened
  float stiffening = 0;                       ///< 0..1
  static constexpr std::uint32_t kNoAttachments = ~0u;
  std::uint32_t attachments = kNoAttachments;  ///< in place of all of the above: a unit of hold()
  bool ends = false;                           ///< it is solved for the last time in this substep
};

/// Groups in units, units in stages: units of one stage share no body that is not asleep and no rigid body, and may be solved at
/// the same time; groups of a unit are solved one after the other.
struct SolveStages {
  std::vector<SolveGroup> groups;
  std::vector<std::uint32_t> units;   ///< of each: its first group
  std::vector<std::uint32_t> stages;  ///< of each: its first unit

  void clear() { groups.clear(), units.clear(), stages.clear(); }
};

/// Used by one thread.
class ContactWorker {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  virtual ~ContactWorker() = default;

  /// Forgets a model that is about to be destroyed. @pre no find() or solve() is under way
  virtual void forget(const ContactModel& model) = 0;

  /// @param bodies  stay as they are, but for velocities and pushes, until the last call of this substep
  /// @throws std::runtime_error  the worker's memory is full.
  virtual void begin(std::span<const ContactBody> bodies, float step) = 0;

  /// Whether the worker can do anything for a body: it may be too large.
  virtual bool holds(std::uint32_t body) const = 0;

  virtual void find(std::span<const Pair> pairs) = 0;
  /// Of each pair of find(). @throws std::runtime_error  the worker failed; the sentence says why.
  virtual std::span<const FoundContacts> found() = 0;

  /// Room for contacts that the caller has found. Good until the next begin(). @pre as many fit into a group
  virtual std::span<spu::SolveContact> room(std::size_t contacts) = 0;
  static constexpr std::size_t kMostContacts = 4096;  ///< of a group

  /// Room for rigid bodies. Good until the next call of it, and the next begin().
  virtual std::span<spu::SolveRigid> rigid_room(std::size_t rigids) = 0;

  /// Attachments for solve(). @param iterations  at most, over those of a unit, in each solve()
  /// @pre holds() is true of all their bodies
  virtual void hold(std::span<const AttachUnit> units, std::uint32_t iterations) = 0;
  /// What solve() has made of links, points and rows.
  virtual void read(std::span<AttachUnit> units) const = 0;

  /// @throws std::runtime_error  as found().
  virtual void solve(const SolveStages& stages) = 0;

  /// A body's velocities and pushes, as they are now. @pre no solve() is under way
  virtual void take(std::uint32_t body, std::span<Eigen::Vector3f> velocities,
                    std::span<Eigen::Vector3f> pushes) const = 0;
  /// Sets them.
  virtual void put(std::uint32_t body, std::span<const Eigen::Vector3f> velocities,
                   std::span<const Eigen::Vector3f> pushes) = 0;
};

}  // namespace softcell::ppu
