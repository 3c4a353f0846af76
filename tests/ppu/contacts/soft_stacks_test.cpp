// Soft bodies on each other: what is deep in another body leaves by the face by which it came in.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <vector>

#include "contact_world.h"
#include "ppu/contacts/entered_face.h"
#include "ppu/surfaces/cell_finder.h"
#include "support/drawn_overlap.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A box of 0.6 x 0.4 x 0.6 m around 0, in cells of 0.1 m, pressed to a third of its height.
class PressedBox : public testing::Test {
 protected:
  PressedBox() {
    for (std::size_t i = 0; i < lattice_.particles.size(); ++i)
      places_.push_back(lattice_.rest_position(i).cwiseProduct(Vector3f(1, kFlat, 1)));
    finder_.place(lattice_, places_);
    body_.model = &model_;
  }

  /// @param rest  where the point would be in the shape at rest
  std::optional<WayOut> way_out(const Vector3f& rest, const Vector3f& along) const {
    const auto place =
        finder_.find(rest.cwiseProduct(Vector3f(1, kFlat, 1)), [](std::uint32_t) { return true; });
    EXPECT_TRUE(place.has_value());
    return place ? way_out_of(body_, *place, 0, along) : std::nullopt;
  }

  static constexpr float kFlat = 1.0f / 3, kRounding = 1e-3f;

 private:
  ContactModel model_{make_soft_body_model(make_box({0.6f, 0.4f, 0.6f}, 0.1f), settings_of(0.1f))};
  const Lattice<3>& lattice_ = model_.lattice();
  std::vector<Vector3f> places_;
  CellFinder finder_;
  ContactBody body_;
};

/// 6 cm from the rim, and 14 cm from above at rest.
const Vector3f kNearRim(0.24f, 0.06f, 0.02f);

TEST_F(PressedBox, IsLeftByTheFaceTowardsTheInsideOfTheOther) {
  const auto up = way_out(kNearRim, {0, 0.2f, 0});
  ASSERT_TRUE(up.has_value());
  EXPECT_LT((up->normal - Vector3f::UnitY()).norm(), kRounding);
  EXPECT_NEAR(up->distance, -0.14f * kFlat, kRounding);
  const auto down = way_out(kNearRim, {0.01f, -0.1f, 0});
  ASSERT_TRUE(down.has_value());
  EXPECT_LT((down->normal + Vector3f::UnitY()).norm(), kRounding);
  EXPECT_NEAR(down->distance, -0.26f * kFlat, kRounding) << "through the whole body";
  const auto across = way_out(kNearRim, {-0.3f, 0, 0});
  ASSERT_TRUE(across.has_value());
  EXPECT_LT((across->normal + Vector3f::UnitX()).norm(), kRounding);
  EXPECT_NEAR(across->distance, -0.54f, kRounding);
}

TEST_F(PressedBox, IsLeftByTheNearestFaceIfThatIsTheSameOneOrNothingTells) {
  for (const Vector3f& along : {Vector3f(0.3f, 0.05f, 0), Vector3f(0, 0, 0)}) {
    const auto out = way_out(kNearRim, along);
    ASSERT_TRUE(out.has_value());
    EXPECT_LT((out->normal - Vector3f::UnitX()).norm(), kRounding);
    EXPECT_NEAR(out->distance, -0.06f, kRounding);
  }
}

TEST_F(PressedBox, IsLeftByTheNearestFaceWhereThatIsNear) {
  const auto out = way_out({0.292f, 0.1f, 0.02f}, {0, 0.2f, 0});
  ASSERT_TRUE(out.has_value());
  EXPECT_LT((out->normal - Vector3f::UnitX()).norm(), kRounding);
  EXPECT_NEAR(out->distance, -0.008f, kRounding);
}

/// How deep drawn surfaces are in each other, in cells, every sixth frame.
std::vector<float> depths(ContactWorld& w, const std::vector<SoftBody<3>*>& bodies, int frames) {
  constexpr int kApart = 6;
  std::vector<float> depths;
  for (int frame = 0; frame < frames; frame += kApart) {
    w.run(kApart);
    std::vector<tests::DrawnBody> drawn;
    for (const SoftBody<3>* body : bodies) drawn.emplace_back(*body);
    depths.push_back(tests::deepest(drawn));
  }
  return depths;
}

float nine_of_ten(std::vector<float> depths) {
  std::sort(depths.begin(), depths.end());
  return depths[depths.size() * 9 / 10];
}

class SoftStacks : public testing::TestWithParam<float> {};

INSTANTIATE_TEST_SUITE_P(Alpha, SoftStacks, testing::Values(0.2f, 0.5f),
                         [](const auto& alpha) { return alpha.param < 0.3f ? "VerySoft" : "Soft"; });

TEST_P(SoftStacks, DoNotMerge) {
  ContactWorld w;
  w.add_floor(0.6f);
  std::vector<SoftBody<3>*> bodies;
  for (int i = 0; i < 5; ++i) {
    const auto height = static_cast<float>(i);
    bodies.push_back(&w.add(make_box({0.6f, 0.4f, 0.6f}, 0.08f), settings_of(0.1f, GetParam(), 0.2f),
                            {0.01f * height, 0.21f + 0.42f * height, 0}));
  }
  const std::vector<float> deep = depths(w, bodies, 300);
  EXPECT_LT(*std::max_element(deep.begin(), deep.end()), 0.4f);
  EXPECT_LT(nine_of_ten(deep), 0.2f);
  EXPECT_LT(*std::max_element(deep.end() - 10, deep.end()), 0.1f) << "in the last second";
}

/// Balls that fall into each other's way.
TEST_P(SoftStacks, BallsOnEachOtherComeApart) {
  ContactWorld w;
  w.add_floor(0.6f);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-0.1f, 0.1f);
  std::vector<SoftBody<3>*> bodies;
  for (int i = 0; i < 5; ++i) {
    bodies.push_back(&w.add(make_sphere(0.3f, 14), settings_of(0.1f, GetParam(), 0.2f),
                            {any(random), 0.5f + 0.62f * static_cast<float>(i), any(random)}));
    for (std::size_t p = 0; p < bodies.back()->positions().size(); ++p)
      bodies.back()->set_particle(p, bodies.back()->position(p), {0, -4, 0});
  }
  const std::vector<float> deep = depths(w, bodies, 300);
  EXPECT_LT(*std::max_element(deep.end() - 10, deep.end()), 0.1f) << "in the last second";
}

}  // namespace
}  // namespace softcell::ppu
