#pragma once
// The interface of a worker that finds and solves contacts instead of the thread that steps the world: the SPEs.
//
//     begin(bodies)    tells where bodies are and would be
//     find(pairs)      starts; the caller may find other contacts in the meantime
//     found()          waits: contacts found, for each pair
//     solve(stages)    changes the velocities and pushes of bodies, and the impulses of contacts
//     take(body)       returns them

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "contact_solve_job.h"
#include "ppu/attachments/attach_unit.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// The contacts of a pair that a worker has found.
struct FoundContacts {
  std::span<spu::SolveContact> contacts;  ///< in the worker's memory, valid until the next begin()
  bool pushes = false;                    ///< at least one contact pushes
  bool by_caller = false;                 ///< the worker cannot find them: the caller has to
};

/// Contacts that are solved together, one after the other; then cells of a are stiffened. Or attachments, which are the only group of their
/// unit.
struct SolveGroup {
  static constexpr std::uint32_t kNobody = ~0u;
  std::uint32_t a = 0, b = kNobody;        ///< bodies; b kNobody: rigid or static ones
  std::span<spu::SolveContact> contacts;   ///< from found() or room()
  std::span<spu::SolveRigid> rigids = {};  ///< from rigid_room(): the contacts' rigid bodies
  std::uint32_t iterations = 0;            ///< over the contacts
  bool pushes = false;
  std::span<const std::uint32_t> cells = {};  ///< of a, to be stiffened
  float stiffening = 0;                       ///< 0..1
  static constexpr std::uint32_t kNoAttachments = ~0u;
  std::uint32_t attachments = kNoAttachments;  ///< instead of all of the above: a unit of hold()
  bool ends = false;                           ///< these are the attachments' last iterations in this substep
};

/// Groups in units, units in stages. Units of one stage share no rigid body and no body that is awake, and may be solved at the same time;
/// groups of a unit are solved one after the other.
struct SolveStages {
  std::vector<SolveGroup> groups;
  std::vector<std::uint32_t> units;   ///< of each: index of its first group
  std::vector<std::uint32_t> stages;  ///< of each: index of its first unit

  void clear() { groups.clear(), units.clear(), stages.clear(); }
};

/// Used by one thread.
class ContactWorker {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  virtual ~ContactWorker() = default;

  /// Forgets a model that is about to be destroyed. @pre no find() or solve() is under way
  virtual void forget(const ContactModel& model) = 0;

  /// @param bodies  must stay unchanged, except for velocities and pushes, until the last call of this substep
  /// @throws std::runtime_error  the worker's memory is full.
  virtual void begin(std::span<const ContactBody> bodies, float step) = 0;

  /// Whether the worker can handle a body: it may be too large.
  virtual bool holds(std::uint32_t body) const = 0;

  virtual void find(std::span<const Pair> pairs) = 0;
  /// The results of find(), for each pair. @throws std::runtime_error  the worker failed; the message says why.
  virtual std::span<const FoundContacts> found() = 0;

  /// Room for contacts that the caller has found. Valid until the next begin(). @pre that many fit into a group
  virtual std::span<spu::SolveContact> room(std::size_t contacts) = 0;
  static constexpr std::size_t kMostContacts = 4096;  ///< in a group

  /// Room for rigid bodies. Valid until the next call of rigid_room() or begin().
  virtual std::span<spu::SolveRigid> rigid_room(std::size_t rigids) = 0;

  /// Sets the attachments for solve(). @param iterations  at most, over those of a unit, in each solve()
  /// @pre holds() is true for all their bodies
  virtual void hold(std::span<const AttachUnit> units, std::uint32_t iterations) = 0;
  /// Reads back links, points and rows after solve().
  virtual void read(std::span<AttachUnit> units) const = 0;

  /// @throws std::runtime_error  as found().
  virtual void solve(const SolveStages& stages) = 0;

  /// Reads a body's present velocities and pushes. @pre no solve() is under way
  virtual void take(std::uint32_t body, std::span<Eigen::Vector3f> velocities,
                    std::span<Eigen::Vector3f> pushes) const = 0;
  /// Sets a body's velocities and pushes.
  virtual void put(std::uint32_t body, std::span<const Eigen::Vector3f> velocities,
                   std::span<const Eigen::Vector3f> pushes) = 0;
};

}  // namespace softcell::ppu
