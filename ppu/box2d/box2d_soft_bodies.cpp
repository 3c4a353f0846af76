#include "softcell/box2d/box2d_soft_bodies.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "ppu/bodies/breaks.h"
#include "ppu/bodies/checked_arguments.h"
#include "ppu/bodies/processor_time.h"
#include "ppu/bodies/step_ahead.h"
#include "ppu/bodies/workshop.h"
#include "ppu/box2d/box2d_attachments.h"
#include "ppu/box2d/box2d_body.h"
#include "ppu/box2d/box2d_filter.h"
#include "ppu/box2d/circle_body.h"
#include "ppu/box2d/one_of_its_world.h"
#include "ppu/box2d/parting_pieces.h"
#include "ppu/box2d/rest.h"
#include "ppu/box2d/surface_contacts_2d.h"
#include "ppu/contacts/crushed_cells.h"
#include "ppu/surfaces/way_in_box.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {

using Eigen::Vector2f;

struct Box2dSoftBodies::Impl {
  /// @param solver  a SoftBodySolver<2>, or the pointer that owns one
  template <typename Solver>
  Impl(b2World& w, Solver&& solver, ContactMethod contacts, std::shared_ptr<ContactWorker> worker)
      : one_of_its_world(w),
        world(w),
        rest(w, [this](const b2Body& body) { return soft_body_of(body); }),
        filter(w,
               [this](const b2Fixture& a, const b2Fixture& b) {
                 return attachments.may_touch(*a.GetBody(), *b.GetBody()) &&
                        parting.may_touch(*a.GetBody(), *b.GetBody());
               }),
        attachments(
            w, [this](const b2Body& body) { return soft_body_of(body); }, filter),
        solve(std::forward<Solver>(solver)),
        workshop(std::in_place) {
    if (contacts == ContactMethod::kSurface) surfaces.emplace(world, std::move(worker));
  }
  ~Impl() { workshop.reset(); }  // its threads use all of this

  void begin_step(float step) {
    SC_ASSERT(step > 0 && std::isfinite(step), "a time step of {} s", step);
    SC_ASSERT(!world.IsLocked(), "a step of {} s within a step of Box2D", step);
    SC_ASSERT(!begun, "begin_step({} s) after begin_step({} s), without end_step() in between", step, *begun);
    timed(times.gather, [&] {
      if (!solve.has_begun(step) || std::ranges::any_of(bodies, [](const auto& body) {
            return body->was_changed() || body->was_pushed();
          })) {
        solve.drop();
        for (const auto& body : bodies) {
          if (body->was_reset()) solve.forget(body->soft());
          if (body->is_of_other_model()) take_other_model(*body);
          if (surfaces && body->was_changed()) surfaces->tell_those_on(*body);
          body->begin_step();
        }
      }
    });
    timed(times.solve, [&] { times.wait += solve.finish(step); });
    timed(times.apply, [&] {
      breaks.test_late(solve, *this);
      if (!surfaces) attachments.solve(bodies, step);
      for (const auto& body : bodies) body->hand_over(step);
    });
    if (surfaces) timed(times.contacts, [&] { surfaces->step(bodies, attachments, step); });
    begun = step;
  }

  void end_step(float step) {
    SC_ASSERT(!world.IsLocked(), "end_step({} s) within a step of Box2D", step);
    SC_ASSERT(begun == step, "end_step({} s) after begin_step({} s)", step, begun.value_or(0));
    begun.reset();
    timed(times.gather, [&] {
      for (const auto& body : bodies) body->end_step(step);
      parting.update();
      break_strained();
      if (sleep) let_sleep(step);
    });
  }

  /// @pre bodies may sleep
  void let_sleep(float step) {
    // What the program moves is never still, however slow it is.
    for (const auto& body : bodies)
      if (!body->soft().asleep())
        body->count_stillness(step, attachments.is_being_moved(*body) ? 0 : sleep->speed);
    if (surfaces) surfaces->forget_destroyed();
    neighbours.soft.clear();
    neighbours.rigid.clear();
    if (surfaces) neighbours = surfaces->touches();
    attachments.append_neighbours(neighbours);
    for (const auto& body : bodies) {
      if (body->soft().asleep()) continue;
      for (Box2dBody* const resting : rest.settle(*body, *sleep, neighbours))
        if (surfaces) surfaces->let_lie(*resting);
    }
  }

  /// Null if the b2Body is not a particle.
  Box2dBody* soft_body_of(const b2Body& body) const {
    const auto found = particles.find(&body);
    return found == particles.end() ? nullptr : found->second.body;
  }

  /// @throws std::invalid_argument
  auto find(const SoftBody<2>& body, const char* purpose) {
    return find_coupled(bodies, body, purpose, "Box2dSoftBodies");
  }
  Box2dBody& find_attachable(const SoftBody<2>& body) {
    Box2dBody& coupled = **find(body, "to be attached");
    if (coupled.is_of_other_model()) take_other_model(coupled);
    return coupled;
  }
  /// The body, after its running break has ended, with its particles as in Box2D. @throws as above
  Box2dBody& find_breakable(const SoftBody<2>& body) {
    Box2dBody& coupled = **find(body, "to be cut");
    SC_ASSERT(!world.IsLocked(), "one of {} bodies is cut within a step of Box2D", bodies.size());
    if (coupled.is_of_other_model()) take_other_model(coupled);
    if (breaks.is_breaking(coupled, *this)) {
      if (std::optional<Break> one = breaks.take(coupled))
        put_pieces_if_room(coupled, one->pieces.get(), one->faces);
    }
    coupled.take_over_particles();
    return coupled;
  }

  static constexpr std::size_t kMostBodies = 32768;  // one for each negative group
  bool has_groups(std::size_t more) const { return surfaces || bodies.size() + more <= kMostBodies; }
  /// @throws std::runtime_error  there would be too many bodies
  void require_groups(std::size_t more) const {
    if (!has_groups(more))
      throw std::runtime_error("a Box2D world has at most " + std::to_string(kMostBodies) +
                               " soft bodies: there are no more collision groups");
  }
  /// The unused negative group nearest to 0.
  std::int16_t free_group() const {
    std::vector<bool> used(kMostBodies + 1);
    for (const auto& body : bodies)
      used[static_cast<std::size_t>(-static_cast<const CircleBody&>(*body).group())] = true;
    const auto free = std::find(used.begin() + 1, used.end(), false);
    SC_ASSERT(free != used.end(), "{} bodies have all groups", bodies.size());
    return static_cast<std::int16_t>(-(free - used.begin()));
  }

  std::unique_ptr<Box2dBody> make_body(SoftBody<2> body) const {
    if (surfaces) return std::make_unique<Box2dBody>(world, std::move(body));
    return std::make_unique<CircleBody>(world, std::move(body), free_group());
  }
  /// @throws std::runtime_error  there are too many bodies
  Box2dBody& add(SoftBody<2> body) {
    require_groups(1);
    Box2dBody& added = *bodies.emplace_back(make_body(std::move(body)));
    know_particles(added);
    solve.add(added.soft());
    return added;
  }
  void know_particles(Box2dBody& body) {
    const auto outer = body.soft().model().outer();
    for (std::size_t i = 0; i < body.particles().size(); ++i)
      particles[body.particles()[i]] = {&body, outer[i]};
  }
  void forget_particles(const Box2dBody& body) {
    for (const b2Body* const particle : body.particles()) particles.erase(particle);
  }
  /// Gives a body the particles of its model. @return the pairs with the old particles that did not touch
  std::vector<PartingPieces::Kept> follow_model(Box2dBody& body) {
    std::vector<PartingPieces::Kept> kept = parting.take(body);
    forget_particles(body);
    body.follow_model();
    know_particles(body);
    return kept;
  }
  /// Handles another model by an assignment.
  void take_other_model(Box2dBody& body) {
    attachments.forget(body);
    follow_model(body);
  }

  /// Pieces, and the contact models of those that stay, if bodies touch with their drawn edges.
  struct Pieces {
    PlannedPieces<2> planned;
    std::vector<std::unique_ptr<SurfaceContacts2d::Model>> touching;
  };
  using BreaksOfBodies = Breaks<2, Box2dBody, Pieces>;
  using Break = BreaksOfBodies::Break;

  void break_strained() {
    breaks.test(bodies, *this);
    for (Break& one : breaks.take_due()) put_pieces_if_room(*one.body, one.pieces.get(), one.faces);
  }

  /// @param steps  from now until the pieces appear
  void begin_break(Box2dBody& body, std::span<const std::uint32_t> faces, int steps) {
    if (steps == 0) {
      put_pieces_if_room(body, make_pieces(body, faces), faces.size());
      return;
    }
    const std::shared_ptr<const SoftBodyModel<2>>& model = body.soft().shared_model();
    breaks.begin(body, faces.size(), steps,
                 workshop->begin([this, model, own = std::vector<std::uint32_t>(faces.begin(), faces.end()),
                                  least_cells = least_cells_of(body.soft()), whole = whole_of(model)] {
                   return make_pieces(model, own, least_cells, whole);
                 }));
  }

  /// Null: bodies touch with circles.
  std::shared_ptr<const SurfaceContacts2d::Model> whole_of(
      const std::shared_ptr<const SoftBodyModel<2>>& model) {
    return surfaces ? surfaces->whole_of(model) : nullptr;
  }

  /// May run on any thread. @param least_cells  as plan_pieces()  @param whole  whole_of() the model
  Pieces make_pieces(const std::shared_ptr<const SoftBodyModel<2>>& model,
                     std::span<const std::uint32_t> faces, std::uint32_t least_cells,
                     const std::shared_ptr<const SurfaceContacts2d::Model>& whole) {
    Pieces pieces{plan_pieces(model, faces, least_cells), {}};
    for (const BodyPiece<2>& piece : pieces.planned.stay) {
      solve.prepare(piece.body.shared_model());
      if (whole != nullptr)
        pieces.touching.push_back(SurfaceContacts2d::make_piece(piece.body.shared_model(), *whole));
    }
    return pieces;
  }

  Pieces make_pieces(const Box2dBody& body, std::span<const std::uint32_t> faces) {
    const std::shared_ptr<const SoftBodyModel<2>>& model = body.soft().shared_model();
    return make_pieces(model, faces, least_cells_of(body.soft()), whole_of(model));
  }

  /// @param faces  that broke   @return the pieces that stay, except for the body itself
  /// @throws std::runtime_error  there are too many pieces; nothing has changed then
  std::vector<SoftBody<2>*> put_pieces(Box2dBody& body, Pieces made, std::size_t faces) {
    std::vector<BodyPiece<2>>& planned = made.planned.stay;
    require_groups(planned.size() - 1);
    for (auto& touching : made.touching) surfaces->adopt(std::move(touching));
    solve.drop();
    if (body.soft().asleep()) body.wake();
    const Eigen::Vector2d centre = body.soft().precise_centre_of_mass();
    for (BodyPiece<2>& piece : planned) piece.body.inherit_state(body.soft(), piece.particle_of, centre);
    const std::shared_ptr<const SoftBodyModel<2>> whole = body.soft().shared_model();
    std::vector<Box2dBody*> pieces{&body};
    for (std::size_t i = 1; i < planned.size(); ++i) {
      pieces.push_back(&add(std::move(planned[i].body)));
      pieces.back()->set_filter(body.filter());
    }
    body.soft() = std::move(planned.front().body);
    const std::vector<PartingPieces::Kept> kept = follow_model(body);

    BrokenSoftBody2d& event = broken.emplace_back();
    event.body = &body.soft();
    event.faces = faces;
    event.vanished = made.planned.vanished.size();
    std::vector<Box2dAttachments::Piece> with_attachments;
    std::vector<SurfaceContacts2d::Piece> that_touch;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      parting.keep(kept, *pieces[i], planned[i].particle_of);
      with_attachments.push_back({pieces[i], planned[i].particle_of});
      that_touch.push_back({pieces[i], planned[i].particle_of});
      if (i > 0) event.pieces.push_back(&pieces[i]->soft());
    }
    if (surfaces) {
      surfaces->follow_pieces(body, *whole, that_touch);
      surfaces->forget_model(whole.get());
    } else {
      parting.add(pieces);
      if (!parting.empty()) filter.install();
    }
    attachments.follow_pieces(body, with_attachments, made.planned.vanished);
    for (BodyPiece<2>& piece : planned) event.particles_before.push_back(std::move(piece.particle_of));
    return event.pieces;
  }

  /// In a step: a program can do nothing there about a body that finds no groups for its pieces. So the body stays whole.
  void put_pieces_if_room(Box2dBody& body, Pieces made, std::size_t faces) {
    if (has_groups(made.planned.stay.size() - 1)) put_pieces(body, std::move(made), faces);
  }

  /// A query of the outline as it is drawn now.
  SurfaceQuery<2> query(const SoftBody<2>& soft) {
    return surfaces ? SurfaceQuery<2>(soft, surfaces->skin(soft.shared_model())) : SurfaceQuery<2>(soft);
  }

  /// The particle that a b2Body stands for.
  struct OneParticle {
    Box2dBody* body;
    std::size_t number;
  };

  OneOfItsWorld one_of_its_world;
  b2World& world;
  std::vector<std::unique_ptr<Box2dBody>> bodies;
  std::unordered_map<const b2Body*, OneParticle> particles;
  Rest rest;
  Box2dFilter filter;
  Box2dAttachments attachments;
  PartingPieces parting;
  std::optional<SurfaceContacts2d> surfaces;  // none: bodies touch with circles
  std::optional<SleepSettings> sleep;
  SoftNeighbours neighbours;   // while it is decided who falls asleep
  std::optional<float> begun;  // seconds, between begin_step() and end_step()
  SoftBodyTimes times;
  StepAhead<2> solve;                    // of `bodies`
  BreaksOfBodies breaks;                 // of `bodies`
  std::vector<BrokenSoftBody2d> broken;  // since the last call that returned them
  std::optional<Workshop> workshop;      // until its work has ended
};

Box2dSoftBodies::Box2dSoftBodies(b2World& world, ContactMethod contacts)
    : impl_(std::make_unique<Impl>(world, std::make_unique<PpuSolver<2>>(), contacts, nullptr)) {}
Box2dSoftBodies::Box2dSoftBodies(b2World& world, SolverFactory& solvers, ContactMethod contacts)
    : impl_(std::make_unique<Impl>(
          world, solvers.make_solver_2d(), contacts,
          contacts == ContactMethod::kSurface ? solvers.make_contact_worker() : nullptr)) {}
Box2dSoftBodies::Box2dSoftBodies(b2World& world, SoftBodySolver<2>& solver, ContactMethod contacts,
                                 std::shared_ptr<ContactWorker> worker)
    : impl_(std::make_unique<Impl>(world, solver, contacts, std::move(worker))) {}
Box2dSoftBodies::~Box2dSoftBodies() = default;

SoftBody<2>& Box2dSoftBodies::add(std::shared_ptr<const SoftBodyModel<2>> model, const Vector2f& position,
                                  const Skin2d* drawn) {
  require_model(model.get());
  SC_ASSERT(position.allFinite(), "a soft body at ({}, {})", position.x(), position.y());
  SC_ASSERT(!impl_->world.IsLocked(), "add() of body {} within a step of Box2D", impl_->bodies.size());
  if (drawn != nullptr) {
    validate(*drawn, model->lattice());
    if (drawn->outlines.empty())
      throw std::invalid_argument("a skin of " + std::to_string(drawn->rest.size()) +
                                  " vertices has no outlines; with these a body touches");
  }
  impl_->solve.drop();
  if (impl_->surfaces && drawn != nullptr) impl_->surfaces->draw(model, *drawn);
  return impl_->add(SoftBody<2>(std::move(model), position)).soft();
}

void Box2dSoftBodies::remove(const SoftBody<2>& body) {
  const auto found = impl_->find(body, "to be removed");
  SC_ASSERT(!impl_->world.IsLocked(), "remove() of one of {} bodies within a step of Box2D",
            impl_->bodies.size());
  impl_->solve.remove(body);
  impl_->breaks.forget(**found);
  impl_->parting.take(**found);
  impl_->attachments.forget(**found);
  impl_->forget_particles(**found);
  forget_removed(body, impl_->broken);
  if (impl_->surfaces) impl_->surfaces->forget(**found);
  const SoftBodyModel<2>* const model = body.shared_model().get();
  impl_->bodies.erase(found);
  if (impl_->surfaces) impl_->surfaces->forget_model(model);
}

std::vector<SoftBody<2>*> Box2dSoftBodies::cut(const SoftBody<2>& body, const Cut2d& where) {
  Box2dBody& coupled = impl_->find_breakable(body);
  const std::vector<std::uint32_t> faces = faces_across(body, where);
  if (faces.empty()) return {};
  return impl_->put_pieces(coupled, impl_->make_pieces(coupled, faces), faces.size());
}

bool Box2dSoftBodies::begin_cut(const SoftBody<2>& body, const Cut2d& where) {
  Box2dBody& coupled = impl_->find_breakable(body);
  const std::vector<std::uint32_t> faces = faces_across(body, where);
  if (faces.empty()) return false;
  const int steps = substeps_until_pieces(body.positions().size());
  if (steps == 0) {
    impl_->put_pieces(coupled, impl_->make_pieces(coupled, faces), faces.size());
    return true;
  }
  impl_->solve.drop();
  if (coupled.soft().asleep()) coupled.wake();
  impl_->begin_break(coupled, faces, steps);
  return true;
}

bool Box2dSoftBodies::is_breaking(const SoftBody<2>& body) const {
  return impl_->breaks.is_breaking(**impl_->find(body, "that may be breaking"), *impl_);
}

std::vector<BrokenSoftBody2d> Box2dSoftBodies::poll_broken() { return std::exchange(impl_->broken, {}); }

AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch,
                                     const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find_attachable(body), patch, nullptr, settings);
}
AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch, b2Body& rigid,
                                     const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find_attachable(body), patch, &rigid, settings);
}
AttachmentId Box2dSoftBodies::attach(const SoftBody<2>& body, const Patch<2>& patch, const SoftBody<2>& other,
                                     const Patch<2>& other_patch, const AttachmentSettings<2>& settings) {
  return impl_->attachments.add(impl_->find_attachable(body), patch, impl_->find_attachable(other),
                                other_patch, settings);
}
void Box2dSoftBodies::detach(AttachmentId id) { impl_->attachments.remove(id); }
void Box2dSoftBodies::move_attachment(AttachmentId id, const Vector2f& position, float angle, float seconds) {
  impl_->attachments.move(id, position, angle, seconds);
}
std::optional<AttachmentState<2>> Box2dSoftBodies::attachment(AttachmentId id) const {
  return impl_->attachments.state(id);
}
std::optional<AttachmentEnds<2>> Box2dSoftBodies::attachment_ends(AttachmentId id) const {
  return impl_->attachments.ends(id);
}
std::vector<EndedAttachment> Box2dSoftBodies::poll_ended_attachments() {
  return impl_->attachments.take_ended();
}

void Box2dSoftBodies::set_filter(const SoftBody<2>& body, const CollisionFilter& filter) {
  Box2dBody& coupled = **impl_->find(body, "to get a filter");
  if (coupled.soft().asleep()) coupled.wake();
  coupled.set_filter(filter);
  if (impl_->surfaces) impl_->surfaces->tell_those_on(coupled);
}

static constexpr const char* kStep = "Box2dSoftBodies: a step";

void Box2dSoftBodies::step(float step, int velocity_iterations, int position_iterations) {
  begin_step(step);
  impl_->world.Step(step, velocity_iterations, position_iterations);
  end_step(step);
}

void Box2dSoftBodies::begin_step(float step) {
  if (passes_time(kStep, step)) impl_->begin_step(step);
}

void Box2dSoftBodies::end_step(float step) {
  if (passes_time(kStep, step)) impl_->end_step(step);
}

void Box2dSoftBodies::begin_ahead(float step) {
  if (passes_time(kStep, step)) timed(impl_->times.solve, [&] { impl_->solve.begin(step); });
}

void Box2dSoftBodies::shift_origin(const Vector2f& new_origin) {
  if (!new_origin.allFinite())
    throw std::invalid_argument("Box2dSoftBodies: an origin at (" + base::shortest(new_origin.x()) + ", " +
                                base::shortest(new_origin.y()) + ") m; expected are finite numbers");
  SC_ASSERT(!impl_->world.IsLocked(), "the origin of {} bodies is moved within a step of Box2D",
            impl_->bodies.size());
  impl_->solve.drop();
  impl_->world.ShiftOrigin(to_box2d(new_origin));
  for (const auto& body : impl_->bodies) body->shift(-new_origin);
  impl_->attachments.shift(-new_origin);
  if (impl_->surfaces) impl_->surfaces->shift(-new_origin);
}

void Box2dSoftBodies::let_sleep(const std::optional<SleepSettings>& settings) {
  if (settings) validate(*settings);
  impl_->solve.drop();
  impl_->sleep = settings;
  if (settings) return;
  for (const auto& body : impl_->bodies)
    if (body->soft().asleep()) body->wake();
}

std::size_t Box2dSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) {
  return const_cast<SoftBody<2>&>(std::as_const(*this)[index]);
}
const SoftBody<2>& Box2dSoftBodies::operator[](std::size_t index) const {
  return body_at(impl_->bodies, index);
}

Box2dSoftBodies::Particle Box2dSoftBodies::particle_of(const b2Body& body) const {
  const auto found = impl_->particles.find(&body);
  if (found == impl_->particles.end()) return {};
  return {&found->second.body->soft(), found->second.number};
}

void Box2dSoftBodies::append_contacts(std::vector<Contact2d>& contacts) const {
  if (impl_->surfaces) impl_->surfaces->append_contacts(contacts);
}

void Box2dSoftBodies::watch_contacts(bool watch) {
  if (impl_->surfaces) impl_->surfaces->watch(watch);
}
std::vector<ContactEvent2d> Box2dSoftBodies::poll_contact_events() {
  return impl_->surfaces ? impl_->surfaces->poll_events() : std::vector<ContactEvent2d>();
}

std::optional<SoftRayHit2d> Box2dSoftBodies::cast_ray(const Eigen::Vector2f& from, const Eigen::Vector2f& to,
                                                      const CollisionFilter& filter) const {
  SC_ASSERT(from.allFinite() && to.allFinite(), "a ray from ({}, {})", from.x(), from.y());
  std::optional<SoftRayHit2d> nearest;
  for (const auto& body : impl_->bodies) {
    const SoftBody<2>& soft = body->soft();
    // The drawn outline reaches at most half a cell beyond the particles. That half may be stretched, but not by more than the body's size.
    const Bounds<2> box = soft.bounds();
    const Eigen::Vector2f size = box.high - box.low;
    if (!body->filter().may_touch(filter) ||
        !is_any(way_in_box<2>({box.low - size, box.high + size}, from, to - from)))
      continue;
    const auto hit = impl_->query(soft).cast_ray(from, to);
    if (hit && (!nearest || hit->share < nearest->hit.share)) nearest = SoftRayHit2d{&soft, *hit};
  }
  return nearest;
}

SoftBodyTimes Box2dSoftBodies::times() const { return impl_->times; }

CrushedCellCount Box2dSoftBodies::crushed_cells() const {
  return impl_->surfaces ? count_crushed_cells(impl_->bodies) : CrushedCellCount();
}

}  // namespace softcell::ppu
