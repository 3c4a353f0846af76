#pragma once
// Finds all contacts of a substep: of pairs of soft bodies, of folded bodies with themselves, and of soft bodies with rigid ones.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attachments.h"
#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contact_solver/contact_order.h"
#include "ppu/contact_solver/contact_worker.h"
#include "ppu/contacts/body_in_substep.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/end_cells.h"
#include "ppu/contacts/sharp_contacts.h"
#include "ppu/contacts/swept_contacts.h"
#include "ppu/obstacles/contact_rigid.h"
#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// What a search is told.
struct ContactSearchTerms {
  std::span<const BodyInSubstep> told;
  std::span<const ContactBody> bodies;  ///< the same bodies, with the places where their particles end
  std::span<const Obstacle> obstacles;
  std::span<const ContactRigid> rigids;
  const AttachmentSolver<3>* attachments = nullptr;  ///< some part the bodies that they join; may be null
  ContactWorker* worker = nullptr;                   ///< finds contacts of pairs that it holds; may be null
  float step = 0;                                    ///< seconds
};

/// Used by one thread; keeps allocated memory.
class ContactSearch {
 public:
  /// Replaces `groups` by those of a substep. @throws std::runtime_error  the worker failed; the message says why.
  void find(const ContactSearchTerms& terms, ContactGroups& groups);

 private:
  void find_pairs(const ContactSearchTerms& terms);
  void ask_worker(const ContactSearchTerms& terms);
  void find_with_rigid(const ContactSearchTerms& terms, ContactGroups& groups);
  void find_of_pairs(const ContactSearchTerms& terms, ContactGroups& groups);
  void find_of_pair(ContactGroup& group, const ContactSearchTerms& terms);

  std::vector<EndCells> cells_;  // of each body
  std::vector<std::uint32_t> by_low_;
  std::vector<ContactOrder::Pair> pairs_, asked_;  // asked_: those that the worker looks at
  std::vector<SoftContact> other_way_;             // points of b in a
  SweptContacts swept_;
  SharpContacts sharp_contacts_;
};

}  // namespace softcell::ppu
