// What couplings keep of models goes with the last body that uses it, and no sooner.
#include "ppu/bodies/known_models.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "softcell/soft_bodies/shapes.h"

namespace softcell::ppu {
namespace {

using Model = std::shared_ptr<const SoftBodyModel<3>>;

constexpr int kForEver = 1000;  // steps

struct Kept {
  explicit Kept(Model of) : shared(std::move(of)) {}
  const Model& model() const { return shared; }
  Model shared;
};

class KnownModelsTest : public testing::Test {
 protected:
  /// Holds the model as a body would.
  std::shared_ptr<const Kept> use(const Model& model) {
    auto& kept = models_[model.get()];
    if (!kept) kept = std::make_shared<Kept>(model);
    return kept;
  }
  /// @return  the number that it has freed
  int forget(const SoftBodyModel<3>* model) {
    freed_ = 0;
    models_.forget(model);
    return freed_;
  }
  int freed_in(int steps) {
    freed_ = 0;
    for (int i = 0; i < steps; ++i) models_.forget_unused();
    return freed_;
  }

  static Model cube() {
    return make_soft_body_model(make_box({0.4f, 0.4f, 0.4f}, 0.2f), {.cell_size = 0.2f});
  }
  /// The two halves of a model.
  static std::vector<Model> halves_of(const Model& model) {
    const SoftBody<3> body(model, {0, 0, 0});
    const std::vector<std::uint32_t> faces = faces_across(
        body, Cut::plane(body.centre_of_mass() + Eigen::Vector3f(0.01f, 0.01f, 0.01f), {1, 0, 0}));
    std::vector<Model> halves;
    for (const BodyPiece<3>& piece : plan_pieces(model, faces, 1).stay)
      halves.push_back(piece.body.shared_model());
    return halves;
  }

  int freed_ = 0;
  KnownModels<3, Kept> models_{[this](const Kept&) { ++freed_; }};
};

TEST_F(KnownModelsTest, ABodyThatUsesAModelKeepsIt) {
  Model model = cube();
  auto body = use(model), other = use(model);
  EXPECT_EQ(body, other);
  const SoftBodyModel<3>* const key = model.get();
  model.reset();
  other.reset();
  EXPECT_EQ(forget(key), 0);
  EXPECT_EQ(freed_in(1), 0);
  body.reset();
  EXPECT_EQ(forget(key), 1);
  EXPECT_EQ(forget(key), 0) << "it is gone, and so may the model be";
}

TEST_F(KnownModelsTest, AModelThatTheProgramHoldsMayComeBack) {
  Model model = cube();
  const Kept* const first = use(model).get();
  EXPECT_EQ(forget(model.get()), 0);
  EXPECT_EQ(freed_in(kForEver), 0);
  EXPECT_EQ(use(model).get(), first);
  EXPECT_EQ(forget(model.get()), 0);
  EXPECT_EQ(freed_in(1), 0);
  model.reset();  // a thread has disposed of it meanwhile
  EXPECT_EQ(freed_in(kForEver), 1);
}

TEST_F(KnownModelsTest, OnlyTheModelThatIsNamedIsLookedAt) {
  const SoftBodyModel<3>* const one = use(cube())->model().get();
  use(cube());
  use(cube());
  EXPECT_EQ(forget(one), 1);
  EXPECT_EQ(freed_in(1), 2) << "in the next step all are";
}

TEST_F(KnownModelsTest, TheLastPieceLetsGoOfTheWhole) {
  Model whole = cube();
  use(whole);
  std::vector<Model> halves = halves_of(whole);
  ASSERT_EQ(halves.size(), 2u);
  auto first = use(halves[0]), second = use(halves[1]);
  whole.reset();
  EXPECT_EQ(forget(halves[0].get()), 0) << "a body uses it";
  first.reset();
  EXPECT_EQ(forget(halves[0].get()), 1) << "what the program holds of a piece does not count";
  halves.clear();
  EXPECT_EQ(freed_in(kForEver), 0) << "the whole is the other piece's";
  const SoftBodyModel<3>* const last = second->model().get();
  second.reset();
  EXPECT_EQ(forget(last), 2) << "the piece and the whole";
}

TEST_F(KnownModelsTest, WhatWasMadeElsewhereIsKeptUnlessThereIsSomething) {
  const Model model = cube();
  auto made = std::make_unique<Kept>(model);
  const Kept* const address = made.get();
  models_.adopt(std::move(made));
  EXPECT_EQ(use(model).get(), address);
  models_.adopt(std::make_unique<Kept>(model));
  EXPECT_EQ(use(model).get(), address);
}

}  // namespace
}  // namespace softcell::ppu
