#include "softcell/bullet/bullet_soft_bodies.h"

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "ppu/bodies/breaks.h"
#include "ppu/bodies/checked_arguments.h"
#include "ppu/bodies/processor_time.h"
#include "ppu/bodies/step_ahead.h"
#include "ppu/bodies/workshop.h"
#include "ppu/bullet/bullet_hook.h"
#include "ppu/bullet/contact_sphere.h"
#include "ppu/bullet/free_body.h"
#include "ppu/bullet/prepared_piece.h"
#include "ppu/bullet/sphere_body.h"
#include "ppu/bullet/surface_contacts.h"
#include "ppu/contacts/crushed_cells.h"
#include "ppu/contacts/piece_sides.h"
#include "ppu/surfaces/way_in_box.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
struct BulletSoftBodies::Impl final : SubstepClient, btActionInterface {
  /// @param solver  a SoftBodySolver<3>, or the pointer that owns one
  template <typename Solver>
  Impl(btDiscreteDynamicsWorld& w, Solver&& solver, ContactMethod contacts,
       std::shared_ptr<ContactWorker> worker = nullptr)
      : world(w), solve(std::forward<Solver>(solver)), workshop(std::in_place) {
    if (contacts == ContactMethod::kSurface) surfaces.emplace(world, std::move(worker));
    BulletHook::attach(world, *this);
    world.addAction(this);
  }
  ~Impl() override {
    workshop.reset();  // its threads use the members that follow
    solve.clear();
    for (const auto& body : bodies) wake_rigid_bodies(*body);
    bodies.clear();
    world.removeAction(this);
    BulletHook::detach(world, *this);
  }

  void begin_substep(float step) override {
    SC_ASSERT(step > 0, "a substep of {} s", step);
    const auto begin = std::chrono::steady_clock::now();
    timed(times.gather, [&] {
      if (!solve.has_begun(step) || std::any_of(bodies.begin(), bodies.end(), [](const auto& body) {
            return body->was_changed() || body->was_pushed();
          })) {
        solve.drop();
        for (const auto& body : bodies) {
          if (body->was_reset()) solve.forget(body->soft());
          if (body->was_changed()) {
            tell_others(*body);
            if (SurfaceBody* const surface = with_surface(*body)) take_other_model(*surface);
          }
          body->begin_substep();
        }
      }
    });
    timed(times.solve, [&] { times.wait += solve.finish(step); });
    timed(times.apply, [&] {
      breaks.test_late(solve, *this);
      for (const auto& body : bodies) body->apply(step);
    });
    if (surfaces) timed(times.contacts, [&] { surfaces->step(with_surfaces, step); });
    BulletHook::find(world)->add_time(std::chrono::steady_clock::now() - begin);
  }

  /// Bullet's actions run once per substep, after it has integrated.
  void updateAction(btCollisionWorld*, btScalar step) override {
    const auto begin = std::chrono::steady_clock::now();
    timed(times.gather, [&] {
      for (const auto& body : bodies) body->end_substep(step, sleep);
      break_strained();
      if (sleep && surfaces) surfaces->let_sleep(with_surfaces, *sleep);
    });
    BulletHook::find(world)->add_time(std::chrono::steady_clock::now() - begin);
  }
  void debugDraw(btIDebugDraw*) override {}

  /// Null: the body does not touch with its surface.
  SurfaceBody* with_surface(const CoupledBody& body) const {
    const auto found = std::find(with_surfaces.begin(), with_surfaces.end(), &body);
    return found == with_surfaces.end() ? nullptr : *found;
  }
  static bool is_of_other_model(const SurfaceBody& body) {
    return body.contact().model() != body.soft().shared_model();
  }
  void follow_model(SurfaceBody& body) {
    if (is_of_other_model(body)) body.set_contact(surfaces->contact_model(body.soft().shared_model()));
  }
  /// An assignment may have given the body another model. Its attachments refer to particles that it does not have, so they are removed.
  void take_other_model(SurfaceBody& body) {
    if (is_of_other_model(body)) attachments().forget(body);
    follow_model(body);
  }

  using BreaksOfBodies = Breaks<3, CoupledBody, PreparedPieces>;
  using Break = BreaksOfBodies::Break;

  void break_strained() {
    breaks.test(bodies, *this);
    for (Break& one : breaks.take_due()) put_pieces(*one.body, one.pieces.get(), one.faces);
  }

  /// Null: contact models of the body's pieces are not made ahead.
  std::shared_ptr<const ContactModel> contact_of_whole(const CoupledBody& body) {
    const std::shared_ptr<const SoftBodyModel<3>>& model = body.soft().shared_model();
    if (!surfaces || !body.can_be_touched() || model->mesh().triangles.empty()) return nullptr;
    return surfaces->contact_model(model->is_piece() ? model->whole() : model);
  }

  /// @param substeps  from now until the pieces appear
  void begin_break(CoupledBody& body, std::span<const std::uint32_t> faces, int substeps) {
    const std::shared_ptr<const SoftBodyModel<3>>& model = body.soft().shared_model();
    if (substeps == 0) {
      break_body(body, faces);
      return;
    }
    breaks.begin(body, faces.size(), substeps,
                 workshop->begin([this, model, own = std::vector<std::uint32_t>(faces.begin(), faces.end()),
                                  least_cells = least_cells_of(body.soft()), whole = contact_of_whole(body)] {
                   return make_pieces(model, own, least_cells, whole);
                 }));
  }

  /// May run on any thread.
  PreparedPieces make_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                             std::span<const std::uint32_t> faces, std::uint32_t least_cells,
                             const std::shared_ptr<const ContactModel>& whole) {
    return prepare_pieces(model, faces, least_cells, whole.get(),
                          [this](const auto& of_piece) { solve.prepare(of_piece); });
  }

  /// @return the pieces that stay, except for the body itself
  std::vector<SoftBody<3>*> break_body(CoupledBody& body, std::span<const std::uint32_t> faces) {
    return put_pieces(
        body,
        make_pieces(body.soft().shared_model(), faces, least_cells_of(body.soft()), contact_of_whole(body)),
        faces.size());
  }

  /// Lets pieces know the walls near the whole. The first piece has replaced the whole, but still has its contact model.
  /// @param whole  the whole's last state
  static void follow_sides(const SoftBody<3>& whole, std::span<const SurfaceAttachments::Piece> pieces) {
    const SurfaceBody& first = *pieces.front().body;
    const KnownSides sides = first.sides();
    for (const SurfaceAttachments::Piece& piece : pieces)
      piece.body->set_sides(sides_of_piece(sides, first.contact(), whole.positions(), whole.model().lattice(),
                                           piece.body->soft().model().lattice(), piece.particle_of));
  }

  /// @param faces  that broke   @return the pieces that stay, except for the body itself
  std::vector<SoftBody<3>*> put_pieces(CoupledBody& body, PreparedPieces made, std::size_t faces) {
    std::vector<PreparedPiece>& prepared = made.stay;
    std::vector<SoftBody<3>*> others;
    std::vector<SurfaceAttachments::Piece> with_attachments;
    std::vector<std::vector<std::uint32_t>> particles_before;
    const auto append = [&](const CoupledBody& coupled, std::vector<std::uint32_t> particle_of) {
      particles_before.push_back(std::move(particle_of));
      if (SurfaceBody* const surface = with_surface(coupled))
        with_attachments.push_back({surface, particles_before.back()});
    };
    for (PreparedPiece& piece : prepared)
      if (piece.contact) surfaces->adopt(std::move(piece.contact));
    solve.drop();
    const Eigen::Vector3d centre = body.soft().precise_centre_of_mass();
    for (auto& [piece, contact] : prepared) {
      piece.body.inherit_state(body.soft(), piece.particle_of, centre);
      // After a teleport or a reset of the shape nothing is known of the body's rotations.
      if (!body.was_reset()) solve.inherit_state(body.soft(), piece.body, piece.particle_of);
    }
    append(body, std::move(prepared.front().piece.particle_of));
    for (std::size_t i = 1; i < prepared.size(); ++i) {
      BodyPiece<3>& piece = prepared[i].piece;
      others.push_back(&add(std::move(piece.body)));
      bodies.back()->set_filter(body.filter());
      append(*bodies.back(), std::move(piece.particle_of));
    }
    if (!made.vanished.empty())
      tell_others(body);
    else
      wake_rigid_bodies(body);
    SoftBody<3> before = body.become(std::move(prepared.front().piece.body));
    if (!with_attachments.empty()) {
      follow_sides(before, with_attachments);
      follow_model(*with_attachments.front().body);
      surfaces->attachments().follow_pieces(*with_attachments.front().body, with_attachments, made.vanished);
      surfaces->forget_model(before.shared_model().get());
    }
    broken.push_back({&body.soft(), others, faces, made.vanished.size(), std::move(particles_before)});
    if (substeps_until_pieces(before.positions().size()) > 0) workshop->dispose(std::move(before));
    return others;
  }

  SoftBody<3>& add(SoftBody<3> soft) {
    std::unique_ptr<CoupledBody> body;
    if (!soft.settings().contacts) {
      body = std::make_unique<FreeBody>(world, std::move(soft));
    } else if (surfaces) {
      std::shared_ptr<const ContactModel> contact = surfaces->contact_model(soft.shared_model());
      auto surface = std::make_unique<SurfaceBody>(world, std::move(soft), std::move(contact), next_number++);
      with_surfaces.push_back(surface.get());
      body = std::move(surface);
    } else {
      body = std::make_unique<SphereBody>(world, std::move(soft));
    }
    solve.add(body->soft());
    bodies.push_back(std::move(body));
    return bodies.back()->soft();
  }

  /// @throws std::invalid_argument  the body is not one of `bodies`
  auto find(const SoftBody<3>& body, const char* purpose) {
    return find_coupled(bodies, body, purpose, "BulletSoftBodies");
  }

  /// The body, after its running break has ended.
  /// @throws std::invalid_argument  as find(); the body touches with spheres
  CoupledBody& find_breakable(const SoftBody<3>& body) {
    CoupledBody& coupled = **find(body, "to be cut");
    if (!coupled.can_break())
      throw std::invalid_argument(
          "the soft body to be cut touches with spheres; only bodies that touch with their surfaces break");
    if (breaks.is_breaking(coupled, *this)) {
      if (std::optional<Break> one = breaks.take(coupled)) put_pieces(coupled, one->pieces.get(), one->faces);
    }
    return coupled;
  }

  /// @throws std::invalid_argument  as find(); the body does not touch with its surface
  SurfaceBody& find_attachable(const SoftBody<3>& body) {
    if (SurfaceBody* const surface = with_surface(**find(body, "to be attached"))) {
      take_other_model(*surface);
      return *surface;
    }
    throw std::invalid_argument(
        "the soft body to be attached does not touch with its surface; attachments are solved with contacts "
        "of surfaces");
  }
  /// @throws std::invalid_argument  there are none
  SurfaceAttachments& attachments() {
    if (!surfaces) throw std::invalid_argument("bodies that touch with spheres have no attachments");
    return surfaces->attachments();
  }

  /// Wakes bodies that may sleep on a body which leaves its place, or may leave it.
  void tell_others(const CoupledBody& leaving) {
    if (!leaving.can_be_touched()) return;
    const Bounds<3> box = leaving.box();
    const std::optional<Bounds<3>> slept = leaving.box_asleep();
    wake_rigid_bodies(leaving);
    for (const auto& body : bodies) {
      if (body.get() == &leaving) continue;
      body->lose(leaving, box);
      if (slept) body->lose(leaving, *slept);
    }
  }

  /// Wakes what may sleep on the bodies of an attachment that ends or moves.
  void tell_others_of(AttachmentId id) {
    for (const SurfaceBody* const body : attachments().bodies_of(id))
      if (body != nullptr) tell_others(*body);
  }

  /// Wakes rigid bodies that may sleep on a soft body which leaves its place or changes: Bullet does not know that they lie on it.
  void wake_rigid_bodies(const CoupledBody& leaving) {
    if (!leaving.can_be_touched()) return;
    struct : btBroadphaseAabbCallback {
      bool process(const btBroadphaseProxy* proxy) override {
        static_cast<btCollisionObject*>(proxy->m_clientObject)->activate();
        return true;
      }
    } wake;
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(leaving.reach());
    const auto wake_in = [&](const Bounds<3>& box) {
      world.getBroadphase()->aabbTest(to_bullet(box.low - reach), to_bullet(box.high + reach), wake);
    };
    wake_in(leaving.box());
    if (const std::optional<Bounds<3>> slept = leaving.box_asleep()) wake_in(*slept);
  }

  btDiscreteDynamicsWorld& world;
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  // Of bodies that touch with their surfaces: either all that touch, or none.
  std::optional<SurfaceContacts> surfaces;
  std::vector<SurfaceBody*> with_surfaces;  // of `bodies`
  std::uint32_t next_number = 0;
  StepAhead<3> solve;                  // of `bodies`
  BreaksOfBodies breaks;               // of `bodies`
  std::optional<Workshop> workshop;    // until its work has ended
  std::vector<BrokenSoftBody> broken;  // since the last call that returned them
  std::optional<SleepSettings> sleep;
  SoftBodyTimes times;
};

BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world, ContactMethod contacts)
    : impl_(std::make_unique<Impl>(world, std::make_unique<PpuSolver<3>>(), contacts)) {}
BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world, SolverFactory& solvers,
                                   ContactMethod contacts)
    : impl_(std::make_unique<Impl>(
          world, solvers.make_solver(), contacts,
          contacts == ContactMethod::kSurface ? solvers.make_contact_worker() : nullptr)) {}
BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world, SoftBodySolver<3>& solver,
                                   ContactMethod contacts, std::shared_ptr<ContactWorker> worker)
    : impl_(std::make_unique<Impl>(world, solver, contacts, std::move(worker))) {}
BulletSoftBodies::~BulletSoftBodies() = default;

SoftBody<3>& BulletSoftBodies::add(std::shared_ptr<const SoftBodyModel<3>> model,
                                   const Eigen::Vector3f& position) {
  require_model(model.get());
  SC_ASSERT(position.allFinite(), "a soft body at ({}, {}, {})", position.x(), position.y(), position.z());
  if (model->settings().fracture && model->settings().contacts && !impl_->surfaces)
    throw std::invalid_argument(
        "a soft body with a fracture touches with spheres; only bodies that touch with their surfaces break");
  impl_->solve.drop();
  return impl_->add(SoftBody<3>(std::move(model), position));
}

void BulletSoftBodies::remove(const SoftBody<3>& body) {
  const auto found = impl_->find(body, "to be removed");
  impl_->solve.remove(body);
  impl_->breaks.forget(**found);
  impl_->tell_others(**found);
  if (impl_->surfaces) impl_->surfaces->forget(body);
  if (SurfaceBody* const surface = impl_->with_surface(**found)) {
    impl_->surfaces->attachments().forget(*surface);
    std::erase(impl_->with_surfaces, surface);
  }
  forget_removed(body, impl_->broken);
  const SoftBodyModel<3>* const model = body.shared_model().get();
  impl_->bodies.erase(found);
  if (impl_->surfaces) impl_->surfaces->forget_model(model);
}

std::vector<SoftBody<3>*> BulletSoftBodies::cut(const SoftBody<3>& body, const Cut& where) {
  CoupledBody& coupled = impl_->find_breakable(body);
  const std::vector<std::uint32_t> faces = faces_across(body, where);
  if (faces.empty()) return {};
  impl_->solve.drop();
  return impl_->break_body(coupled, faces);
}

bool BulletSoftBodies::begin_cut(const SoftBody<3>& body, const Cut& where) {
  CoupledBody& coupled = impl_->find_breakable(body);
  const std::vector<std::uint32_t> faces = faces_across(body, where);
  if (faces.empty()) return false;
  impl_->solve.drop();
  coupled.rouse();
  impl_->begin_break(coupled, faces, substeps_until_pieces(body.positions().size()));
  return true;
}

bool BulletSoftBodies::is_breaking(const SoftBody<3>& body) const {
  return impl_->breaks.is_breaking(**impl_->find(body, "that may be breaking"), *impl_);
}

std::vector<BrokenSoftBody> BulletSoftBodies::poll_broken() { return std::exchange(impl_->broken, {}); }

AttachmentId BulletSoftBodies::attach(const SoftBody<3>& body, const Patch<3>& patch,
                                      const AttachmentSettings<3>& settings) {
  SurfaceBody& attached = impl_->find_attachable(body);
  return impl_->surfaces->attachments().add(attached, patch, nullptr, settings);
}
AttachmentId BulletSoftBodies::attach(const SoftBody<3>& body, const Patch<3>& patch, btRigidBody& rigid,
                                      const AttachmentSettings<3>& settings) {
  SurfaceBody& attached = impl_->find_attachable(body);
  return impl_->surfaces->attachments().add(attached, patch, &rigid, settings);
}
AttachmentId BulletSoftBodies::attach(const SoftBody<3>& body, const Patch<3>& patch,
                                      const SoftBody<3>& other, const Patch<3>& other_patch,
                                      const AttachmentSettings<3>& settings) {
  SurfaceBody& attached = impl_->find_attachable(body);
  return impl_->surfaces->attachments().add(attached, patch, impl_->find_attachable(other), other_patch,
                                            settings);
}

void BulletSoftBodies::detach(AttachmentId id) {
  impl_->tell_others_of(id);
  impl_->attachments().remove(id);
}
void BulletSoftBodies::move_attachment(AttachmentId id, const Eigen::Vector3f& position,
                                       const Eigen::Quaternionf& rotation, float seconds) {
  impl_->tell_others_of(id);
  impl_->attachments().move(id, position, rotation, seconds);
}
std::optional<AttachmentState<3>> BulletSoftBodies::attachment(AttachmentId id) const {
  return impl_->surfaces ? impl_->surfaces->attachments().state(id) : std::nullopt;
}
std::optional<AttachmentEnds<3>> BulletSoftBodies::attachment_ends(AttachmentId id) const {
  return impl_->surfaces ? impl_->surfaces->attachments().ends(id) : std::nullopt;
}
std::vector<EndedAttachment> BulletSoftBodies::poll_ended_attachments() {
  return impl_->surfaces ? impl_->surfaces->attachments().take_ended() : std::vector<EndedAttachment>();
}

void BulletSoftBodies::begin_ahead(float step) {
  if (passes_time("BulletSoftBodies: a substep", step))
    timed(impl_->times.solve, [&] { impl_->solve.begin(step); });
}

void BulletSoftBodies::let_sleep(const std::optional<SleepSettings>& settings) {
  if (settings) validate(*settings);
  impl_->sleep = settings;
}

void BulletSoftBodies::append_contacts(std::vector<Contact>& contacts) const {
  if (impl_->surfaces) impl_->surfaces->append_contacts(contacts);
}

void BulletSoftBodies::set_filter(const SoftBody<3>& body, const CollisionFilter& filter) {
  const auto found = impl_->find(body, "that gets a filter");
  impl_->tell_others(**found);
  (*found)->set_filter(filter);
}

void BulletSoftBodies::watch_contacts(bool watch) {
  if (impl_->surfaces) impl_->surfaces->watch(watch);
}
std::vector<ContactEvent> BulletSoftBodies::poll_contact_events() {
  return impl_->surfaces ? impl_->surfaces->poll_events() : std::vector<ContactEvent>();
}

std::optional<SoftRayHit> BulletSoftBodies::cast_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                                                     const CollisionFilter& filter) const {
  SC_ASSERT(from.allFinite() && to.allFinite(), "a ray from ({}, {}, {})", from.x(), from.y(), from.z());
  std::optional<SoftRayHit> nearest;
  for (const auto& body : impl_->bodies) {
    if (!body->filter().may_touch(filter) || !is_any(way_in_box<3>(body->soft().bounds(), from, to - from)))
      continue;
    const auto hit = SurfaceQuery(body->soft()).cast_ray(from, to);
    if (hit && (!nearest || hit->share < nearest->hit.share)) nearest = SoftRayHit{&body->soft(), *hit};
  }
  return nearest;
}

CrushedCellCount BulletSoftBodies::crushed_cells() const { return count_crushed_cells(impl_->with_surfaces); }

SoftBodyTimes BulletSoftBodies::times() const { return impl_->times; }

std::size_t BulletSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody<3>& BulletSoftBodies::operator[](std::size_t index) {
  return const_cast<SoftBody<3>&>(std::as_const(*this)[index]);
}
const SoftBody<3>& BulletSoftBodies::operator[](std::size_t index) const {
  return body_at(impl_->bodies, index);
}

BulletSoftBodies::Particle BulletSoftBodies::particle_of(const btCollisionObject& object) {
  if (!ContactSphere::is_shape_of(object)) return {};
  return {static_cast<const SoftBody<3>*>(object.getUserPointer()),
          static_cast<std::size_t>(object.getUserIndex())};
}

}  // namespace softcell::ppu
