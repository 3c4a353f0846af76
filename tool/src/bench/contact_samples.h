#pragma once
// Work for the kernels contact_find and contact_solve, for measuring their stacks.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "body_samples.h"
#include "contact_find_job.h"
#include "ppu/spe_bodies/contact_records.h"
#include "ppu/spe_bodies/find_model.h"
#include "softcell/dma/buffer.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::tool {

/// The ball that both kernels get, and room for its contacts.
struct ContactSample {
  explicit ContactSample(SampleRun& sample)
      : contacts(ppu::contact_buffer<spu::SolveContact>(sample.memory(), "contacts", spu::kFindMaxContacts)) {
  }
  static ppu::SoftBodySettings ball_settings() {
    ppu::SoftBodySettings settings;
    settings.cell_size = 0.2f;
    return settings;
  }
  const ppu::Lattice<3>& lattice() const { return ball.lattice(); }
  std::uint32_t particles() const { return static_cast<std::uint32_t>(lattice().particles.size()); }

  ppu::ContactModel ball{ppu::make_soft_body_model(ppu::make_sphere(0.5f, 12), ball_settings())};
  dma::Buffer<spu::SolveContact> contacts;
};

/// Solves a contact of two balls, and stiffens a cell.
inline void run_contact_solve(SampleRun& sample) {
  ContactSample balls(sample);
  auto& contacts = balls.contacts;
  const ppu::Lattice<3>& lattice = balls.lattice();
  const std::uint32_t particles = balls.particles();
  auto changes =
      ppu::contact_buffer<spu::SolveVelocity>(sample.memory(), "changes", spu::solve_slots(particles));
  auto positions = ppu::contact_buffer<spu::SolveVelocity>(sample.memory(), "positions", particles);
  auto cells = ppu::contact_buffer<spu::SolveCell>(sample.memory(), "cells", 1);
  for (std::uint32_t i = 0; i < particles; ++i)
    positions[i] = {lattice.rest_position(i).x(), lattice.rest_position(i).y(), lattice.rest_position(i).z(),
                    1};
  for (int k = 0; k < 8; ++k) {
    const auto corner = static_cast<std::uint16_t>(lattice.corners[0][static_cast<std::size_t>(k)]);
    contacts[0].a.particle[k] = contacts[0].b.particle[k] = cells[0].particle[k] = corner;
    contacts[0].a.weight[k] = 0.125f, contacts[0].b.weight[k] = 0;
  }
  contacts[0].normal[1] = contacts[0].least_velocity = contacts[0].mass = contacts[0].push_velocity = 1;
  auto task = ppu::contact_buffer<spu::SolveTask>(sample.memory(), "task", 1);
  task[0].a_ea = task[0].b_ea = changes.ea().value;
  task[0].contacts_ea = contacts.ea().value;
  task[0].cells_ea = cells.ea().value;
  task[0].positions_ea = task[0].start_ea = positions.ea().value;
  task[0].a_count = task[0].b_count = particles;
  task[0].contact_count = task[0].cell_count = task[0].pushes = 1;
  task[0].iterations = 4;
  task[0].stiffening = 0.5f;
  task[0].inverse_spacing = 1;
  auto job = ppu::contact_buffer<spu::SolveJob>(sample.memory(), "job", 1);
  job[0].tasks_ea = task.ea().value;
  job[0].task_count = 1;
  // First with a rigid body, then, as the timed work, with another soft body.
  const spu::SolveTask between_bodies = task[0];
  const spu::SolveContact contact_of_bodies = contacts[0];
  auto rigids = ppu::contact_buffer<spu::SolveRigid>(sample.memory(), "rigid body", 1);
  rigids[0].inverse_mass = 1;
  contacts[0].rigid = {};
  contacts[0].rigid.feels[1] = 2;
  contacts[0].rigid.push_mass = contacts[0].rigid.friction_mass = 1;
  task[0].b_ea = 0;
  task[0].rigids_ea = rigids.ea().value;
  task[0].rigid_count = 1;
  sample.run(job.ea());
  task[0] = between_bodies;
  contacts[0] = contact_of_bodies;
  sample.begin_timing();
  sample.run(job.ea());
}

/// Finds the contacts of two overlapping balls.
inline void run_contact_find(SampleRun& sample) {
  ContactSample balls(sample);
  const ppu::Lattice<3>& lattice = balls.lattice();
  const std::uint32_t particles = balls.particles();
  const ppu::FindModel model(balls.ball);
  auto cells = ppu::contact_buffer<spu::FindCell>(sample.memory(), "cells", model.cells.size());
  auto groups = ppu::contact_buffer<spu::FindGroup>(sample.memory(), "groups", model.groups.size());
  std::copy(model.cells.begin(), model.cells.end(), cells.span().begin());
  std::copy(model.groups.begin(), model.groups.end(), groups.span().begin());
  const std::size_t boxes = (model.cells.size() + 3) / 4;
  const std::size_t quads = boxes * 6 + 2 * std::size_t{particles};
  auto states = ppu::contact_buffer<spu::FindEnd>(sample.memory(), "states", 2 * quads);
  auto task = ppu::contact_buffer<spu::FindTask>(sample.memory(), "task", 1);
  for (std::size_t b = 0; b < 2; ++b) {
    spu::FindEnd* const state = states.data() + b * quads;
    for (std::size_t i = 0; i < particles; ++i) {
      const Eigen::Vector3f x =
          lattice.rest_position(i) + 0.8f * static_cast<float>(b) * Eigen::Vector3f::UnitX();
      state[boxes * 6 + i] = {x.x(), x.y(), x.z(), 0};
      state[boxes * 6 + particles + i] = {x.x(), x.y(), x.z(), 1};
    }
    // With boxes around everything, so that all cells are near.
    for (std::size_t q = 0; q < boxes * 6; ++q) {
      const float side = q % 6 < 3 ? -2.0f : 2.0f;
      state[q] = {side, side, side, side};
    }
    spu::FindBody& body = b == 0 ? task[0].a : task[0].b;
    body.cells_ea = cells.ea().value;
    body.groups_ea = groups.ea().value;
    body.state_ea = states.ea(b * quads).value;
    body.cell_count = static_cast<std::uint32_t>(model.cells.size());
    body.group_count = static_cast<std::uint32_t>(model.groups.size());
    body.particle_count = particles;
    body.spacing = 0.2f;
    body.middle[0] = 0.8f * static_cast<float>(b);
  }
  std::fill_n(task[0].low, 3, -2.0f);
  std::fill_n(task[0].high, 3, 2.0f);
  task[0].candidate_count = spu::kFindUnknown;
  task[0].step = 0.01f;
  task[0].inverse_step = 100;
  auto result = ppu::contact_buffer<spu::FindResult>(sample.memory(), "result", 1);
  auto job = ppu::contact_buffer<spu::FindJob>(sample.memory(), "job", 1);
  job[0].tasks_ea = task.ea().value;
  job[0].results_ea = result.ea().value;
  job[0].contacts_ea = balls.contacts.ea().value;
  job[0].task_count = 1;
  job[0].contacts_room = spu::kFindMaxContacts;
  sample.run(job.ea());
}

}  // namespace softcell::tool
