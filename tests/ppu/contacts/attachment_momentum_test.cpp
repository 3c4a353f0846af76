// What attachments may not change: bodies that are attached to each other keep their momentum and angular momentum together.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "attached_world.h"

namespace softcell::ppu::attached {
namespace {

class AttachmentMomentum : public SolvedByBoth {};
INSTANTIATE_TEST_SUITE_P(SolvedBy, AttachmentMomentum, kBothSolvers, SolvedByBoth::name);

TEST_P(AttachmentMomentum, TwoFreeBodiesKeepTheirMomentum) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    AttachedWorld w(GetParam(), {0, 0, 0});
    SoftBody<3>& left = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell), {0, 0, 0});
    SoftBody<3>& right = w.add(make_sphere(0.25f, 8), settings_of(0.12f), {0.6f, 0, 0});
    w.bodies.attach(left, Patch<3>::of_surface({0.2f, 0, 0}, 0.12f), right,
                    Patch<3>::of_surface({0.35f, 0, 0}, 0.12f), {.kind = kind});
    left.add_velocity({1, 2, 0.5f});
    right.add_velocity({3, -1, 0});
    right.add_angular_velocity({1, 4, 2});
    const double size = momentum_of(left).norm() + momentum_of(right).norm();
    const Eigen::Vector3d before = momentum_of(left) + momentum_of(right);
    const Vector3f apart = right.centre_of_mass() - left.centre_of_mass();
    w.run(500);
    EXPECT_LT((momentum_of(left) + momentum_of(right) - before).norm(), 1e-5 * size);
    EXPECT_LT((right.centre_of_mass() - left.centre_of_mass()).norm(), 2 * apart.norm())
        << "they are attached";
    EXPECT_LT(left.deformation(), kCell);
  }
}

/// The angular momentum about the origin.
Eigen::Vector3d spin_of(const SoftBody<3>& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    sum += double{body.model().masses()[i]} *
           body.position(i).cast<double>().cross(body.velocities()[i].cast<double>());
  return sum;
}
Eigen::Vector3d spin_of(const btRigidBody& body) {
  const Eigen::Matrix3d inertia = to_eigen(body.getInvInertiaTensorWorld()).cast<double>().inverse();
  return to_eigen(body.getWorldTransform().getOrigin())
                 .cast<double>()
                 .cross(to_eigen(body.getLinearVelocity()).cast<double>()) /
             double{body.getInvMass()} +
         inertia * to_eigen(body.getAngularVelocity()).cast<double>();
}

/// A compliant attachment is stretched: if its ends also move sideways, its two impulses do not lie on one line.
TEST_P(AttachmentMomentum, TwoFreeBodiesThatAreApartKeepTheirAngularMomentum) {
  if (kSlowBuild && GetParam() == Who::kSpes)
    GTEST_SKIP() << "too slow with sanitizers, which run it on the PPU";
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    for (const float compliance : {0.0f, 1e-4f, 1e-3f, 1e-2f}) {
      AttachedWorld w(GetParam(), {0, 0, 0});
      SoftBody<3>& left = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell), {-0.4f, 0, 0});
      SoftBody<3>& right = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell), {0.4f, 0, 0});
      AttachmentSettings<3> settings{.kind = kind, .compliance = compliance};
      if (kind == AttachmentKind::kHinge) settings.point = Vector3f(0, 0, 0);
      w.bodies.attach(left, Patch<3>::of_surface({-0.2f, 0, 0}, 0.2f), right,
                      Patch<3>::of_surface({0.2f, 0, 0}, 0.2f), settings);
      left.add_velocity({0.3f, 1, 0.5f});
      right.add_velocity({-0.3f, -1, -0.5f});
      right.add_angular_velocity({1, 4, 2});
      double size = 0;
      for (const SoftBody<3>* const body : {&left, &right})
        for (std::size_t i = 0; i < body->model().particles(); ++i)
          size += double{body->model().masses()[i] * body->position(i).norm() * body->velocities()[i].norm()};
      const Eigen::Vector3d before = spin_of(left) + spin_of(right);
      w.run(500);
      EXPECT_LT((spin_of(left) + spin_of(right) - before).norm(), 1e-5 * size)
          << static_cast<int>(kind) << " that gives " << compliance << " m/N";
    }
  }
}

TEST_P(AttachmentMomentum, AFreeBodyAndARigidOneThatAreApartKeepTheirAngularMomentum) {
  if (kSlowBuild && GetParam() == Who::kSpes)
    GTEST_SKIP() << "too slow with sanitizers, which run it on the PPU";
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    for (const float compliance : {0.0f, 1e-4f, 1e-3f, 1e-2f}) {
      AttachedWorld w(GetParam(), {0, 0, 0});
      SoftBody<3>& body = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell), {-0.4f, 0, 0});
      const float mass = body.model().mass();
      btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), mass, {0.4f, 0, 0});
      w.bodies.attach(body, Patch<3>::of_surface({-0.2f, 0, 0}, 0.2f), box,
                      {.kind = kind, .compliance = compliance});
      body.add_velocity({0.3f, 1, 0.5f});
      box.setLinearVelocity({-0.3f, -1, -0.5f});
      const double size = spin_of(body).norm() + spin_of(box).norm();
      const Eigen::Vector3d before = spin_of(body) + spin_of(box);
      w.run(500);
      EXPECT_LT((spin_of(body) + spin_of(box) - before).norm(), 1e-5 * size)
          << static_cast<int>(kind) << " that gives " << compliance << " m/N";
    }
  }
}

TEST_P(AttachmentMomentum, ARigidBodyFeelsWhatHangsOnIt) {
  AttachedWorld w(GetParam(), {0, 0, 0});
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 5, {0, 0, 0});
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell), {0.36f, 0, 0});
  w.bodies.attach(body, Patch<3>::of_surface({0.21f, 0, 0}, 0.2f), box);
  box.setLinearVelocity({1, 0.5f, 0});
  box.setAngularVelocity({0, 0, 3});
  const auto momentum = [&] {
    return Eigen::Vector3d(momentum_of(body) + 5.0 * to_eigen(box.getLinearVelocity()).cast<double>());
  };
  const Eigen::Vector3d before = momentum();
  w.run(240);
  EXPECT_LT((momentum() - before).norm(), 1e-5 * before.norm());
  const Vector3f apart = body.centre_of_mass() - to_eigen(box.getWorldTransform().getOrigin());
  EXPECT_NEAR(apart.norm(), 0.36f, 0.05f);
  const Vector3f own = to_eigen(box.getWorldTransform().getBasis()).transpose() * apart;
  EXPECT_NEAR(own.x(), 0.36f, 0.05f) << "it turns with the box";
}

/// A crate and the body that hangs on it are put metres apart. The code that removes the angular momentum of forces between such ends once
/// threw them about, faster and faster: up to 1e28 J.
TEST_P(AttachmentMomentum, EndsThatWerePutFarApartComeTogetherCalmly) {
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge})
    for (const float way : {1.0f, 3.0f, 10.0f})
      for (const bool is_soft_moved : {false, true}) {
        AttachedWorld w(GetParam(), {0, 0, 0});
        SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 0.9f, 0.2f), {0.36f, 0, 0});
        btRigidBody& crate = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 20, {0, 0, 0});
        const AttachmentId held = w.bodies.attach(
            body, Patch<3>::of_surface({0.21f, 0, 0}, 0.12f), crate,
            {.kind = kind,
             .point = kind == AttachmentKind::kWeld ? std::optional<Vector3f>() : Vector3f(0.21f, 0, 0),
             .axis = {0, 0, 1}});
        w.run(5);
        if (is_soft_moved)
          body.translate({way, 0.1f * way, 0});
        else
          crate.setWorldTransform(btTransform(btQuaternion::getIdentity(), {way, 0.1f * way, 0}));
        float fastest = 0;
        for (int i = 0; i < 300; ++i) {
          w.run(1);
          fastest = std::max(fastest, ContactWorld::fastest(body));
        }
        const std::string what = std::to_string(static_cast<int>(kind)) + ", " + std::to_string(way) + " m";
        EXPECT_LT(fastest, 3 * 0.25f * kCell / kStep) << what;
        EXPECT_LT(ContactWorld::fastest(body), 0.25f * kCell / kStep)
            << what << ": it may turn about the hinge";
        EXPECT_LT(crate.getLinearVelocity().length(), 0.5f) << what;
        EXPECT_LT(w.bodies.attachment(held)->gap, 0.1f * kCell) << what;
      }
}

}  // namespace
}  // namespace softcell::ppu::attached
