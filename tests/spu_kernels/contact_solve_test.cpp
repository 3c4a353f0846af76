// The kernel contact_solve on an SPE: bit for bit its scalar twin, and what must be true of any solver.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "contact_solve_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/intrinsics_support.h"
#include "spu_kernels/kernel_image.h"

namespace softcell {
namespace {

using spu::SolveCell;
using spu::SolveContact;
using spu::SolveRigid;
using spu::SolveTask;
using spu::SolveVelocity;

// What the kernel's instructions compute, on numbers.
float madd(float a, float b, float c) { return std::fma(a, b, c); }
float msub(float a, float b, float c) { return std::fma(a, b, -c); }
float nmsub(float a, float b, float c) { return std::fma(-a, b, c); }
float reciprocal(float x) {
  float y = std::bit_cast<float>(0x7EF311C7u - std::bit_cast<std::uint32_t>(x));
  for (int i = 0; i < 3; ++i) y = madd(y, nmsub(x, y, 1), y);
  return y;
}
float reciprocal_sqrt(float x) {
  const float half = x * 0.5f;
  float y = std::bit_cast<float>(0x5F375A86u - (std::bit_cast<std::uint32_t>(x) >> 1));
  for (int i = 0; i < 2; ++i) y = y * nmsub(half * y, y, 1.5f);
  return y;
}
bool below_zero(float x) { return std::signbit(x); }

/// x y z of a register.
struct V {
  float x, y, z;
  template <typename Work>
  static V of(const Work& work) {
    return {work(&V::x), work(&V::y), work(&V::z)};
  }
};
using Axis = float V::*;
float sum_of_three(const V& v) { return (v.x + v.z) + (v.y + 0.0f); }
float dot(const V& a, const V& b) { return sum_of_three({a.x * b.x, a.y * b.y, a.z * b.z}); }
V turned_left(const V& v) { return {v.y, v.z, v.x}; }
V cross(const V& a, const V& b) {
  const V l = turned_left(b), m = turned_left(a);
  return turned_left(V::of([&](Axis d) { return msub(a.*d, l.*d, (m.*d) * (b.*d)); }));
}
V& vector_of(SolveVelocity& v) { return reinterpret_cast<V&>(v); }
V& vector_of(float (&v)[3]) { return reinterpret_cast<V&>(v); }

/// One task after the other, one number after the other.
class Twin {
 public:
  using Body = std::vector<SolveVelocity>;

  static V value_at(const spu::SolveAnchor& anchor, SolveVelocity* values) {
    return V::of([&](Axis d) {
      const auto value = [&](int k) { return vector_of(values[anchor.particle[k]]).*d; };
      float even = anchor.weight[0] * value(0), odd = anchor.weight[1] * value(1);
      for (int k = 2; k < 8; k += 2) {
        even = madd(anchor.weight[k], value(k), even);
        odd = madd(anchor.weight[k + 1], value(k + 1), odd);
      }
      return even + odd;
    });
  }
  static void add_at(const spu::SolveAnchor& anchor, SolveVelocity* values, const V& impulse, float sign) {
    for (int k = 0; k < 8; ++k) {
      V& v = vector_of(values[anchor.particle[k]]);
      v = V::of([&](Axis d) { return madd(anchor.weight[k], sign * impulse.*d, v.*d); });
    }
  }

  /// The contact's impulses become these, friction within its cone. @return  by how much
  static V change_to(SolveContact& c, float impulse, const V& wanted_friction) {
    const float most = c.friction * impulse, square = dot(wanted_friction, wanted_friction);
    const float scale = below_zero(msub(most, most, square)) ? most * reciprocal_sqrt(square) : 1.0f;
    const V friction = V::of([&](Axis d) { return wanted_friction.*d * scale; });
    const V before = vector_of(c.friction_impulse);
    const V change = V::of(
        [&](Axis d) { return madd(vector_of(c.normal).*d, impulse - c.impulse, friction.*d - before.*d); });
    vector_of(c.friction_impulse) = friction;
    c.impulse = impulse;
    return change;
  }

  static void solve_velocities(SolveContact& c, SolveVelocity* a, SolveVelocity* b) {
    const V n = vector_of(c.normal), at_a = value_at(c.a, a);
    V v = V::of([&](Axis d) { return at_a.*d - vector_of(c.carried).*d; });
    if (b != nullptr) {
      const V at_b = value_at(c.b, b);
      v = V::of([&](Axis d) { return v.*d - at_b.*d; });
    }
    const float along = dot(n, v), before = c.impulse;
    const float wanted = madd(c.least_velocity - along, c.mass, before);
    const float impulse = below_zero(wanted) ? 0.0f : wanted;
    const V friction_before = vector_of(c.friction_impulse);
    const V friction =
        V::of([&](Axis d) { return nmsub(nmsub(along, n.*d, v.*d), c.mass, friction_before.*d); });
    const V change = change_to(c, impulse, friction);
    add_at(c.a, a, change, 1);
    if (b != nullptr) add_at(c.b, b, change, -1);
  }

  static V value_at(const spu::SolveRigidPoint& point, const SolveRigid& rigid) {
    const V spin{rigid.spin[0], rigid.spin[1], rigid.spin[2]};
    const V turn = cross(spin, {point.arm[0], point.arm[1], point.arm[2]});
    return {rigid.velocity[0] + turn.x, rigid.velocity[1] + turn.y, rigid.velocity[2] + turn.z};
  }
  static void take_at(const spu::SolveRigidPoint& point, SolveRigid& rigid, const V& impulse) {
    const V turn = cross({point.arm[0], point.arm[1], point.arm[2]}, impulse);
    vector_of(rigid.velocity) =
        V::of([&](Axis d) { return nmsub(rigid.inverse_mass, impulse.*d, vector_of(rigid.velocity).*d); });
    minus_product(rigid.spin, rigid.inverse_inertia, turn);
    if (rigid.held == 0) return;
    minus_product(rigid.velocity, rigid.linear, impulse);
    minus_product(rigid.velocity, rigid.coupling, turn);
    minus_product(rigid.spin, rigid.coupled, impulse);
  }
  static void minus_product(float (&v)[3], const float (&columns)[3][4], const V& by) {
    for (int d = 0; d < 3; ++d) {
      v[d] = nmsub(by.x, columns[0][d], v[d]);
      v[d] = nmsub(by.y, columns[1][d], v[d]);
      v[d] = nmsub(by.z, columns[2][d], v[d]);
    }
  }
  static void solve_with_rigid(SolveContact& c, SolveVelocity* a, std::vector<SolveRigid>& rigids) {
    SolveRigid& rigid = rigids[c.rigid.rigid];
    const V n = vector_of(c.normal), at_a = value_at(c.a, a), at_b = value_at(c.rigid, rigid);
    V v = V::of([&](Axis d) { return (at_a.*d - vector_of(c.carried).*d) - at_b.*d; });
    const float before = c.impulse, wanted = madd(c.least_velocity - dot(n, v), c.mass, before);
    const float impulse = below_zero(wanted) ? 0.0f : wanted;
    v = V::of([&](Axis d) { return madd(vector_of(c.rigid.feels).*d, impulse - before, v.*d); });
    const float along = dot(n, v);
    const V friction_before = vector_of(c.friction_impulse);
    const V friction = V::of(
        [&](Axis d) { return nmsub(nmsub(along, n.*d, v.*d), c.rigid.friction_mass, friction_before.*d); });
    const V change = change_to(c, impulse, friction);
    add_at(c.a, a, change, 1);
    take_at(c.rigid, rigid, change);
  }

  static void solve_push(SolveContact& c, SolveVelocity* a, SolveVelocity* b, float mass) {
    const V n = vector_of(c.normal);
    V v = value_at(c.a, a);
    if (b != nullptr) {
      const V at_b = value_at(c.b, b);
      v = V::of([&](Axis d) { return v.*d - at_b.*d; });
    }
    const float wanted = madd(c.push_velocity - dot(n, v), mass, c.push);
    const float push = below_zero(wanted) ? 0.0f : wanted, change = push - c.push;
    const V by = V::of([&](Axis d) { return n.*d * change; });
    add_at(c.a, a, by, 1);
    if (b != nullptr) add_at(c.b, b, by, -1);
    c.push = push;
  }

  static void stiffen(const SolveCell& cell, SolveVelocity* changes, const std::vector<SolveVelocity>& start,
                      const std::vector<SolveVelocity>& positions, float share, float inverse_spacing) {
    const auto position = [&](int k) {
      const SolveVelocity& p = positions[cell.particle[k]];
      return V{p.x, p.y, p.z};
    };
    const auto velocity_by_root = [&](std::size_t k) {
      const SolveVelocity& old = start[cell.particle[k]];
      const V from{old.x, old.y, old.z};
      return V::of([&](Axis d) { return from.*d + vector_of(changes[cell.particle[k]]).*d; });
    };
    const V first = position(0), first_now = velocity_by_root(0);
    const float by_first_root = reciprocal(start[cell.particle[0]].root);
    const V carried = V::of([&](Axis d) { return first_now.*d * by_first_root; });
    std::array<V, 8> arm;
    std::array<float, 8> root;
    std::array<V, 8> now;
    float mass = 0;
    V moment{0, 0, 0}, momentum{0, 0, 0};
    for (std::size_t k = 0; k < 8; ++k) {
      const V x = position(static_cast<int>(k)), by_root = velocity_by_root(k);
      root[k] = start[cell.particle[k]].root;
      now[k] = V::of([&](Axis d) { return madd(-root[k], carried.*d, by_root.*d); });
      const float m = root[k] * root[k];
      arm[k] = V::of([&](Axis d) { return (x.*d - first.*d) * inverse_spacing; });
      mass += m;
      moment = V::of([&](Axis d) { return madd(m, arm[k].*d, moment.*d); });
      momentum = V::of([&](Axis d) { return madd(root[k], now[k].*d, momentum.*d); });
    }
    const float by_mass = reciprocal(mass);
    const V centre = V::of([&](Axis d) { return moment.*d * by_mass; });
    const V velocity = V::of([&](Axis d) { return momentum.*d * by_mass; });
    V squares{0, 0, 0}, mixed{0, 0, 0}, spin{0, 0, 0};
    for (std::size_t k = 0; k < 8; ++k) {
      const V r = V::of([&](Axis d) { return arm[k].*d - centre.*d; }), left = turned_left(r);
      arm[k] = r;
      const float m = root[k] * root[k] * by_mass, root_by_mass = root[k] * by_mass;
      const V weighted = V::of([&](Axis d) { return m * r.*d; });
      const V turn = cross(r, now[k]);
      squares = V::of([&](Axis d) { return madd(weighted.*d, r.*d, squares.*d); });
      mixed = V::of([&](Axis d) { return madd(weighted.*d, left.*d, mixed.*d); });
      spin = V::of([&](Axis d) { return madd(root_by_mass, turn.*d, spin.*d); });
    }
    const float all = sum_of_three(squares);
    const float little = 0x1.0p-13f;
    const V diagonal = V::of([&](Axis d) { return (all - squares.*d) + little; });
    const V off = V::of([&](Axis d) { return 0.0f - mixed.*d; });  // x y, y z, z x
    const V row_x{diagonal.x, off.x, off.z}, row_y{off.x, diagonal.y, off.y}, row_z{off.z, off.y, diagonal.z};
    const V c1 = cross(row_y, row_z), c2 = cross(row_z, row_x), c3 = cross(row_x, row_y);
    const float by = reciprocal(dot(row_x, c1));
    const auto turn_of = [&](const V& s) {
      return V::of([&](Axis d) { return madd(s.x, c1.*d, madd(s.y, c2.*d, s.z * c3.*d)) * by; });
    };
    const V about = turn_of(spin);
    const V omega = turn_of(V::of([&](Axis d) { return madd(little, about.*d, spin.*d); }));
    for (std::size_t k = 0; k < 8; ++k) {
      V& v = vector_of(changes[cell.particle[k]]);
      const V turn = cross(omega, arm[k]);
      v = V::of([&](Axis d) { return madd(share, root[k] * (velocity.*d + turn.*d) - now[k].*d, v.*d); });
    }
  }

  static void solve(const SolveTask& task, std::vector<SolveContact>& contacts, Body& a, Body* b) {
    for (std::uint32_t i = 0; i < task.iterations; ++i)
      for (SolveContact& c : contacts) solve_velocities(c, a.data(), b != nullptr ? b->data() : nullptr);
    for (std::uint32_t i = 0; i < task.iterations; ++i)
      for (SolveContact& c : contacts)
        if (task.pushes != 0 && c.push_velocity > 0)
          solve_push(c, a.data() + task.a_count + 1, b != nullptr ? b->data() + task.b_count + 1 : nullptr,
                     c.mass);
  }
  static void solve(const SolveTask& task, std::vector<SolveContact>& contacts, Body& a,
                    std::vector<SolveRigid>& rigids) {
    for (std::uint32_t i = 0; i < task.iterations; ++i)
      for (SolveContact& c : contacts) solve_with_rigid(c, a.data(), rigids);
    for (std::uint32_t i = 0; i < task.iterations; ++i)
      for (SolveContact& c : contacts)
        if (task.pushes != 0 && c.push_velocity > 0)
          solve_push(c, a.data() + task.a_count + 1, nullptr, c.rigid.push_mass);
  }
};

/// Two bodies and contacts between them, in main memory and as copies for the twin.
class SolveRig {
 public:
  static constexpr std::uint32_t kA = 61, kB = 83, kContacts = 120, kRigids = 5, kCells = 20;

  explicit SolveRig(const ls_sim::SpeOptions& options = {.spes = 1})
      : image_(test::kernel_image("contact_solve", options.findings != nullptr)),
        jobs_(memory_, options, job_loop_),
        a(memory_, "a", spu::solve_slots(kA)),
        b(memory_, "b", spu::solve_slots(kB)),
        contacts(memory_, "contacts", kContacts),
        rigids(memory_, "rigids", kRigids),
        cells(memory_, "cells", kCells),
        positions(memory_, "positions", kA),
        start(memory_, "start", kA),
        tasks_(memory_, "tasks", 1),
        job_(memory_, "job", 1) {
    fill(a.span(), kA);
    fill(b.span(), kB);
    for (SolveContact& c : contacts.span()) c = contact();
    for (SolveCell& cell : cells.span()) {
      const auto anchor = anchor_in(kA);
      std::copy(std::begin(anchor.particle), std::end(anchor.particle), cell.particle);
    }
    for (SolveVelocity& p : positions.span()) p = {number(5), number(5), number(5), number(1)};
    for (SolveVelocity& v : start.span()) v = {number(2), number(2), number(2), 1 + number(0.5f)};
  }

  float number(float half) { return std::uniform_real_distribution<float>(-half, half)(random_); }

  spu::SolveAnchor anchor_in(std::uint32_t count) {
    spu::SolveAnchor anchor{};
    const auto first = static_cast<std::uint32_t>(std::uniform_int_distribution<int>(0, 1000)(random_));
    for (std::uint32_t k = 0; k < 8; ++k) {
      anchor.particle[k] = static_cast<std::uint16_t>((first + 7 * k) % count);
      anchor.weight[k] = 0.4f + number(0.35f);
    }
    return anchor;
  }

  void run(const SolveTask& task) {
    tasks_[0] = task;
    job_[0] = {};
    job_[0].tasks_ea = tasks_.ea().value;
    job_[0].task_count = 1;
    ppu::JobChain chain(jobs_, "solve", 1);
    chain.add({jobs_.load(image_), job_.ea()});
    chain.kick();
    chain.wait();
    for (const ppu::JobFailure& failure : chain.failures()) failures.push_back(failure.message);
  }

  /// Something takes a part of the impulses of each second one.
  void hold_some_rigids() {
    for (std::uint32_t i = 0; i + 1 < kRigids; i += 2) {
      SolveRigid& rigid = rigids[i];
      rigid.held = 1;
      const float free = rigid.inverse_mass;
      rigid.inverse_mass = 0;
      for (int d = 0; d < 3; ++d) {
        rigid.linear[d][d] = free * (0.5f + number(0.3f));
        rigid.linear[d][(d + 1) % 3] = rigid.linear[(d + 1) % 3][d] = number(0.03f);
        for (int k = 0; k < 3; ++k) rigid.coupling[d][k] = rigid.coupled[k][d] = number(0.05f);
      }
    }
  }

  /// Contacts are with rigid bodies from now on, of which the last one is not moved by anything.
  SolveTask task_with_rigids() {
    for (std::uint32_t i = 0; i < kRigids; ++i) {
      SolveRigid& rigid = rigids[i];
      rigid = {};
      for (int d = 0; d < 3; ++d) rigid.velocity[d] = number(0.2f), rigid.spin[d] = number(0.2f);
      if (i + 1 == kRigids) continue;
      rigid.inverse_mass = 0.3f + number(0.2f);
      for (int d = 0; d < 3; ++d) rigid.inverse_inertia[d][d] = 2 + number(1);
      for (int d = 0; d < 3; ++d)
        rigid.inverse_inertia[d][(d + 1) % 3] = rigid.inverse_inertia[(d + 1) % 3][d] = number(0.3f);
    }
    for (SolveContact& c : contacts.span()) {
      float own = 0;
      for (const float weight : c.a.weight) own += weight * weight;
      c.rigid = {};
      c.rigid.rigid = static_cast<std::uint16_t>(std::uniform_int_distribution<int>(0, kRigids - 1)(random_));
      const SolveRigid& rigid = rigids[c.rigid.rigid];
      for (float& arm : c.rigid.arm) arm = number(0.4f);
      V& arm = vector_of(c.rigid.arm);
      const V n = vector_of(c.normal), turn = cross(arm, n);
      V spin{0, 0, 0};
      for (const Axis d : {&V::x, &V::y, &V::z})
        for (int k = 0; k < 3; ++k)
          spin.*d += (k == 0   ? turn.x
                      : k == 1 ? turn.y
                               : turn.z) *
                     rigid.inverse_inertia[k][d == &V::x   ? 0
                                              : d == &V::y ? 1
                                                           : 2];
      const V moved = cross(spin, arm);
      vector_of(c.rigid.feels) = V::of([&](Axis d) { return (own + rigid.inverse_mass) * n.*d + moved.*d; });
      c.rigid.push_mass = 1 / own;
      c.rigid.friction_mass = 1 / (own + rigid.inverse_mass + 0.5f);
      c.mass = 1 / dot(n, vector_of(c.rigid.feels));
    }
    SolveTask with_rigids = task();
    with_rigids.b_ea = 0;
    with_rigids.rigids_ea = rigids.ea().value;
    with_rigids.rigid_count = kRigids;
    return with_rigids;
  }

  SolveTask task() const {
    SolveTask task{};
    task.a_ea = a.ea().value;
    task.b_ea = b.ea().value;
    task.contacts_ea = contacts.ea().value;
    task.a_count = kA;
    task.b_count = kB;
    task.contact_count = kContacts;
    task.iterations = 4;
    task.pushes = 1;
    return task;
  }

 private:
  void fill(std::span<SolveVelocity> body, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      body[i] = {number(2), number(2), number(2), 0};
      body[count + 1 + i] = {number(0.1f), number(0.1f), number(0.1f), 0};
    }
    body[count] = body[2 * count + 1] = {};
  }
  SolveContact contact() {
    SolveContact c{};
    c.a = anchor_in(kA);
    c.b = anchor_in(kB);
    float normal[3] = {number(1), number(1), number(1) + 1.5f};
    const float length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    float mobility = 0;
    for (int k = 0; k < 8; ++k) mobility += c.a.weight[k] * c.a.weight[k] + c.b.weight[k] * c.b.weight[k];
    for (int d = 0; d < 3; ++d) {
      c.normal[d] = normal[d] / length;
      c.carried[d] = number(0.3f);
      c.point[d] = number(3);
    }
    c.least_velocity = number(0.5f);
    c.mass = 1 / mobility;
    c.friction = 0.4f + number(0.4f);
    c.push_velocity = std::max(0.0f, number(0.2f));
    return c;
  }

  std::mt19937 random_{11};
  dma::AddressSpace memory_;
  ls_sim::KernelImage image_, job_loop_ = test::kernel_image("job_loop");
  ppu::JobSystem jobs_;

 public:
  dma::Buffer<SolveVelocity> a, b;
  dma::Buffer<SolveContact> contacts;
  dma::Buffer<SolveRigid> rigids;
  dma::Buffer<SolveCell> cells;
  dma::Buffer<SolveVelocity> positions, start;
  std::vector<std::string> failures;

 private:
  dma::Buffer<SolveTask> tasks_;
  dma::Buffer<spu::SolveJob> job_;
};

template <typename T>
std::vector<T> copy_of(const dma::Buffer<T>& buffer) {
  return {buffer.span().begin(), buffer.span().end()};
}

/// Bits, but for the fourth lanes of pushes, which mean nothing.
void expect_same(const std::vector<SolveVelocity>& expected, const dma::Buffer<SolveVelocity>& found,
                 const char* what) {
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (const auto axis : {&SolveVelocity::x, &SolveVelocity::y, &SolveVelocity::z})
      ASSERT_EQ(std::bit_cast<std::uint32_t>(expected[i].*axis), std::bit_cast<std::uint32_t>(found[i].*axis))
          << what << ' ' << i << ": " << expected[i].*axis << ", " << found[i].*axis;
}

/// @param two  with a second body, or with what nothing moves
void expect_twin(bool two, bool itself, bool stiffens) {
  SolveRig rig;
  SolveTask task = rig.task();
  if (!two) task.b_ea = 0;
  if (itself) {
    task.b_ea = task.a_ea, task.b_count = task.a_count;
    for (SolveContact& c : rig.contacts.span()) c.b = rig.anchor_in(SolveRig::kA);
  }
  if (stiffens) {
    task.cells_ea = rig.cells.ea().value;
    task.cell_count = SolveRig::kCells;
    task.positions_ea = rig.positions.ea().value;
    task.start_ea = rig.start.ea().value;
    task.stiffening = 0.5f;
    task.inverse_spacing = 4;
  }
  auto a = copy_of(rig.a), b = copy_of(rig.b);
  const auto positions = copy_of(rig.positions), start = copy_of(rig.start);
  auto contacts = copy_of(rig.contacts);
  rig.run(task);
  ASSERT_TRUE(rig.failures.empty()) << rig.failures[0];
  {
    const unsigned int host = _mm_getcsr();
    _mm_setcsr(test::kSpuArithmetic);
    Twin::solve(task, contacts, a, !two ? nullptr : itself ? &a : &b);
    if (stiffens)
      for (const SolveCell& cell : rig.cells.span())
        Twin::stiffen(cell, a.data(), start, positions, task.stiffening, task.inverse_spacing);
    _mm_setcsr(host);
  }
  float most = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const SolveContact& found = rig.contacts[i];
    ASSERT_EQ(contacts[i].impulse, found.impulse) << i;
    ASSERT_EQ(contacts[i].push, found.push) << i;
    for (int d = 0; d < 3; ++d) ASSERT_EQ(contacts[i].friction_impulse[d], found.friction_impulse[d]) << i;
    ASSERT_GE(found.impulse, 0);
    most = std::max(most, found.impulse);
  }
  EXPECT_GT(most, 0.05f);
  expect_same(a, rig.a, "a");
  expect_same(b, rig.b, "b");
}

TEST(ContactSolve, TwoBodiesAreBitForBitTheTwin) { expect_twin(true, false, false); }
TEST(ContactSolve, ABodyAndWhatNothingMovesAreBitForBitTheTwin) { expect_twin(false, false, false); }
TEST(ContactSolve, ABodyWithItselfIsBitForBitTheTwin) { expect_twin(true, true, false); }
TEST(ContactSolve, StiffenedCellsAreBitForBitTheTwin) { expect_twin(false, false, true); }

namespace {

void expect_twin_with_rigids(bool held) {
  SolveRig rig;
  const SolveTask task = rig.task_with_rigids();
  if (held) rig.hold_some_rigids();
  auto a = copy_of(rig.a);
  auto contacts = copy_of(rig.contacts);
  auto rigids = copy_of(rig.rigids);
  const auto before = rigids;
  rig.run(task);
  ASSERT_TRUE(rig.failures.empty()) << rig.failures[0];
  {
    const unsigned int host = _mm_getcsr();
    _mm_setcsr(test::kSpuArithmetic);
    Twin::solve(task, contacts, a, rigids);
    _mm_setcsr(host);
  }
  expect_same(a, rig.a, "a");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ASSERT_EQ(contacts[i].impulse, rig.contacts[i].impulse) << i;
    ASSERT_EQ(contacts[i].push, rig.contacts[i].push) << i;
    for (int d = 0; d < 3; ++d)
      ASSERT_EQ(contacts[i].friction_impulse[d], rig.contacts[i].friction_impulse[d]) << i;
  }
  for (std::size_t i = 0; i < rigids.size(); ++i) {
    const bool moves = i + 1 < rigids.size();
    EXPECT_EQ(rig.rigids[i].velocity[0] != before[i].velocity[0], moves) << i;
    for (int d = 0; d < 3; ++d) {
      ASSERT_EQ(rigids[i].velocity[d], rig.rigids[i].velocity[d]) << i;
      ASSERT_EQ(rigids[i].spin[d], rig.rigids[i].spin[d]) << i;
    }
    EXPECT_EQ(rig.rigids[i].inverse_mass, before[i].inverse_mass);
  }
}

}  // namespace

TEST(ContactSolve, ABodyAndRigidOnesAreBitForBitTheTwin) { expect_twin_with_rigids(false); }
TEST(ContactSolve, ABodyAndRigidOnesThatLieOnSomethingAreBitForBitTheTwin) { expect_twin_with_rigids(true); }

/// What the soft body gets, rigid ones lose.
TEST(ContactSolve, ABodyAndRigidOnesKeepTheirMomentum) {
  SolveRig rig;
  SolveTask task = rig.task_with_rigids();
  task.pushes = 0;
  const auto rigids = copy_of(rig.rigids);
  rig.run(task);
  std::array<double, 3> given{}, lost{};
  double most = 0;
  for (const SolveContact& c : rig.contacts.span()) {
    if (c.rigid.rigid + 1 == SolveRig::kRigids) continue;
    for (std::size_t d = 0; d < 3; ++d)
      given[d] += double{c.impulse} * double{c.normal[d]} + double{c.friction_impulse[d]};
    most = std::max(most, double{c.impulse});
  }
  EXPECT_GT(most, 0.05);
  for (std::size_t i = 0; i + 1 < SolveRig::kRigids; ++i)
    for (std::size_t d = 0; d < 3; ++d)
      lost[d] -= double{rig.rigids[i].velocity[d] - rigids[i].velocity[d]} / double{rigids[i].inverse_mass};
  for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(lost[d], given[d], 1e-4) << d;
}

TEST(ContactSolve, StiffeningKeepsBothMomenta) {
  SolveRig rig;
  SolveTask task = rig.task();
  task.contact_count = 0;
  task.pushes = 0;
  task.b_ea = 0;
  task.cells_ea = rig.cells.ea().value;
  task.cell_count = SolveRig::kCells;
  task.positions_ea = rig.positions.ea().value;
  task.start_ea = rig.start.ea().value;
  task.stiffening = 1;
  task.inverse_spacing = 0.3f;
  const auto momenta = [&] {
    std::array<double, 6> sums{};
    for (std::uint32_t i = 0; i < SolveRig::kA; ++i) {
      const double m = rig.start[i].root;
      const std::array<double, 3> p{m * rig.a[i].x, m * rig.a[i].y, m * rig.a[i].z};  // the start stays
      const std::array<double, 3> x{rig.positions[i].x, rig.positions[i].y, rig.positions[i].z};
      for (std::size_t d = 0; d < 3; ++d) {
        sums[d] += p[d];
        sums[3 + d] += x[(d + 1) % 3] * p[(d + 2) % 3] - x[(d + 2) % 3] * p[(d + 1) % 3];
      }
    }
    return sums;
  };
  const auto before = momenta();
  const auto old = copy_of(rig.a);
  rig.run(task);
  ASSERT_TRUE(rig.failures.empty()) << rig.failures[0];
  const auto after = momenta();
  for (std::size_t d = 0; d < 6; ++d) {
    // Inertia is a little too large, for cells that are pressed to a line: spin is kept to so much.
    EXPECT_NEAR(after[d], before[d], d < 3 ? 1e-4 : 0.3) << d;
  }
  double changed = 0;
  for (std::size_t i = 0; i < old.size(); ++i) changed += std::abs(old[i].x - rig.a[i].x);
  EXPECT_GT(changed, 1);
}

TEST(ContactSolve, SleepersAreNotWritten) {
  SolveRig rig;
  SolveTask task = rig.task();
  task.b_sleeps = 1;
  const auto b = copy_of(rig.b);
  rig.run(task);
  expect_same(b, rig.b, "b");
}

TEST(ContactSolve, WhatIsTooLargeIsRefused) {
  for (const int which : {0, 1, 2, 3, 4}) {
    SolveRig rig;
    SolveTask task = rig.task();
    if (which == 0) task.a_count = spu::kSolveMaxParticles + 1;
    if (which == 1) task.b_count = spu::kSolveMaxParticles + 1;
    if (which == 2) task.contact_count = spu::kSolveMaxContacts + 1;
    if (which == 3) task.cell_count = spu::kSolveMaxCells + 1;
    if (which == 4) task.rigid_count = spu::kSolveMaxRigids + 1;
    const auto a = copy_of(rig.a);
    rig.run(task);
    ASSERT_EQ(rig.failures.size(), 1u);
    EXPECT_NE(rig.failures[0].find("status 1"), std::string::npos) << rig.failures[0];
    expect_same(a, rig.a, "a");
  }
}

TEST(ContactSolve, ItsCheckedImageFindsNothing) {
  test::expect_no_findings([](const ls_sim::SpeOptions& options) {
    SolveRig rig(options);
    SolveTask task = rig.task();
    task.cells_ea = rig.cells.ea().value;
    task.cell_count = SolveRig::kCells;
    task.positions_ea = rig.positions.ea().value;
    task.start_ea = rig.start.ea().value;
    task.stiffening = 0.5f;
    task.inverse_spacing = 4;
    rig.run(task);
    rig.run(rig.task_with_rigids());
    EXPECT_TRUE(rig.failures.empty()) << rig.failures[0];
  });
}

}  // namespace
}  // namespace softcell
