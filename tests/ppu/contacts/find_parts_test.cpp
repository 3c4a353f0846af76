// Parts of two bodies, without an SPE: what they are made of.

#include "ppu/spe_bodies/find_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "contact_world.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/spe_bodies/find_model.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A body as SpeContacts has it in main memory.
struct WrittenBody {
  WrittenBody(const ContactModel& contact, const Vector3f& position) : model(contact) {
    const Lattice<3>& lattice = contact.lattice();
    for (std::size_t p = 0; p < lattice.particles.size(); ++p) {
      const Vector3f x = lattice.rest_position(p) + position;
      begins.push_back({x.x(), x.y(), x.z(), static_cast<float>(p + 1)});
      ends.push_back({x.x(), x.y(), x.z(), 0});
    }
    boxes.resize((model.cells.size() + 3) / 4);
    for (std::size_t c = 0; c < 4 * boxes.size(); ++c) {
      const auto& corner = model.cells[std::min(c, model.cells.size() - 1)].corner;
      const spu::FindEnd &low = ends[corner[0]], &high = ends[corner[7]];
      spu::FindBoxes& four = boxes[c / 4];
      four.low_x[c % 4] = low.x, four.low_y[c % 4] = low.y, four.low_z[c % 4] = low.z;
      four.high_x[c % 4] = high.x, four.high_y[c % 4] = high.y, four.high_z[c % 4] = high.z;
    }
  }
  FindParts::Body body() const {
    return {
        .cells = model.cells, .groups = model.groups, .boxes = boxes.data(), .ends = ends, .begins = begins};
  }
  FindModel model;
  std::vector<spu::FindBoxes> boxes;
  std::vector<spu::FindEnd> ends;
  std::vector<spu::FindBegin> begins;
};

/// What an SPE would find at an address.
const std::byte* at(SpeRuntime& spes, std::uint64_t ea) {
  return spes.memory().mapping_at(dma::EffectiveAddress{ea})->host_of(dma::EffectiveAddress{ea});
}

Bounds<3> everything() { return {Vector3f::Constant(-100), Vector3f::Constant(100)}; }

std::size_t points_of(std::span<const spu::FindGroup> groups) {
  std::size_t points = 0;
  for (const spu::FindGroup& group : groups)
    points += static_cast<std::size_t>(std::count_if(group.allowance, group.allowance + 4,
                                                     [](float a) { return a < spu::kFindNoPoint / 2; }));
  return points;
}

/// Whether something may be near a cell.
bool has_box(const spu::FindBoxes* boxes, std::uint32_t cell) {
  const spu::FindBoxes& four = boxes[cell / 4];
  return four.low_x[cell % 4] <= four.high_x[cell % 4];
}

std::uint32_t near_cells_of(SpeRuntime& spes, const spu::FindBody& part) {
  const auto* const boxes = reinterpret_cast<const spu::FindBoxes*>(at(spes, part.state_ea));
  std::uint32_t count = 0;
  for (std::uint32_t c = 0; c < part.cell_count; ++c) count += has_box(boxes, c) ? 1 : 0;
  return count;
}

TEST(FindParts, HaveEachPointOnceAndFitIntoALocalStore) {
  SpeRuntime spes({.spes = 1});
  const ContactModel contact(make_soft_body_model(make_sphere(0.62f, 24), settings_of(0.13f)));
  const WrittenBody a(contact, {0, 0, 0}), b(contact, {0.3f, 0.1f, 0});
  FindParts parts(spes.memory());
  ASSERT_TRUE(parts.add(a.body(), b.body(), everything()));
  EXPECT_GT(parts.size(), 2u);
  parts.write();
  std::size_t points_of_a = 0, points_of_b = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    spu::FindTask task{};
    parts.describe(i, task.a, task.b);
    EXPECT_LE(spu::find_bytes(task), spu::kFindMaxBytes);
    EXPECT_LE(near_cells_of(spes, task.a), spu::kFindMaxNear);
    EXPECT_LE(near_cells_of(spes, task.b), spu::kFindMaxNear);
    EXPECT_TRUE((task.a.group_count == 0) != (task.b.group_count == 0)) << "points of one side";
    for (const auto& [side, sum] : {std::pair{&task.a, &points_of_a}, std::pair{&task.b, &points_of_b}}) {
      if (side->group_count == 0) continue;
      const auto* const groups = reinterpret_cast<const spu::FindGroup*>(at(spes, side->groups_ea));
      const std::size_t points = points_of({groups, side->group_count});
      EXPECT_LE(points, spu::kFindMaxContacts);
      *sum += points;
    }
  }
  // All cells of the one ball that have points and are near one of the other.
  const auto near = [](const WrittenBody& mine, const WrittenBody& other) {
    std::size_t points = 0;
    for (const spu::FindCell& cell : mine.model.cells) {
      const spu::FindEnd &low = mine.ends[cell.corner[0]], &high = mine.ends[cell.corner[7]];
      const bool is_near = std::ranges::any_of(other.model.cells, [&](const spu::FindCell& its) {
        const spu::FindEnd &l = other.ends[its.corner[0]], &h = other.ends[its.corner[7]];
        return low.x <= h.x && l.x <= high.x && low.y <= h.y && l.y <= high.y && low.z <= h.z &&
               l.z <= high.z;
      });
      if (is_near)
        points += points_of(std::span(mine.model.groups).subspan(cell.first_group, cell.group_count));
    }
    return points;
  };
  EXPECT_GE(points_of_a, near(a, b));
  EXPECT_GE(points_of_b, near(b, a));
  EXPECT_LE(points_of_a, points_of(a.model.groups));
  EXPECT_LE(points_of_b, points_of(b.model.groups));
}

/// What a part says of its cells and particles is what the bodies have under the numbers that restore() gives.
TEST(FindParts, AreOfTheBodiesUnderOtherNumbers) {
  SpeRuntime spes({.spes = 1});
  const ContactModel contact(make_soft_body_model(make_box({1, 0.6f, 0.6f}, 0.1f), settings_of(0.1f)));
  const WrittenBody a(contact, {0, 0, 0}), b(contact, {0.9f, 0.05f, 0.02f});
  FindParts parts(spes.memory());
  ASSERT_TRUE(parts.add(a.body(), b.body(), everything()));
  parts.write();
  ASSERT_GE(parts.size(), 2u);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    spu::FindBody of_a{}, of_b{};
    parts.describe(i, of_a, of_b);
    const auto* const cells = reinterpret_cast<const spu::FindCell*>(at(spes, of_a.cells_ea));
    const auto* const boxes = reinterpret_cast<const spu::FindBoxes*>(at(spes, of_a.state_ea));
    const auto* const ends = reinterpret_cast<const spu::FindEnd*>(boxes + (of_a.cell_count + 3) / 4);
    const auto* const begins = reinterpret_cast<const spu::FindBegin*>(ends + of_a.particle_count);
    for (std::uint32_t c = 0; c < of_a.cell_count; ++c) {
      spu::SolveContact there{};
      std::ranges::copy(cells[c].corner, there.a.particle);
      there.cell_a = static_cast<std::uint16_t>(c);
      parts.restore(i, there);
      const spu::FindCell& whole = a.model.cells[there.cell_a];
      EXPECT_TRUE(std::ranges::equal(whole.field, cells[c].field));
      EXPECT_TRUE(std::ranges::equal(whole.grid, cells[c].grid));
      if (cells[c].group_count != 0) {
        ASSERT_LT(cells[c].inner_cell, of_a.cell_count);
        EXPECT_TRUE(
            std::ranges::equal(a.model.cells[whole.inner_cell].grid, cells[cells[c].inner_cell].grid));
        EXPECT_EQ(whole.inner_node, cells[c].inner_node);
      }
      if (!has_box(boxes, c)) {
        EXPECT_EQ(cells[c].group_count, 0);
        continue;
      }
      EXPECT_TRUE(std::ranges::equal(whole.corner, there.a.particle));
      EXPECT_EQ(boxes[c / 4].low_y[c % 4], a.boxes[there.cell_a / 4].low_y[there.cell_a % 4]);
      for (int k = 0; k < 8; ++k) {
        EXPECT_EQ(ends[cells[c].corner[k]].x, a.ends[there.a.particle[k]].x);
        EXPECT_EQ(begins[cells[c].corner[k]].root, a.begins[there.a.particle[k]].root);
      }
    }
    // The slot of zeros is behind all particles, and a cell that is none stays that.
    spu::SolveContact zeros{};
    std::fill(std::begin(zeros.b.particle), std::end(zeros.b.particle),
              static_cast<std::uint16_t>(of_b.particle_count));
    zeros.cell_b = spu::kSolveNoCell;
    parts.restore(i, zeros);
    EXPECT_EQ(zeros.b.particle[3], b.ends.size());
    EXPECT_EQ(zeros.cell_b, spu::kSolveNoCell);
  }
}

/// Hundreds of cells in one place.
TEST(FindParts, AreNoneWhereACellIsNearTooMany) {
  SpeRuntime spes({.spes = 1});
  const ContactModel contact(make_soft_body_model(make_sphere(0.62f, 24), settings_of(0.13f)));
  const WrittenBody a(contact, {0, 0, 0});
  WrittenBody b(contact, {0, 0, 0});
  for (spu::FindBoxes& four : b.boxes)
    for (int i = 0; i < 4; ++i)
      four.low_x[i] = four.low_y[i] = four.low_z[i] = -1,
      four.high_x[i] = four.high_y[i] = four.high_z[i] = 1;
  FindParts parts(spes.memory());
  EXPECT_FALSE(parts.add(a.body(), b.body(), everything()));
  EXPECT_EQ(parts.size(), 0u);
  const WrittenBody far(contact, {5, 0, 0});
  EXPECT_TRUE(parts.add(a.body(), far.body(), everything()));
  EXPECT_EQ(parts.size(), 0u) << "nothing is near";
}

}  // namespace
}  // namespace softcell::ppu
