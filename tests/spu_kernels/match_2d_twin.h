#pragma once
// The scalar twin of the kernel match_2d: the same step, one number after the other, from the same plan.
// Every operation is rounded as the kernel's, in the same order, so the results are the same bits.

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "ppu/plans/match_plan_2d.h"
#include "spu_kernels/intrinsics_support.h"

namespace softcell::test {

/// The SPU's arithmetic for as long as it lives.
class SpuMode {
 public:
  SpuMode() { _mm_setcsr(kSpuArithmetic); }
  ~SpuMode() { _mm_setcsr(host_); }
  SpuMode(const SpuMode&) = delete;
  SpuMode& operator=(const SpuMode&) = delete;

 private:
  const unsigned int host_ = _mm_getcsr();
};

class Match2dTwin {
 public:
  using Vector = spu::MatchVector2d;

  explicit Match2dTwin(const ppu::MatchPlan2d& plan)
      : bytes_(plan.bytes().data()),
        header_(plan.header()),
        directions(header_.regions, Vector{1, 0}),
        centres_(header_.regions) {}

  void step(const std::vector<Vector>& positions, std::vector<Vector>& velocities, float pull,
            float damping) {
    const SpuMode mode;
    localise(positions);
    match(velocities, pull);
    if (damping > 0) damp(velocities, damping);
  }

 private:
  using Payload = std::array<float, 4>;
  using Slots = std::vector<Payload>;

  // What the kernel's instructions compute.
  static float madd(float a, float b, float c) { return std::fma(a, b, c); }
  static float msub(float a, float b, float c) { return std::fma(a, b, -c); }
  static float nmsub(float a, float b, float c) { return std::fma(-a, b, c); }
  static float dot(Vector a, Vector b) { return madd(a.x, b.x, a.y * b.y); }
  static float cross(Vector a, Vector b) { return msub(a.x, b.y, a.y * b.x); }
  static Vector scale(Vector a, float s) { return {a.x * s, a.y * s}; }
  static Vector add_turned(Vector to, Vector direction, Vector v) {
    return {nmsub(direction.y, v.y, madd(direction.x, v.x, to.x)),
            madd(direction.y, v.x, madd(direction.x, v.y, to.y))};
  }
  static Vector subtract_turned(Vector from, Vector direction, Vector v) {
    return {madd(direction.y, v.y, nmsub(direction.x, v.x, from.x)),
            nmsub(direction.y, v.x, nmsub(direction.x, v.y, from.y))};
  }
  static float reciprocal(float x) {
    float y = std::bit_cast<float>(0x7EF311C7u - std::bit_cast<std::uint32_t>(x));
    for (int i = 0; i < 3; ++i) y = madd(y, nmsub(x, y, 1), y);
    return y;
  }
  static float reciprocal_sqrt(float x) {
    const float half = x * 0.5f;
    float y = std::bit_cast<float>(0x5F375A86u - (std::bit_cast<std::uint32_t>(x) >> 1));
    for (int i = 0; i < 2; ++i) y = y * nmsub(half * y, y, 1.5f);
    return y;
  }
  /// (C, S) / |(C, S)|, or `kept`.
  static Vector direction_of(float c, float s, float weight, float floor, Vector kept) {
    const float sum = std::fabs(c) + std::fabs(s);
    if (sum > 1.7e38f || sum * weight <= floor || sum < 1e-37f) return kept;
    const float by = std::bit_cast<float>(0x7F000000u - (std::bit_cast<std::uint32_t>(sum) & 0x7F800000u));
    const Vector v = {c * by, s * by};
    const Vector u = scale(v, reciprocal_sqrt(dot(v, v)));
    const float missing = nmsub(0.5f * u.x, u.x, nmsub(0.5f * u.y, u.y, 0.5f));
    return {madd(u.x, missing, u.x), madd(u.y, missing, u.y)};
  }

  template <typename T>
  const T* part(std::uint32_t offset) const {
    return reinterpret_cast<const T*>(bytes_ + offset);
  }
  struct Particle {
    Vector rest;
    float modified_mass, share, mass;
    std::size_t slot;  // of its region
  };
  Particle particle(std::size_t i) const {
    const auto& group = part<spu::MatchParticles2d>(header_.particle_constants)[i / 4];
    const std::size_t k = i % 4;
    return {{group.rest_x[k], group.rest_y[k]},
            group.modified_mass[k],
            group.share[k],
            group.mass[k],
            group.region[k] * spu::kSumOffsetUnit / spu::kMatch2dSlotBytes};
  }
  struct Region {
    Vector centre;
    float inverse_mass;
  };
  Region region(std::size_t r) const {
    const auto& group = part<spu::MatchRegions2d>(header_.region_constants)[r / 4];
    return {{group.centre_x[r % 4], group.centre_y[r % 4]}, group.inverse_mass[r % 4]};
  }

  /// Positions about their mean on the grid: four partial sums over pairs of particles, and the last group
  /// filled up with the first particle.
  void localise(const std::vector<Vector>& positions) {
    std::vector<Vector> x = positions;
    x.resize((x.size() + 3) / 4 * 4, positions[0]);
    Vector sums[4][2] = {};  // of each partial sum and half of a quadword
    const std::size_t pairs = x.size() / 2, even = pairs / 4 * 4;
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      for (std::size_t half = 0; half < 2; ++half) {
        Vector& sum = sums[pair < even ? pair % 4 : 0][half];
        sum = {sum.x + (x[2 * pair + half].x - x[0].x), sum.y + (x[2 * pair + half].y - x[0].y)};
      }
    }
    const float share = 1.0f / static_cast<float>(positions.size());
    const float large = 12582912.0f * header_.grid;
    const auto origin = [&](float Vector::*axis) {
      const auto half = [&](int h) {
        return (sums[0][h].*axis + sums[1][h].*axis) + (sums[2][h].*axis + sums[3][h].*axis);
      };
      return (madd(half(0) + half(1), share, x[0].*axis) + large) - large;
    };
    const Vector o = {origin(&Vector::x), origin(&Vector::y)};
    x_.clear();
    for (const Vector& p : positions) x_.push_back({p.x - o.x, p.y - o.y});
  }

  Slots sum(std::uint32_t list_offset, const Slots& in) const {
    const auto* list = part<std::uint16_t>(list_offset);
    const auto at = [&](std::uint16_t offset) -> const Payload& {
      return in.at(offset * spu::kSumOffsetUnit / spu::kMatch2dSlotBytes);
    };
    Slots out(header_.slots);
    std::size_t next = 1;
    while (const std::uint16_t terms = *list++) {
      std::uint16_t growing = *list++, sliding = *list++, shrinking = *list++;
      Payload sum = at(*list++);
      const auto add = [&](std::uint16_t offset, float sign) {
        for (std::size_t k = 0; k < 4; ++k) sum[k] += sign * at(offset)[k];
      };
      for (std::uint16_t i = 1; i < terms; ++i) add(*list++, 1);
      out.at(next++) = sum;
      for (; growing != 0; --growing, out.at(next++) = sum) add(*list++, 1);
      for (; sliding != 0; --sliding, list += 2, out.at(next++) = sum)
        for (std::size_t k = 0; k < 4; ++k) sum[k] += at(list[0])[k] - at(list[1])[k];
      for (; shrinking != 0; --shrinking, out.at(next++) = sum) add(*list++, -1);
    }
    return out;
  }
  Slots sum_up(const Slots& particles) const {
    return sum(header_.regions_of_bars, sum(header_.bars_of_particles, particles));
  }
  Slots sum_down(const Slots& regions) const {
    return sum(header_.regions_of_bars, sum(header_.bars_of_regions, regions));
  }

  void match(std::vector<Vector>& v, float pull) {
    Slots slots(header_.slots);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Particle p = particle(i);
      const Vector m = scale(x_[i], p.modified_mass);
      slots[i + 1] = {m.x, m.y, dot(m, p.rest), cross(p.rest, m)};
    }
    slots = sum_up(slots);
    for (std::size_t r = 0; r < header_.regions; ++r) {
      const Region g = region(r);
      Payload& sum = slots[r + 1];
      const Vector momentum = {sum[0], sum[1]};
      const float c = nmsub(momentum.x, g.centre.x, nmsub(momentum.y, g.centre.y, sum[2]));
      const float s = nmsub(g.centre.x, momentum.y, madd(g.centre.y, momentum.x, sum[3]));
      directions[r] = direction_of(c, s, g.inverse_mass, header_.noise_floor, directions[r]);
      centres_[r] = scale(momentum, g.inverse_mass);
      const Vector t = subtract_turned(centres_[r], directions[r], g.centre);
      sum = {t.x, t.y, directions[r].x, directions[r].y};
    }
    slots = sum_down(slots);

    struct Lane {
      Vector moved{0, 0}, moment{0, 0};
      float turned = 0, inertia = 0;
    } lanes[4];
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Particle p = particle(i);
      const Payload& sum = slots[p.slot];
      const Vector goal = add_turned({sum[0], sum[1]}, {sum[2], sum[3]}, p.rest);
      const Vector x = x_[i], d = {msub(goal.x, p.share, x.x), msub(goal.y, p.share, x.y)};
      const Vector moment = scale(x, p.mass);
      v[i] = {madd(d.x, pull, v[i].x), madd(d.y, pull, v[i].y)};
      Lane& lane = lanes[i % 4];
      lane.moved = {madd(d.x, p.mass, lane.moved.x), madd(d.y, p.mass, lane.moved.y)};
      lane.moment = {lane.moment.x + moment.x, lane.moment.y + moment.y};
      lane.turned = nmsub(moment.y, d.x, madd(moment.x, d.y, lane.turned));
      lane.inertia = madd(moment.x, x.x, madd(moment.y, x.y, lane.inertia));
    }
    const auto all = [&](auto value) {
      return (value(lanes[0]) + value(lanes[2])) + (value(lanes[1]) + value(lanes[3]));
    };
    const float by = header_.inverse_mass;
    const Vector centre = scale(
        {all([](const Lane& l) { return l.moment.x; }), all([](const Lane& l) { return l.moment.y; })}, by);
    const Vector drift = scale(
        {all([](const Lane& l) { return l.moved.x; }), all([](const Lane& l) { return l.moved.y; })}, by);
    const float inertia = msub(all([](const Lane& l) { return l.inertia; }), by, dot(centre, centre));
    const float spin = msub(all([](const Lane& l) { return l.turned; }), by, cross(centre, drift));
    const float omega = pull * angular_velocity(spin, inertia);
    const Vector b = {madd(omega, centre.y, pull * drift.x), msub(pull, drift.y, omega * centre.x)};
    for (std::size_t i = 0; i < x_.size(); ++i)
      v[i] = {madd(omega, x_[i].y, v[i].x - b.x), nmsub(omega, x_[i].x, v[i].y - b.y)};
  }

  float angular_velocity(float momentum, float inertia) const {
    return inertia > header_.noise_floor ? momentum * reciprocal(inertia) : 0;
  }

  void damp(std::vector<Vector>& v, float damping) {
    Slots slots(header_.slots);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const float mass = particle(i).modified_mass;
      const Vector m = scale(v[i], mass);
      slots[i + 1] = {m.x, m.y, cross(x_[i], m), mass * dot(x_[i], x_[i])};
    }
    slots = sum_up(slots);
    for (std::size_t r = 0; r < header_.regions; ++r) {
      const float by = region(r).inverse_mass;
      const Vector c = centres_[r];
      Payload& sum = slots[r + 1];
      const Vector velocity = scale({sum[0], sum[1]}, by);
      const float inertia = msub(sum[3], by, dot(c, c));
      const float omega = angular_velocity(msub(sum[2], by, cross(c, velocity)), inertia);
      sum = {madd(omega, c.y, velocity.x), nmsub(omega, c.x, velocity.y), omega, 0};
    }
    slots = sum_down(slots);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Particle p = particle(i);
      const Payload& sum = slots[p.slot];
      const Vector rigid = {nmsub(sum[2], x_[i].y, sum[0]), madd(sum[2], x_[i].x, sum[1])};
      v[i] = {madd(msub(rigid.x, p.share, v[i].x), damping, v[i].x),
              madd(msub(rigid.y, p.share, v[i].y), damping, v[i].y)};
    }
  }

  const std::byte* bytes_;
  const spu::MatchPlanHeader2d header_;

 public:
  std::vector<Vector> directions;  ///< of each region

 private:
  std::vector<Vector> x_, centres_;
};

}  // namespace softcell::test
