#include "simulation_3d.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "beginning_of.h"
#include "contact_images.h"
#include "cut_bodies.h"
#include "describe_refusal.h"
#include "grips/held_bodies.h"
#include "grips/rigid_grip.h"
#include "grips/surface_grip.h"
#include "input/controls.h"
#include "input/script_player.h"
#include "pins.h"
#include "ppu/bullet/bullet_world.h"
#include "rigid_bodies_3d.h"
#include "scene/shared_models.h"
#include "scene_bodies.h"
#include "shown_ropes.h"
#include "snapshots_3d.h"
#include "softcell/base/assert.h"
#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_solver.h"
#include "tilt.h"

namespace softcell::demos {
namespace {

constexpr float kReach = 1000;  // metres: beyond any scene

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// Makes the body's two ends along x turn against each other about x, with the middle at rest.
/// @param rate  rad/s, of one end relative to the other
void twist(ppu::SoftBody<3>& body, float rate) {
  if (rate == 0) return;
  const ppu::Bounds<3> box = body.bounds();
  SC_ASSERT(box.high.x() > box.low.x(), "a body from {} m to {} m along x is twisted", box.low.x(),
            box.high.x());
  const Eigen::Vector3f middle = 0.5f * (box.low + box.high);
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Eigen::Vector3f r = body.position(i) - middle;
    const float turn = rate * r.x() / (box.high.x() - box.low.x());
    body.add_particle_velocity(i, turn * Eigen::Vector3f::UnitX().cross(r));
  }
}

/// Whether a rigid body hides what is behind it. Obstacles do. @param number  at most bodies.size(), which stands for an obstacle
bool is_opaque(const RigidBodies3d& bodies, std::size_t number) {
  constexpr float kOpaque = 0.5f;
  return number == bodies.size() || bodies.opacity(number) >= kOpaque;
}

/// Whether the events put bodies elsewhere even if no time passes.
bool puts_elsewhere(std::span<const InputEvent<3>> events) {
  return std::any_of(events.begin(), events.end(), [](const InputEvent<3>& event) {
    return event.action == Action::kHome || event.action == Action::kReset;
  });
}

std::vector<std::shared_ptr<const ppu::SoftBodyModel<3>>> models_of(
    const std::vector<SoftBodyPlacement>& bodies) {
  return shared_models(
      bodies.size(),
      [&](std::size_t i, std::size_t j) {
        return bodies[i].settings == bodies[j].settings && bodies[i].strengths == bodies[j].strengths &&
               bodies[i].mesh == bodies[j].mesh;
      },
      [&](std::size_t i) {
        const std::vector<StrengthSlab<3>>& strengths = bodies[i].strengths;
        return describe_refusal(bodies[i].described, [&] {
          if (strengths.empty()) return ppu::make_soft_body_model(bodies[i].mesh, bodies[i].settings);
          return ppu::make_soft_body_model(
              bodies[i].mesh, bodies[i].settings,
              [&strengths](const Eigen::Vector3f& at) { return strength_at(strengths, at); });
        });
      });
}

}  // namespace

struct Simulation3d::State {
  State(const Scene& scene_description, const SimulationOptions& options)
      : scene(scene_description),
        script(scene.script),
        controls(initial_controls<3>(scene)),
        timing(options.timing),
        job_loop(options.job_loop()),
        match(options.kernel("match")),
        match_tiles(options.kernel("match_tiles")),
        strain(options.kernel("strain")),
        jobs(memory, options.spe_options(), job_loop),
        solver(make_solver(options.solver)),
        contacts(options.contacts.value_or(scene.contacts)),
        soft_bodies(world.world(), *solver, contacts, make_contact_worker(options)),
        rigid_bodies(scene, world) {
    if (scene.sleep) soft_bodies.let_sleep(ppu::SleepSettings{});
    if (options.skin == Skin::kSpe) {
      skin = options.kernel("skin");
      snapshots.skin_on_spes(memory, jobs, *skin);
    }
    SC_ASSERT(scene.substeps > 0, "{} substeps in a frame of scene '{}'", scene.substeps, scene.name);
    scene_bodies = SceneBodies<3>(models_of(scene.soft_bodies));
    for (std::size_t i = 0; i < scene_bodies.size(); ++i) {
      const SoftBodyPlacement& placement = scene.soft_bodies[i];
      describe_refusal(placement.described, [&] {
        twist(soft_bodies.add(scene_bodies.whole()[i], placement.position), placement.twist);
      });
    }
    check_cuts();
    attach();
    begin();
    snapshots.follow(soft_bodies);
    hand_over();
    snapshots.take_over();
  }

  /// The contacts of the bodies are computed where the bodies are stepped.
  std::shared_ptr<ppu::ContactWorker> make_contact_worker(const SimulationOptions& options) {
    if (on_spes == nullptr || contacts != ppu::ContactMethod::kSurface) return nullptr;
    return contact_images.emplace(options).make_worker(memory, jobs);
  }

  std::unique_ptr<ppu::SoftBodySolver<3>> make_solver(Solver wanted) {
    if (wanted == Solver::kReference) return std::make_unique<ppu::PpuSolver<3>>();
    auto made =
        std::make_unique<ppu::SpeSolver<3>>(memory, jobs, ppu::MatchKernels<3>{match, match_tiles, &strain});
    on_spes = made.get();
    return made;
  }

  /// Makes all attachments that the scene states, also those that have broken.
  void attach() {
    attachments = make_attachments<3>(scene, soft_bodies, [&](const AttachmentPlacement<3>& placement) {
      return rigid_bodies.of_attachment(placement);
    });
  }

  Eigen::Matrix3f present_tilt() const {
    const auto& stated = controls.tilt();
    return stated ? tilted_by(double{stated->x()}, double{stated->z()}) : tilt_at(scene.tilt, frame / 60);
  }

  /// Puts everything where the scene begins, if that is a moment of a run. Call it after attach(), which must see the bodies at rest in
  /// their places.
  void begin() {
    script_frame = scene.begin ? scene.begin->frames : 0;
    begin_again();
  }
  /// The same for a reset, which does not restart the script.
  void begin_again() {
    frame = scene.begin ? 60 * scene.begin->seconds : 0;
    if (!scene.begin) return;
    tilt = present_tilt();
    rigid_bodies.put_to(scene.begin->seconds);
    set_beginnings<3>(scene, soft_bodies);
    rigid_bodies.set_beginning();
    end_attachments(scene, attachments, soft_bodies);
    pins.replace(soft_bodies, scene.begin->pins);
  }
  Beginning<3> moment() const {
    if (const auto broken = scene_bodies.first_broken(soft_bodies))
      throw std::runtime_error(has_broken(scene.name, scene.soft_bodies[*broken].name));
    Beginning<3> now{.gravity = controls.gravity(),
                     .tilt = controls.tilt(),
                     .time_scale = controls.time_scale(),
                     .frames = script_frame,
                     .seconds = frame / 60,
                     .soft_bodies = {},
                     .rigid_bodies = rigid_bodies.state(),
                     .ended_attachments = ended_attachments(attachments, soft_bodies),
                     .pins = pins.saved(soft_bodies)};
    for (std::size_t b = 0; b < soft_bodies.size(); ++b) now.soft_bodies.push_back(state_of(soft_bodies[b]));
    return now;
  }

  /// Copies what a picture needs and starts the SPEs: first with the dynamics of the next step, then with the skinning. They work while the
  /// previous frame is drawn.
  void hand_over() {
    Snapshot3d& next = snapshots.next();
    next.box_poses.resize(rigid_bodies.size());
    for (std::size_t i = 0; i < rigid_bodies.size(); ++i) next.box_poses[i] = rigid_bodies.pose(i);
    next.tilt = tilt;
    copy_contacts(next);
    copy_hands(next);
    copy_ropes(next);
    snapshots.hand_over(scene_bodies.sources());
    soft_bodies.begin_ahead(substep());
  }

  /// Call it after a substep or a cut. Pieces are placed after all other bodies, and hands let go of what has broken.
  void adopt_pieces() {
    const std::vector<ppu::BrokenSoftBody> broken = soft_bodies.poll_broken();
    scene_bodies.add_pieces(soft_bodies, broken);
    for (const ppu::BrokenSoftBody& one : broken) let_go(number_in(soft_bodies, *one.body));
  }
  void let_go(std::size_t body) {
    controls.forget_body(body);
    held.forget(&soft_bodies[body]);
  }

  /// Refuses a scene that could not be played to its end. @throws std::runtime_error  a cut of a body that does not break
  void check_cuts() const {
    for (const ScriptedCut<3>& cut : scene.cuts)
      if (contacts == ppu::ContactMethod::kSpheres && soft_bodies[cut.body].model().settings().contacts)
        describe_refusal(cut.described, [] {
          throw std::invalid_argument(
              "the soft body to be cut touches with spheres; only bodies that touch with their surfaces "
              "break");
        });
  }

  /// Pieces appear some substeps later. In a pause, which has no substeps, they appear at once.
  void cut(const ppu::Cut& where, std::optional<std::size_t> source) {
    cut_bodies(soft_bodies, scene_bodies.sources(), source, controls.paused(), where);
    adopt_pieces();
  }

  void copy_contacts(Snapshot3d& snapshot) const {
    snapshot.contacts.clear();
    if (records_contacts && contacts_stand) {
      world.contacts(snapshot.contacts);
      soft_bodies.append_contacts(snapshot.contacts);
    }
  }

  /// A script's hands that hold particles are not shown: they only arrange the scene.
  void copy_hands(Snapshot3d& snapshot) const {
    snapshot.hands.clear();
    for (const Hands<3>::Held& hand : controls.hands().held()) {
      if (is_users_hand(hand.hand))
        snapshot.hands.push_back({soft_bodies[hand.body].position(hand.particle), hand.target});
    }
    held.append(snapshot.hands);
  }

  void copy_ropes(Snapshot3d& snapshot) const {
    snapshot.ropes.clear();
    append_ropes<3>(scene.attachments, attachments, soft_bodies, snapshot.ropes);
    pins.append(soft_bodies, snapshot.ropes);
  }

  // For Controls:
  void hold(const InputEvent<3>& event) {
    if (const auto nearest = Hands<3>::nearest_particle(event, soft_bodies))
      held.hold(event.hand, std::make_unique<SurfaceGrip>(soft_bodies[nearest->body], event.value));
  }
  void hold_rigid(const InputEvent<3>& event) {
    if (event.body < rigid_bodies.size() && rigid_bodies.mass(event.body) > 0)
      held.hold(event.hand, std::make_unique<RigidGrip>(rigid_bodies.bullet_body(event.body), event.value));
  }
  void set_material(const InputEvent<3>& event, std::size_t body) {
    scene_bodies.set_material(soft_bodies, event, body, substep());
  }
  /// Cuts for a user or a recording. No effect: a blade without area, and bodies whose contacts are spheres, which cannot be cut.
  void cut(const InputEvent<3>& event) {
    const bool has_area = event.edge.cast<double>().cross(event.way.cast<double>()).norm() > 0;
    if (!has_area || contacts == ppu::ContactMethod::kSpheres) return;
    cut(ppu::Cut::stroke(event.value, event.edge, event.way),
        event.body == kEveryBody ? std::nullopt : std::optional<std::size_t>(event.body));
  }
  void move_hand(const InputEvent<3>& event) { held.move(event.hand, event.value); }
  void release(std::uint32_t hand) { held.release(hand); }
  /// No effect on bodies whose contacts are spheres: they cannot be attached.
  void pin(std::uint32_t hand) {
    if (contacts == ppu::ContactMethod::kSpheres) return;
    if (const auto part = part_held_by<3>(hand, held, controls.hands(), soft_bodies))
      pins.add(soft_bodies, scene_bodies.source(number_in(soft_bodies, *part->body)), *part);
  }
  void unpin(const InputEvent<3>& event) { pins.remove(soft_bodies, event.body); }

  int substeps_of_frame() const { return controls.substeps(scene.substeps); }
  /// Seconds per substep.
  float substep() const { return kFrameSeconds / static_cast<float>(substeps_of_frame()); }

  /// Steps the world; hands pull before each substep.
  ppu::StepTimes step_world(int substeps) {
    const float step = substep();
    const Eigen::Vector3f gravity = tilt.transpose() * controls.gravity();
    held.begin_frame(static_cast<float>(substeps) * step);
    ppu::StepTimes times;
    for (int number = 0; number < substeps; ++number) {
      const double end_of_substep = frame / 60 - double{step} * (substeps - number - 1);
      rigid_bodies.move_to(end_of_substep);
      held.pull(number, substeps, gravity, step);
      const ppu::StepTimes of_substep = world.step(step, 1);
      times.physics_ms += of_substep.physics_ms;
      times.soft_body_ms += of_substep.soft_body_ms;
      adopt_pieces();
    }
    return times;
  }

  void reset() {
    held.release_all();
    world.reset();
    for (std::size_t b = 0; b < scene_bodies.size(); ++b) home(b);
    for (std::size_t b = 0; b < soft_bodies.size(); ++b)
      soft_bodies[b].set_material(soft_bodies[b].model().settings());
    for (const ppu::AttachmentId id : attachments)
      if (soft_bodies.attachment(id)) soft_bodies.detach(id);
    attach();
    tilt.setIdentity();
    begin_again();
  }
  void home(std::size_t body) {
    body = scene_bodies.source(body);
    pins.remove(soft_bodies, body);
    scene_bodies.make_whole(
        soft_bodies, body, [this](std::size_t b) { let_go(b); },
        [this](std::size_t b) { snapshots.remove(b); });
    soft_bodies[body].reset(scene.soft_bodies[body].position);
    twist(soft_bodies[body], scene.soft_bodies[body].twist);
  }

  const Scene& scene;
  ScriptPlayer<3> script;
  Controls<3> controls;
  ppu::BulletWorld world;

  const ls_sim::Timing* timing;  // null: nothing is timed
  dma::AddressSpace memory;
  ls_sim::KernelImage job_loop, match, match_tiles, strain;
  std::optional<ls_sim::KernelImage> skin;      // none: the GPU does it
  std::optional<ContactImages> contact_images;  // none: the PPU does it
  ppu::JobSystem jobs;
  const ppu::SpeSolver<3>* on_spes = nullptr;  // null: the PPU steps all bodies
  std::unique_ptr<ppu::SoftBodySolver<3>> solver;
  const ppu::ContactMethod contacts;
  ppu::BulletSoftBodies soft_bodies;
  RigidBodies3d rigid_bodies;
  std::vector<ppu::AttachmentId> attachments;  // of the scene, in order
  Snapshots3d snapshots;
  SceneBodies<3> scene_bodies;  // of `soft_bodies`
  HeldBodies<3> held;           // of `soft_bodies` and `world`
  Pins<3> pins;                 // of `soft_bodies`
  bool records_contacts = false;
  bool contacts_stand = true;  // false: bodies were put elsewhere after the world found its contacts

  Eigen::Matrix3f tilt = Eigen::Matrix3f::Identity();
  std::vector<InputEvent<3>> events;  // of the last step
  std::int64_t script_frame = 0;      // a reset does not restart it
  double frame = 0;                   // frames of 1/60 s that were simulated since the last reset
};

Simulation3d::Simulation3d(const Scene& scene, const SimulationOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}

Simulation3d::~Simulation3d() = default;

FrameTimes Simulation3d::step(std::span<const InputEvent<3>> events) {
  State& s = *state_;
  FrameTimes times;
  const std::int64_t at_frame = s.script_frame++;
  const auto scripted = s.script.events_at(at_frame);
  s.events.assign(scripted.begin(), scripted.end());
  s.events.insert(s.events.end(), events.begin(), events.end());
  s.controls.apply(s.events, s.soft_bodies, s);
  cut_as_planned(s.scene.cuts, at_frame, [&](const auto& where, std::size_t body) { s.cut(where, body); });
  const int substeps = s.controls.due_substeps(s.substeps_of_frame());
  if (substeps == 0) {
    finish();
    if (s.snapshots.follow(s.soft_bodies) || puts_elsewhere(s.events)) {
      s.contacts_stand = false;
      s.hand_over();
      finish();
    }
    s.copy_contacts(s.snapshots.shown());  // the world is as it is shown
    return times;
  }
  s.tilt = s.present_tilt();
  s.frame += static_cast<double>(substeps) / s.substeps_of_frame();
  s.world.set_gravity(s.tilt.transpose() * s.controls.gravity());
  s.controls.hands().pull(s.soft_bodies);
  const FrameOnPs3 on_ps3(s.timing);
  const ppu::SoftBodyTimes begin = s.soft_bodies.times();
  const ppu::StepTimes step = s.step_world(substeps);
  s.contacts_stand = true;

  const auto waiting = std::chrono::steady_clock::now();
  finish();
  times.skin_wait_ms = milliseconds_since(waiting);

  // New pieces have no previous frame to show, so this frame is shown at once.
  const bool is_broken = s.snapshots.follow(s.soft_bodies);
  s.hand_over();
  if (is_broken) finish();
  const ppu::SoftBodyTimes end = s.soft_bodies.times();
  times.physics_ms = step.physics_ms;
  times.gather_ms = milliseconds(end.gather - begin.gather);
  times.solve_ms = milliseconds(end.solve - begin.solve);
  times.apply_ms = milliseconds(end.apply - begin.apply);
  times.contacts_ms = milliseconds(end.contacts - begin.contacts);
  times.skin_ms = milliseconds(s.snapshots.skin_time());
  times.ppu_ms = times.gather_ms + times.solve_ms + times.apply_ms + times.contacts_ms + times.skin_ms;
  times.solver_wait_ms = milliseconds(end.wait - begin.wait);
  times.ps3_ms = on_ps3.milliseconds();
  return times;
}

void Simulation3d::finish() { state_->snapshots.take_over(); }

void Simulation3d::stop() {
  finish();
  state_->jobs.stop();
}

std::span<const InputEvent<3>> Simulation3d::last_events() const { return state_->events; }

std::size_t Simulation3d::soft_bodies() const { return state_->soft_bodies.size(); }
ppu::ContactMethod Simulation3d::contacts() const { return state_->contacts; }
std::size_t Simulation3d::bodies_on_ppu() const {
  return state_->on_spes != nullptr ? state_->on_spes->bodies_on_ppu() : soft_bodies();
}

std::size_t Simulation3d::particles() const {
  std::size_t sum = 0;
  for (const auto& body : state_->snapshots.positions()) sum += body.size();
  return sum;
}

std::size_t Simulation3d::vertices() const { return state_->snapshots.vertices(); }

Skin Simulation3d::skin() const { return state_->snapshots.skins_on_spes() ? Skin::kSpe : Skin::kGpu; }

std::size_t Simulation3d::rigid_bodies() const { return state_->rigid_bodies.with_mass(); }

const ppu::SoftBodyModel<3>& Simulation3d::model(std::size_t body) const {
  SC_ASSERT(body < soft_bodies(), "body {} of {}", body, soft_bodies());
  return state_->soft_bodies[body].model();
}
std::size_t Simulation3d::source(std::size_t body) const { return state_->scene_bodies.sources().at(body); }
const ppu::SoftBody<3>& Simulation3d::soft_body(std::size_t body) const { return state_->soft_bodies[body]; }

Beginning<3> Simulation3d::moment() const { return state_->moment(); }

std::uint64_t Simulation3d::state_hash() const {
  std::uint64_t hash = 0;
  for (std::size_t b = 0; b < soft_bodies(); ++b) hash = ppu::state_hash(soft_body(b), hash);
  return hash;
}

std::size_t Simulation3d::shown_bodies() const { return state_->snapshots.shown().particles.size(); }

ppu::SkinnedBody Simulation3d::shown(std::size_t body) const { return state_->snapshots.skinned(body); }

std::span<const Eigen::Vector4f> Simulation3d::shown_particles(std::size_t body) const {
  SC_ASSERT(body < shown_bodies(), "body {} of {}", body, shown_bodies());
  return state_->snapshots.shown().particles[body];
}

std::span<const Eigen::Matrix4f> Simulation3d::shown_box_poses() const {
  return state_->snapshots.shown().box_poses;
}

std::span<const ppu::Contact> Simulation3d::shown_contacts() const {
  return state_->snapshots.shown().contacts;
}

void Simulation3d::record_contacts(bool on) { state_->records_contacts = on; }

const Eigen::Matrix3f& Simulation3d::shown_tilt() const { return state_->snapshots.shown().tilt; }

void Simulation3d::show(Shown3d& to) const {
  to.bodies.resize(shown_bodies());
  for (std::size_t b = 0; b < shown_bodies(); ++b) {
    to.bodies[b].model = state_->snapshots.shown().models[b];
    to.bodies[b].source = state_->snapshots.shown().sources[b];
    const ppu::SkinnedBody skinned = shown(b);
    const auto particles = shown_particles(b);
    to.bodies[b].vertices.assign(skinned.vertices.begin(), skinned.vertices.end());
    to.bodies[b].origin = skinned.origin;
    to.bodies[b].particles.assign(particles.begin(), particles.end());
  }
  to.box_poses.assign(shown_box_poses().begin(), shown_box_poses().end());
  to.contacts.assign(shown_contacts().begin(), shown_contacts().end());
  to.hands = state_->snapshots.shown().hands;
  to.ropes = state_->snapshots.shown().ropes;
  to.tilt = shown_tilt();
}

std::optional<InputEvent<3>> Simulation3d::touch(const Ray& ray) const {
  SC_ASSERT(std::abs(ray.along.norm() - 1) < 1e-3f, "a ray along a direction {} long", ray.along.norm());
  const RigidBodies3d& rigid = state_->rigid_bodies;
  const Eigen::Vector3f end = ray.from + kReach * ray.along;
  std::optional<InputEvent<3>> touched;
  float share = 1;
  if (const auto soft = state_->soft_bodies.cast_ray(ray.from, end)) {
    const std::size_t body = number_in(state_->soft_bodies, *soft->body);
    touched = {
        .action = Action::kHold, .body = static_cast<std::uint32_t>(body), .value = soft->hit.position};
    share = soft->hit.share;
  }
  for (const ppu::BulletWorld::RayHit& hit : state_->world.cast_ray(ray.from, end)) {
    if (hit.share >= share) break;
    const std::size_t number = rigid.number_of(hit.body);
    if (number < rigid.size() && rigid.mass(number) > 0)
      return InputEvent<3>{
          .action = Action::kHoldRigid, .body = static_cast<std::uint32_t>(number), .value = hit.position};
    if (is_opaque(rigid, number)) return std::nullopt;
  }
  return touched;
}

std::optional<Eigen::Vector3f> Simulation3d::seen_along(const Ray& ray) const {
  const RigidBodies3d& rigid = state_->rigid_bodies;
  const Eigen::Vector3f end = ray.from + kReach * ray.along;
  std::optional<Eigen::Vector3f> seen;
  float share = 1;
  if (const auto soft = state_->soft_bodies.cast_ray(ray.from, end))
    seen = soft->hit.position, share = soft->hit.share;
  for (const ppu::BulletWorld::RayHit& hit : state_->world.cast_ray(ray.from, end)) {
    if (hit.share >= share) break;
    if (is_opaque(rigid, rigid.number_of(hit.body))) return hit.position;
  }
  return seen;
}

bool Simulation3d::is_free(const ppu::Bounds<3>& box) const {
  for (std::size_t b = 0; b < soft_bodies(); ++b) {
    const ppu::SoftBody<3>& body = soft_body(b);
    const Eigen::Array3f low = box.low.array() - body.settings().cell_size;
    const Eigen::Array3f high = box.high.array() + body.settings().cell_size;
    if (std::ranges::any_of(body.positions(), [&](const Eigen::Vector3f& x) {
          return (x.array() > low).all() && (x.array() < high).all();
        }))
      return false;
  }
  return state_->world.is_free(box.low, box.high);
}

std::string Simulation3d::name_of(const ppu::Contact::Body& body) const {
  State& s = *state_;
  for (std::size_t b = 0; b < soft_bodies(); ++b) {
    if (&soft_body(b) != body.soft) continue;
    const std::string& name = s.scene.soft_bodies[source(b)].name;
    return soft_body(b).model().is_piece() ? "a piece of " + name : name;
  }
  for (std::size_t i = 0; i < s.world.rigid_bodies(); ++i)
    if (&s.world.rigid_body(i) == body.object) return s.rigid_bodies.name_of(i);
  return "a body that is gone";
}

bool Simulation3d::paused() const { return state_->controls.paused(); }
float Simulation3d::time_scale() const { return state_->controls.time_scale(); }
int Simulation3d::substeps() const { return state_->substeps_of_frame(); }
const Eigen::Vector3f& Simulation3d::gravity() const { return state_->controls.gravity(); }

std::vector<ls_sim::SpeStatistics> Simulation3d::spe_statistics() const { return state_->jobs.statistics(); }

}  // namespace softcell::demos
