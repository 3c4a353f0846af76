#include "simulation_2d.h"

#include <box2d/b2_body.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_polygon_shape.h>
#include <box2d/b2_world.h>
#include <box2d/b2_world_callbacks.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <variant>

#include <fmt/format.h>

#include "beginning_of.h"
#include "contact_images.h"
#include "cut_bodies.h"
#include "describe_refusal.h"
#include "grips/followed_particle.h"
#include "grips/held_bodies.h"
#include "grips/rigid_grip_2d.h"
#include "grips/soft_grip_2d.h"
#include "input/controls.h"
#include "input/script_player.h"
#include "pins.h"
#include "scene/shared_models.h"
#include "scene_bodies.h"
#include "shown_ropes.h"
#include "softcell/base/assert.h"
#include "softcell/box2d/box2d_soft_bodies.h"
#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_solver.h"
#include "timed_solver.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Models = std::vector<std::shared_ptr<const ppu::SoftBodyModel<2>>>;

b2Vec2 to_box2d(const Vector2f& v) { return {v.x(), v.y()}; }

struct MakeShape {
  b2Body& body;
  b2FixtureDef fixture;

  void operator()(const Box2dShape& box) {
    add_polygon([&](auto& p) { p.SetAsBox(box.size.x() / 2, box.size.y() / 2); });
  }
  void operator()(const PolygonShape& polygon) {
    SC_ASSERT(polygon.corners.size() >= 3, "a polygon of {} corners", polygon.corners.size());
    std::array<b2Vec2, b2_maxPolygonVertices> corners;
    SC_ASSERT(polygon.corners.size() <= corners.size(), "a polygon of {} corners, of at most {}",
              polygon.corners.size(), corners.size());
    std::transform(polygon.corners.begin(), polygon.corners.end(), corners.begin(), to_box2d);
    add_polygon([&](auto& p) { p.Set(corners.data(), static_cast<int>(polygon.corners.size())); });
  }
  void operator()(const CircleShape& circle) {
    b2CircleShape shape;
    SC_ASSERT(circle.radius > 0, "a circle with a radius of {} m", circle.radius);
    shape.m_radius = circle.radius;
    add(shape);
  }

 private:
  template <class Set>
  void add_polygon(const Set& set) {
    b2PolygonShape shape;
    set(shape);
    add(shape);
  }
  void add(const b2Shape& shape) {
    fixture.shape = &shape;
    body.CreateFixture(&fixture);
  }
};

b2Body* add_rigid_body(b2World& world, const RigidBody2d& rigid, float friction, float restitution) {
  b2BodyDef definition;
  definition.type = rigid.mass > 0 ? b2_dynamicBody : b2_staticBody;
  definition.position = to_box2d(rigid.position);
  definition.angle = rigid.angle;
  b2Body* const body = world.CreateBody(&definition);
  b2FixtureDef fixture;
  fixture.density = 1;
  fixture.friction = friction;
  fixture.restitution = restitution;
  std::visit(MakeShape{*body, fixture}, rigid.shape);
  if (rigid.mass > 0) {
    b2MassData mass;
    body->GetMassData(&mass);
    SC_ASSERT(mass.mass > 0, "a shape of density 1 has a mass of {} kg", mass.mass);
    mass.I *= rigid.mass / mass.mass;
    mass.mass = rigid.mass;
    body->SetMassData(&mass);
  }
  return body;
}

/// Everything that moves. A reset makes a new one, so that no contact or impulse is left over.
struct World {
  World(const Scene2d& scene, const Models& models, ppu::SoftBodySolver<2>& solver,
        ppu::ContactMethod contacts, std::shared_ptr<ppu::ContactWorker> worker)
      : soft_bodies(world, solver, contacts, std::move(worker)) {
    SC_ASSERT(models.size() == scene.soft_bodies.size(), "the models of {} bodies of {}", models.size(),
              scene.soft_bodies.size());
    world.SetAllowSleeping(scene.sleep);
    if (scene.sleep) soft_bodies.let_sleep(ppu::SleepSettings{});
    for (const RigidBody2d& body : scene.rigid_bodies)
      rigid_bodies.push_back(add_rigid_body(world, body, scene.friction, scene.restitution));
    for (std::size_t i = 0; i < models.size(); ++i) {
      const SoftBody2dPlacement& body = scene.soft_bodies[i];
      const bool is_first =
          std::ranges::find(models, models[i]) - models.begin() == static_cast<std::ptrdiff_t>(i);
      std::optional<ppu::Skin2d> skin;
      if (is_first && contacts == ppu::ContactMethod::kSurface) skin = body.skin(models[i]->lattice());
      describe_refusal(body.described,
                       [&] { soft_bodies.add(models[i], body.position, skin ? &*skin : nullptr); });
    }
    attach(scene);
    if (scene.begin) begin(scene);
  }

  /// Sleeping rigid bodies do not notice a change of gravity by themselves, so they are woken; soft bodies do notice it.
  void set_gravity(const b2Vec2& gravity) {
    if (gravity == world.GetGravity()) return;
    world.SetGravity(gravity);
    for (b2Body* const body : rigid_bodies)
      if (body->GetType() == b2_dynamicBody) body->SetAwake(true);
  }

  /// @param substep  seconds   @return the elapsed time in Box2D
  std::chrono::nanoseconds step(float substep) {
    constexpr int kVelocityIterations = 8, kPositionIterations = 3;
    soft_bodies.begin_step(substep);
    const auto begin = std::chrono::steady_clock::now();
    world.Step(substep, kVelocityIterations, kPositionIterations);
    const auto took = std::chrono::steady_clock::now() - begin;
    soft_bodies.end_step(substep);
    return took;
  }

  void attach(const Scene2d& scene) {
    attachments = make_attachments<2>(scene, soft_bodies, [&](const AttachmentPlacement<2>& placement) {
      return placement.rigid ? rigid_bodies[*placement.rigid] : nullptr;
    });
  }

  /// Puts everything where the scene begins, if that is a moment of a run.
  void begin(const Scene2d& scene) {
    set_beginnings<2>(scene, soft_bodies);
    const auto moves = [](const b2Body* body) { return body->GetType() == b2_dynamicBody; };
    check_moving_bodies(scene, static_cast<std::size_t>(std::ranges::count_if(rigid_bodies, moves)));
    for (const Beginning<2>::RigidBody& rigid : scene.begin->rigid_bodies) {
      if (rigid.body >= rigid_bodies.size() || !moves(rigid_bodies[rigid.body]))
        throw std::runtime_error(fmt::format("rigid body {} of the saved state does not move in the scene {}",
                                             rigid.body, scene.name));
      b2Body& body = *rigid_bodies[rigid.body];
      body.SetTransform(to_box2d(rigid.position), rigid.rotation);
      body.SetLinearVelocity(to_box2d(rigid.velocity));
      body.SetAngularVelocity(rigid.angular_velocity);
    }
    end_attachments(scene, attachments, soft_bodies);
  }

  b2World world{{0, 0}};
  std::vector<b2Body*> rigid_bodies;
  ppu::Box2dSoftBodies soft_bodies;
  std::vector<ppu::AttachmentId> attachments;  // of the scene, in order
};

/// The SPEs, and the solver that works on them.
struct Spes {
  Spes(const SimulationOptions& options, ppu::ContactMethod contacts)
      : match_2d(options.kernel("match_2d")),
        strain(options.kernel("strain")),
        job_loop(options.job_loop()),
        jobs(memory, options.spe_options(), job_loop),
        solver(memory, jobs, {match_2d, &strain}) {
    if (contacts == ppu::ContactMethod::kSurface) contact_images.emplace(options);
  }

  /// The contacts of the bodies are computed where the bodies are stepped.
  std::shared_ptr<ppu::ContactWorker> make_contact_worker() {
    return contact_images ? contact_images->make_worker(memory, jobs) : nullptr;
  }

  dma::AddressSpace memory;
  ls_sim::KernelImage match_2d, strain, job_loop;
  std::optional<ContactImages> contact_images;  // none: the PPU does it
  ppu::JobSystem jobs;
  ppu::SpeSolver<2> solver;
};

Models models_of(const std::vector<SoftBody2dPlacement>& bodies) {
  return shared_models(
      bodies.size(),
      [&](std::size_t i, std::size_t j) {
        return bodies[i].settings == bodies[j].settings && bodies[i].cells == bodies[j].cells &&
               bodies[i].contact_radius == bodies[j].contact_radius && bodies[i].ring == bodies[j].ring &&
               bodies[i].strengths == bodies[j].strengths;
      },
      [&](std::size_t i) {
        const std::vector<StrengthSlab<2>>& strengths = bodies[i].strengths;
        return describe_refusal(bodies[i].described, [&] {
          if (strengths.empty())
            return ppu::make_soft_body_model(bodies[i].lattice(), bodies[i].settings,
                                             bodies[i].contact_radius);
          return ppu::make_soft_body_model(
              bodies[i].lattice(), bodies[i].settings, bodies[i].contact_radius,
              [&strengths](const Vector2f& at) { return strength_at<2>(strengths, at); });
        });
      });
}

}  // namespace

struct Simulation2d::State {
  State(const Scene2d& scene_description, const SimulationOptions& options)
      : scene(scene_description),
        script(scene.script),
        controls(initial_controls<2>(scene)),
        contacts(options.contacts.value_or(scene.contacts)),
        timing(options.timing) {
    SC_ASSERT(scene.substeps > 0, "{} substeps in a frame of scene '{}'", scene.substeps, scene.name);
    if (options.solver == Solver::kSpe) {
      spes.emplace(options, contacts);
      solver.emplace(spes->solver);
    } else {
      solver.emplace(on_this_thread);
    }
    scene_bodies = SceneBodies<2>(models_of(scene.soft_bodies));
    if (scene.begin) frame = scene.begin->frames;
    reset();
  }

  // For Controls:
  void hold(const InputEvent<2>& event) {
    if (const auto nearest = Hands<2>::nearest_particle(event, bodies))
      held.hold(event.hand, std::make_unique<SoftGrip2d>(bodies[nearest->body],
                                                         static_cast<std::uint32_t>(nearest->particle)));
  }
  void hold_rigid(const InputEvent<2>& event) {
    if (event.body < scene.rigid_bodies.size() && scene.rigid_bodies[event.body].mass > 0)
      held.hold(event.hand, std::make_unique<RigidGrip2d>(*world->rigid_bodies[event.body], event.value));
  }
  void set_material(const InputEvent<2>& event, std::size_t body) {
    scene_bodies.set_material(world->soft_bodies, event, body, substep());
  }
  /// Cuts for a user or a recording. A stroke of no length has no effect.
  void cut(const InputEvent<2>& event) {
    if (!(event.way.cast<double>().norm() > 0)) return;
    cut(ppu::Cut2d::stroke(event.value, event.way),
        event.body == kEveryBody ? std::nullopt : std::optional<std::size_t>(event.body));
  }
  /// Pieces appear some substeps later. In a pause, which has no substeps, they appear at once.
  void cut(const ppu::Cut2d& where, std::optional<std::size_t> source) {
    cut_bodies(world->soft_bodies, scene_bodies.sources(), source, controls.paused(), where);
    adopt_pieces();
  }
  /// Call it after a step or a cut. Pieces are placed after all other bodies, and hands go on with the piece that has what they hold, if
  /// there is one.
  void adopt_pieces() {
    const std::vector<ppu::BrokenSoftBody2d> broken = world->soft_bodies.poll_broken();
    scene_bodies.add_pieces(world->soft_bodies, broken);
    held.follow(broken);
    controls.follow_particles([&](std::size_t& body, std::size_t& particle) {
      FollowedParticle<2> now{&bodies[body], static_cast<std::uint32_t>(particle)};
      if (!now.follow(broken)) return true;
      if (now.body == nullptr) return false;
      body = number_in(bodies, *now.body), particle = now.number;
      return true;
    });
  }
  int substeps_of_frame() const { return controls.substeps(scene.substeps); }
  /// Seconds per substep.
  float substep() const { return kFrameSeconds / static_cast<float>(substeps_of_frame()); }
  void move_hand(const InputEvent<2>& event) { held.move(event.hand, event.value); }
  void release(std::uint32_t hand) { held.release(hand); }
  void pin(std::uint32_t hand) {
    if (const auto part = part_held_by<2>(hand, held, controls.hands(), bodies))
      pins.add(world->soft_bodies, scene_bodies.source(number_in(bodies, *part->body)), *part);
  }
  void unpin(const InputEvent<2>& event) { pins.remove(world->soft_bodies, event.body); }
  void reset() {
    held.release_all();
    SC_ASSERT(solver, "scene '{}' has no solver", scene.name);
    pins.forget();
    world.reset();  // destroys its worker before the next one is made
    world.emplace(scene, scene_bodies.whole(), *solver, contacts,
                  spes ? spes->make_contact_worker() : nullptr);
    if (scene.begin) pins.replace(world->soft_bodies, scene.begin->pins);
    scene_bodies.forget_pieces();
  }
  void home(std::size_t body) {
    body = scene_bodies.source(body);
    pins.remove(world->soft_bodies, body);
    scene_bodies.make_whole(
        world->soft_bodies, body, [this](std::size_t b) { let_go(b); }, [](std::size_t) {});
    bodies[body].reset(scene.soft_bodies[body].position);
  }
  void let_go(std::size_t body) {
    controls.forget_body(body);
    held.forget(&bodies[body]);
  }

  /// Times of this thread from some moment on: processor time in the coupling to Box2D, elapsed time in the solver.
  struct Spent {
    ppu::SoftBodyTimes coupling;
    std::chrono::nanoseconds solve, wait;
  };
  Spent spent() const {
    const std::chrono::nanoseconds handing_over = solver->time_handing_over(),
                                   rest = solver->time_finishing();
    // Without SPEs the solver works when it finishes.
    return {.coupling = world->soft_bodies.times(),
            .solve = spes ? handing_over : handing_over + rest,
            .wait = spes ? rest : std::chrono::nanoseconds{0}};
  }

  /// The soft bodies of the present world: a reset replaces the world.
  struct Bodies {
    std::optional<World>& world;
    std::size_t size() const { return world->soft_bodies.size(); }
    ppu::SoftBody<2>& operator[](std::size_t i) const { return world->soft_bodies[i]; }
  };

  const Scene2d& scene;
  ScriptPlayer<2> script;
  Controls<2> controls;
  const ppu::ContactMethod contacts;
  const ls_sim::Timing* timing;  // null: nothing is timed
  ppu::PpuSolver<2> on_this_thread;
  std::optional<Spes> spes;
  std::optional<TimedSolver<2>> solver;  // of spes, or on_this_thread
  std::optional<World> world;
  Bodies bodies{world};
  SceneBodies<2> scene_bodies;        // of `world`
  HeldBodies<2> held;                 // likewise
  Pins<2> pins;                       // likewise
  std::vector<InputEvent<2>> events;  // of the last step
  std::int64_t frame = 0;             // of the script; a reset does not restart it
};

Simulation2d::Simulation2d(const Scene2d& scene, const SimulationOptions& options)
    : state_(std::make_unique<State>(scene, options)) {}
Simulation2d::~Simulation2d() = default;

FrameTimes Simulation2d::step(std::span<const InputEvent<2>> events) {
  State& s = *state_;
  const std::int64_t at_frame = s.frame++;
  const auto scripted = s.script.events_at(at_frame);
  s.events.assign(scripted.begin(), scripted.end());
  s.events.insert(s.events.end(), events.begin(), events.end());
  s.controls.apply(s.events, s.bodies, s);
  cut_as_planned(s.scene.cuts, at_frame, [&](const auto& where, std::size_t body) { s.cut(where, body); });
  const int substeps = s.controls.due_substeps(s.substeps_of_frame());
  if (substeps == 0) return {};

  World& world = *s.world;
  const FrameOnPs3 on_ps3(s.timing);
  const State::Spent before = s.spent();
  std::chrono::nanoseconds in_box2d{0};
  world.set_gravity(to_box2d(s.controls.gravity()));
  s.held.begin_frame(static_cast<float>(substeps) * s.substep());
  for (int i = 0; i < substeps; ++i) {
    s.controls.hands().pull(s.bodies);
    s.held.pull(i, substeps, s.controls.gravity(), s.substep());
    in_box2d += world.step(s.substep());
    s.adopt_pieces();
  }

  // The SPEs work on the next frame's first step while this frame is drawn.
  world.soft_bodies.begin_ahead(s.substep());

  const State::Spent after = s.spent();
  const auto milliseconds = [](std::chrono::nanoseconds from, std::chrono::nanoseconds to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  };
  FrameTimes times;
  times.physics_ms = milliseconds({}, in_box2d);
  times.gather_ms = milliseconds(before.coupling.gather, after.coupling.gather);
  times.solve_ms = milliseconds(before.solve, after.solve);
  times.apply_ms = milliseconds(before.coupling.apply, after.coupling.apply);
  times.contacts_ms = milliseconds(before.coupling.contacts, after.coupling.contacts);
  times.solver_wait_ms = milliseconds(before.wait, after.wait);
  times.ppu_ms = times.gather_ms + times.solve_ms + times.apply_ms + times.contacts_ms;
  times.ps3_ms = on_ps3.milliseconds();
  return times;
}

void Simulation2d::stop() {
  if (state_->spes) state_->spes->jobs.stop();
}

std::vector<ls_sim::SpeStatistics> Simulation2d::spe_statistics() const {
  return state_->spes ? state_->spes->jobs.statistics() : std::vector<ls_sim::SpeStatistics>{};
}

std::span<const InputEvent<2>> Simulation2d::last_events() const { return state_->events; }

std::size_t Simulation2d::soft_bodies() const { return state_->bodies.size(); }
std::size_t Simulation2d::source(std::size_t body) const { return state_->scene_bodies.sources().at(body); }
std::size_t Simulation2d::bodies_on_ppu() const {
  return state_->spes ? state_->spes->solver.bodies_on_ppu() : soft_bodies();
}

std::size_t Simulation2d::particles() const {
  std::size_t sum = 0;
  for (std::size_t b = 0; b < soft_bodies(); ++b) sum += soft_body(b).positions().size();
  return sum;
}

std::size_t Simulation2d::rigid_bodies() const {
  const auto& bodies = state_->scene.rigid_bodies;
  return static_cast<std::size_t>(
      std::count_if(bodies.begin(), bodies.end(), [](const RigidBody2d& body) { return body.mass > 0; }));
}

const ppu::SoftBody<2>& Simulation2d::soft_body(std::size_t body) const {
  SC_ASSERT(body < soft_bodies(), "body {} of {}", body, soft_bodies());
  return state_->world->soft_bodies[body];
}

Pose2d Simulation2d::rigid_pose(std::size_t body) const {
  const b2Transform& pose = state_->world->rigid_bodies.at(body)->GetTransform();
  return {.position = {pose.p.x, pose.p.y}, .cosine = pose.q.c, .sine = pose.q.s};
}

std::optional<InputEvent<2>> Simulation2d::touch(const Vector2f& point) const {
  for (std::uint32_t i = 0; i < state_->scene.rigid_bodies.size(); ++i) {
    const b2Body& body = *state_->world->rigid_bodies[i];
    if (!(state_->scene.rigid_bodies[i].mass > 0)) continue;
    for (const b2Fixture* fixture = body.GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext()) {
      if (fixture->TestPoint(to_box2d(point)))
        return InputEvent<2>{.action = Action::kHoldRigid, .body = i, .value = point};
    }
  }
  const InputEvent<2> hold{.action = Action::kHold, .body = kEveryBody, .value = point};
  const auto nearest = Hands<2>::nearest_particle(hold, state_->bodies);
  if (!nearest) return std::nullopt;
  return InputEvent<2>{
      .action = Action::kHold, .body = static_cast<std::uint32_t>(nearest->body), .value = point};
}

bool Simulation2d::is_free(const Vector2f& middle, float side) const {
  SC_ASSERT(middle.allFinite() && side > 0, "a square of {} m at ({}, {})", side, middle.x(), middle.y());
  struct Anything : b2QueryCallback {
    bool found = false;
    bool ReportFixture(b2Fixture* /*fixture*/) override {
      found = true;
      return false;  // one is enough
    }
  } anything;
  b2AABB box;
  box.lowerBound = to_box2d(middle - Vector2f::Constant(side / 2));
  box.upperBound = to_box2d(middle + Vector2f::Constant(side / 2));
  state_->world->world.QueryAABB(&anything, box);
  if (anything.found) return false;
  // Box2D does not know that soft bodies touch with their drawn edges.
  for (std::size_t b = 0; b < soft_bodies(); ++b) {
    const ppu::SoftBody<2>& body = soft_body(b);
    const float reach = side / 2 + body.model().contact_radius();
    const auto is_near = [&](const Vector2f& particle) {
      return (particle - middle).cwiseAbs().maxCoeff() < reach;
    };
    if (std::ranges::any_of(body.positions(), is_near)) return false;
  }
  return true;
}

ppu::ContactMethod Simulation2d::contacts() const { return state_->contacts; }
float Simulation2d::time_scale() const { return state_->controls.time_scale(); }
int Simulation2d::substeps() const { return state_->substeps_of_frame(); }
bool Simulation2d::paused() const { return state_->controls.paused(); }
std::span<const Hands<2>::Held> Simulation2d::held() const { return state_->controls.hands().held(); }
const Vector2f& Simulation2d::gravity() const { return state_->controls.gravity(); }

void Simulation2d::show(Shown2d& shown) const {
  shown.particles.resize(soft_bodies());
  shown.models.resize(soft_bodies());
  shown.sources = state_->scene_bodies.sources();
  for (std::size_t b = 0; b < soft_bodies(); ++b) {
    const auto positions = soft_body(b).positions();
    shown.particles[b].assign(positions.begin(), positions.end());
    shown.models[b] = soft_body(b).shared_model();
  }
  shown.rigid_poses.clear();
  for (std::size_t i = 0; i < state_->scene.rigid_bodies.size(); ++i)
    shown.rigid_poses.push_back(rigid_pose(i));
  shown.ropes.clear();
  append_ropes<2>(state_->scene.attachments, state_->world->attachments, state_->world->soft_bodies,
                  shown.ropes);
  state_->pins.append(state_->world->soft_bodies, shown.ropes);
  shown.hands.clear();
  for (const Hands<2>::Held& held : held()) {
    SC_ASSERT(held.body < soft_bodies(), "hand {} holds body {} of {}", held.hand, held.body, soft_bodies());
    SC_ASSERT(held.particle < shown.particles[held.body].size(), "hand {} holds particle {} of {}", held.hand,
              held.particle, shown.particles[held.body].size());
    shown.hands.push_back({shown.particles[held.body][held.particle], held.target});
  }
  state_->held.append(shown.hands);
}

Beginning<2> Simulation2d::moment() const {
  const State& s = *state_;
  if (const auto broken = s.scene_bodies.first_broken(s.world->soft_bodies))
    throw std::runtime_error(has_broken(s.scene.name, s.scene.soft_bodies[*broken].name));
  Beginning<2> now{.gravity = s.controls.gravity(),
                   .tilt = {},
                   .time_scale = s.controls.time_scale(),
                   .frames = s.frame,
                   .seconds = 0,
                   .soft_bodies = {},
                   .rigid_bodies = {},
                   .ended_attachments = ended_attachments(s.world->attachments, s.world->soft_bodies),
                   .pins = s.pins.saved(s.world->soft_bodies)};
  for (std::size_t b = 0; b < soft_bodies(); ++b) now.soft_bodies.push_back(state_of(soft_body(b)));
  for (std::uint32_t i = 0; i < s.world->rigid_bodies.size(); ++i) {
    const b2Body& body = *s.world->rigid_bodies[i];
    if (body.GetType() != b2_dynamicBody) continue;
    now.rigid_bodies.push_back({.body = i,
                                .position = {body.GetPosition().x, body.GetPosition().y},
                                .rotation = body.GetAngle(),
                                .velocity = {body.GetLinearVelocity().x, body.GetLinearVelocity().y},
                                .angular_velocity = body.GetAngularVelocity()});
  }
  return now;
}

std::uint64_t Simulation2d::state_hash() const {
  std::uint64_t hash = 0;
  for (std::size_t b = 0; b < soft_bodies(); ++b) hash = ppu::state_hash(soft_body(b), hash);
  return hash;
}

}  // namespace softcell::demos
