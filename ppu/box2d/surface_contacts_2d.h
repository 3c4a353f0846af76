#pragma once
// Handles the contacts of all soft bodies of a Box2dSoftBodies that touch with their drawn edges.

#include <box2d/b2_world.h>

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ppu/attachments/flat_attachments.h"
#include "ppu/bodies/known_models.h"
#include "ppu/box2d/box2d_attachments.h"
#include "ppu/box2d/box2d_body.h"
#include "ppu/box2d/box2d_links.h"
#include "ppu/box2d/box2d_obstacles.h"
#include "ppu/box2d/rest.h"
#include "ppu/contact_solver/contact_solver.h"
#include "ppu/contacts/touch_log.h"
#include "ppu/surfaces/cell_finder.h"
#include "ppu/surfaces/flat_layer.h"
#include "softcell/box2d/box2d_soft_bodies.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class SurfaceContacts2d {
 public:
  using Bodies = std::span<const std::unique_ptr<Box2dBody>>;
  /// The data that bodies of one model share.
  struct Model {
    Model(std::shared_ptr<const SoftBodyModel<2>> model, Skin2d drawn)
        : shared(std::move(model)), skin(std::move(drawn)), layer(*shared, skin), contact(layer) {}
    const std::shared_ptr<const SoftBodyModel<2>>& model() const { return shared; }
    std::shared_ptr<const SoftBodyModel<2>> shared;
    Skin2d skin;
    FlatLayer layer;
    ContactModel contact;
  };

  /// @param worker  finds and solves contacts; null: the thread that steps the world does it
  SurfaceContacts2d(b2World& world, std::shared_ptr<ContactWorker> worker);

  /// Called after the solver of a step: adds gravity to velocities, finds contacts, solves them together with attachments, moves all
  /// particles of bodies that are awake, and gives rigid bodies their impulses before Box2D integrates them. Wakes bodies that are touched.
  void step(Bodies bodies, Box2dAttachments& attachments, float step);

  /// Sets how bodies of a model are drawn, if not by make_skin_2d(). Has no effect once a body of the model has been in a step.
  void draw(const std::shared_ptr<const SoftBodyModel<2>>& model, const Skin2d& skin);

  /// The model from which pieces of its bodies are made.
  const std::shared_ptr<const Model>& whole_of(const std::shared_ptr<const SoftBodyModel<2>>& model) {
    return model_of(model->is_piece() ? model->whole() : model);
  }
  /// May run on any thread. @param whole  whole_of() the body that breaks
  static std::unique_ptr<Model> make_piece(const std::shared_ptr<const SoftBodyModel<2>>& piece,
                                           const Model& whole);
  /// Keeps a model that make_piece() has made.
  void adopt(std::unique_ptr<Model> piece);

  /// Contacts of the last step with an impulse above 0.
  const SoftNeighbours& touches() const { return touches_; }
  /// Forgets touches of rigid bodies that the program has destroyed since the step. Bodies that touched them do not fall asleep yet.
  void forget_destroyed();
  /// Appends the contacts of the last step whose impulse is above 0.
  void append_contacts(std::vector<Contact2d>& contacts) const;

  /// Sets whether events are recorded from the next step on.
  void watch(bool events);
  /// Touches that have begun, gone on or ended since the last call.
  std::vector<ContactEvent2d> poll_events() { return log_.poll(); }

  /// How a body of the model is drawn: this outline touches.
  const Skin2d& skin(const std::shared_ptr<const SoftBodyModel<2>>& model) { return model_of(model)->skin; }

  /// Records that a body has fallen asleep, with what it touches.
  void let_lie(const Box2dBody& body);
  /// Wakes the bodies that lie on a body which is being removed.
  void forget(const Box2dBody& body);
  /// Wakes the bodies that lie on a body which moves away, may do so, or no longer touches what it did.
  void tell_those_on(const Box2dBody& body);
  /// A piece, and for each of its particles the particle of the whole that it was.
  struct Piece {
    const Box2dBody* body;
    std::span<const std::uint32_t> particle_of;
  };
  /// Gives pieces the sides of the body that broke into them, which has become the first of them. @param whole  the model that it had
  void follow_pieces(const Box2dBody& body, const SoftBodyModel<2>& whole, std::span<const Piece> pieces);
  /// Follows bodies and the world to another origin. @param by  metres, which all positions have just been moved by
  void shift(const Eigen::Vector2f& by);
  /// Call it when a body has gone or has another model now. Frees the data of a model that no body has any longer, now or in a step soon,
  /// if it is the model of a piece or nothing else holds it.
  /// @param model  that the body had; need not exist any longer  @pre between steps
  void forget_model(const SoftBodyModel<2>* model) { models_.forget(model); }

 private:
  /// A rigid body as it was when a soft one fell asleep on it, or when a sleeper near it first saw it.
  struct Support {
    b2Body* body;
    b2Transform pose;
    std::uint64_t look;  // Box2dObstacles::look()
  };
  static constexpr std::uint32_t kNoNumber = ~0u;
  /// What is kept of each body.
  struct Kept {
    std::uint32_t number = kNoNumber;    // in the order in which bodies were added
    std::shared_ptr<const Model> model;  // null: no step has had it as it is
    KnownSides sides;
    Eigen::Vector2f place_of_sides{0, 0};                // of the first particle, when `sides` last applied
    std::vector<Eigen::Vector3f> positions, velocities;  // of its layer, at the step's beginning
    std::vector<Support> supports;                       // while it sleeps
    std::vector<const Box2dBody*> lies_on;               // likewise
    bool lost_support = false;                           // one of these is gone
    std::vector<Support> seen;  // bodies near it while it sleeps, with the places where they were first seen
    bool lies() const { return lost_support || !supports.empty() || !lies_on.empty(); }
  };

  const std::shared_ptr<const Model>& model_of(const std::shared_ptr<const SoftBodyModel<2>>& model);
  void forget_contacts(const Box2dBody& body);
  void lift(const Box2dBody& body, Kept& kept, float step);
  void begin(Bodies bodies, const Box2dAttachments& attachments, float step);
  void begin_attachments(Bodies bodies, Box2dAttachments& attachments, float step);
  Support as_it_is(b2Body& body) { return {&body, body.GetTransform(), obstacles_.look(body)}; }
  bool is_gone(const Support& support);
  void see(Kept& kept, b2Body& body);
  void wake_if_disturbed(Kept& kept, Box2dBody& body, const BodyInSubstep& in_substep);
  bool has_lost_support(const Kept& kept, const SoftBody<2>& sleeper);
  void rise(Kept& kept);
  void wake_those_in_the_way(Bodies bodies);
  void move(Bodies bodies, float step);
  void note_touches(Bodies bodies);
  void log_touches(Bodies bodies);
  void log_sensors(Bodies bodies, float step);

  b2World& world_;
  std::shared_ptr<ContactWorker> worker_;
  KnownModels<2, Model> models_{[this](const Model& known) {
    if (worker_) worker_->forget(known.contact);
  }};
  std::unordered_map<const Box2dBody*, Kept> kept_;
  Box2dObstacles obstacles_{Box2dObstacles::Fixtures::kSolid};
  Box2dLinks links_;
  FlatAttachments attachments_;
  std::vector<std::uint32_t> attached_rigids_;
  ContactSolver solver_;
  std::vector<BodyInSubstep> in_substep_;
  std::vector<std::uint32_t> moving_;      // bodies that wake those in their way
  std::vector<const SoftBody<2>*> softs_;  // of the last step
  std::vector<PressingContact> pressing_;  // of the last step
  SoftNeighbours touches_;
  std::vector<const b2Body*> living_;  // while destroyed bodies are looked for
  std::uint32_t next_number_ = 0;
  // Used while events are recorded:
  bool watches_ = false;
  TouchLog<ContactEvent2d> log_;
  Box2dObstacles sensors_{Box2dObstacles::Fixtures::kSensors};
  std::vector<std::uint32_t> near_;     // those of sensors_ near a body
  std::vector<Eigen::Vector3f> moved_;  // the present places of a body near a sensor
  CellFinder cells_;                    // of that body
};

}  // namespace softcell::ppu
