// The kernel contact_find on an SPE: where the contacts of a job's tasks go, and what is said when there is no room for them.
// Which contacts there are is compared with the PPU's own search in tests/ppu/contacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "contact_find_job.h"
#include "ppu/spe_bodies/contact_records.h"
#include "ppu/spe_bodies/find_model.h"
#include "softcell/jobs/job_system.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/soft_body_settings.h"
#include "spu_kernels/kernel_image.h"

namespace softcell {
namespace {

using spu::FindResult;
using spu::SolveContact;

ppu::ContactModel small_cube() {
  ppu::SoftBodySettings settings;
  settings.cell_size = 0.2f;
  return ppu::ContactModel(ppu::make_soft_body_model(ppu::make_box({0.4f, 0.4f, 0.4f}, 0.1f), settings));
}

/// Tasks of two cubes at the same place, which touch wherever they have points, and of two that are far from each other.
class FindJobOfCubes {
 public:
  static constexpr std::uint32_t kMostTasks = 4;

  FindJobOfCubes() {
    const ppu::FindModel model(model_);
    std::copy(model.cells.begin(), model.cells.end(), cells_.span().begin());
    std::copy(model.groups.begin(), model.groups.end(), groups_.span().begin());
    std::fill_n(task_.low, 3, -100.0f);
    std::fill_n(task_.high, 3, 100.0f);
    task_.a = body_at(0);
    task_.b = body_at(0);
    task_.candidate_count = spu::kFindUnknown;
    task_.step = 0.01f;
    task_.inverse_step = 100;
    apart_ = task_;
    apart_.b = body_at(1);
    std::memset(contacts_.data(), 0xA5, contacts_.size() * sizeof(SolveContact));
  }

  const spu::FindTask& together() const { return task_; }
  const spu::FindTask& apart() const { return apart_; }

  std::vector<FindResult> run(const std::vector<spu::FindTask>& tasks, std::uint32_t room) {
    std::copy(tasks.begin(), tasks.end(), tasks_.span().begin());
    job_[0] = {};
    job_[0].tasks_ea = tasks_.ea().value;
    job_[0].results_ea = results_.ea().value;
    job_[0].contacts_ea = contacts_.ea().value;
    job_[0].task_count = static_cast<std::uint32_t>(tasks.size());
    job_[0].contacts_room = room;
    ppu::JobChain chain(jobs_, "find", 1);
    chain.add({jobs_.load(image_), job_.ea()});
    chain.kick();
    chain.wait();
    EXPECT_TRUE(chain.failures().empty());
    return {results_.data(), results_.data() + tasks.size()};
  }

  bool same_contacts(std::uint32_t first, std::uint32_t other, std::uint32_t count) const {
    return std::memcmp(contacts_.data() + first, contacts_.data() + other, count * sizeof(SolveContact)) == 0;
  }
  bool is_untouched_from(std::uint32_t contact) const {
    const auto* const begin = reinterpret_cast<const unsigned char*>(contacts_.data() + contact);
    const auto* const end = reinterpret_cast<const unsigned char*>(contacts_.data() + contacts_.size());
    return std::all_of(begin, end, [](unsigned char byte) { return byte == 0xA5; });
  }

 private:
  static constexpr float kFar = 50;

  /// @param place  number of its state
  spu::FindBody body_at(std::size_t place) {
    const ppu::Lattice<3>& lattice = model_.lattice();
    const std::size_t particles = lattice.particles.size(), boxes = (cells_.size() + 3) / 4 * 6;
    spu::FindEnd* const state = states_.data() + place * (boxes + 2 * particles);
    const float x = kFar * static_cast<float>(place);
    for (std::size_t i = 0; i < boxes; ++i) {
      const float side = i % 6 < 3 ? -0.5f : 0.5f, by_x = i % 3 == 0 ? x + side : side;
      state[i] = {by_x, by_x, by_x, by_x};
    }
    for (std::size_t p = 0; p < particles; ++p) {
      const Eigen::Vector3f& rest = lattice.rest_position(p);
      state[boxes + p] = {rest.x() + x, rest.y(), rest.z(), 0};
      state[boxes + particles + p] = {rest.x() + x, rest.y(), rest.z(), 1};
    }
    spu::FindBody body{};
    body.cells_ea = cells_.ea().value;
    body.groups_ea = groups_.ea().value;
    body.state_ea = states_.ea(place * (boxes + 2 * particles)).value;
    body.cell_count = static_cast<std::uint32_t>(cells_.size());
    body.group_count = static_cast<std::uint32_t>(groups_.size());
    body.particle_count = static_cast<std::uint32_t>(particles);
    body.spacing = 0.2f;
    body.middle[0] = x;
    return body;
  }

  ppu::ContactModel model_ = small_cube();
  dma::AddressSpace memory_;
  ls_sim::KernelImage image_ = test::kernel_image("contact_find"), job_loop_ = test::kernel_image("job_loop");
  ppu::JobSystem jobs_{memory_, {.spes = 1}, job_loop_};
  dma::Buffer<spu::FindCell> cells_ =
      ppu::contact_buffer<spu::FindCell>(memory_, "cells", ppu::FindModel(model_).cells.size());
  dma::Buffer<spu::FindGroup> groups_ =
      ppu::contact_buffer<spu::FindGroup>(memory_, "groups", ppu::FindModel(model_).groups.size());
  dma::Buffer<spu::FindEnd> states_ = ppu::contact_buffer<spu::FindEnd>(
      memory_, "states", 2 * ((cells_.size() + 3) / 4 * 6 + 2 * model_.lattice().particles.size()));
  dma::Buffer<spu::FindTask> tasks_ = ppu::contact_buffer<spu::FindTask>(memory_, "tasks", kMostTasks);
  dma::Buffer<FindResult> results_ = ppu::contact_buffer<FindResult>(memory_, "results", kMostTasks);
  dma::Buffer<SolveContact> contacts_ =
      ppu::contact_buffer<SolveContact>(memory_, "contacts", kMostTasks* spu::kFindMaxContacts);
  dma::Buffer<spu::FindJob> job_ = ppu::contact_buffer<spu::FindJob>(memory_, "job", 1);
  spu::FindTask task_{}, apart_{};
};

TEST(ContactFind, ContactsOfAJobsTasksAreBesideEachOther) {
  FindJobOfCubes job;
  const auto results = job.run({job.together(), job.apart(), job.together(), job.together()}, 1024);
  const std::uint32_t count = results[0].count;
  ASSERT_GT(count, 20u);
  ASSERT_LT(count, spu::kFindMaxContacts);
  EXPECT_EQ(results[1].count, 0u);
  for (const std::size_t i : {2, 3}) EXPECT_EQ(results[i].count, count);
  for (const FindResult& result : results) EXPECT_EQ(result.overflow, spu::kFindNoOverflow);
  EXPECT_TRUE(job.same_contacts(0, count, count));
  EXPECT_TRUE(job.same_contacts(0, 2 * count, count));
  EXPECT_TRUE(job.is_untouched_from(3 * count));
}

TEST(ContactFind, TasksForWhichAJobHasNoRoomLeftAreSaidToBeSuch) {
  FindJobOfCubes job;
  const std::uint32_t count = job.run({job.together()}, spu::kFindMaxContacts)[0].count;
  for (const std::uint32_t room : {2 * count - 1, 2 * count + count / 2}) {
    const auto results = job.run({job.together(), job.apart(), job.together(), job.together()}, room);
    const bool second_fits = room >= 2 * count;
    EXPECT_EQ(results[0].count, count);
    EXPECT_EQ(results[1].overflow, spu::kFindNoOverflow);
    EXPECT_EQ(results[2].overflow, second_fits ? spu::kFindNoOverflow : spu::kFindJobIsFull) << room;
    EXPECT_EQ(results[2].count, second_fits ? count : 0) << room;
    EXPECT_EQ(results[3].overflow, spu::kFindJobIsFull) << room;
    EXPECT_EQ(results[3].count, 0u) << room;
  }
  const auto results = job.run({job.apart(), job.together()}, 0);
  EXPECT_EQ(results[0].overflow, spu::kFindNoOverflow);
  EXPECT_EQ(results[1].overflow, spu::kFindJobIsFull);
}

TEST(ContactFind, NothingIsWrittenBehindAJobsRoom) {
  for (const std::uint32_t room : {0u, 1u, 20u, 65u}) {
    FindJobOfCubes job;
    job.run({job.together(), job.together(), job.together(), job.together()}, room);
    EXPECT_TRUE(job.is_untouched_from(room)) << room;
  }
}

}  // namespace
}  // namespace softcell
