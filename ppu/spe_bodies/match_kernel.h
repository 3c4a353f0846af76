#pragma once
// Gives the kernels that step a whole body, `match_2d` in two dimensions and `match` in three, one set of names for MatchBodies.

#include <algorithm>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "match_2d_job.h"
#include "match_job.h"
#include "ppu/plans/match_constants.h"
#include "ppu/plans/match_plan.h"
#include "ppu/plans/match_plan_2d.h"
#include "ppu/spe_bodies/job_records.h"
#include "skin_job.h"

namespace softcell::ppu {

template <int kDimension>
struct MatchKernel;

template <>
struct MatchKernel<2> {
  static constexpr const char* kName = "match_2d";
  static constexpr std::span<const dma::ElementRun> kJobRecord = kMatchJob2dRecord;
  using Plan = MatchPlan2d;
  using Header = spu::MatchPlanHeader2d;
  using Vector = spu::MatchVector2d;
  using Rotations = spu::MatchDirections;   // of four regions
  using Particles = spu::MatchParticles2d;  // of four particles; regions likewise
  using Regions = spu::MatchRegions2d;
  using Result = spu::MatchResult2d;
  using Job = spu::MatchJob2d;

  static constexpr Rotations kUnturned{{1, 1, 1, 1}, {0, 0, 0, 0}};
  static std::uint32_t positions_stride(const Header& plan) { return spu::match_2d_positions_stride(plan); }
  static std::uint32_t state_stride(const Header& plan) { return spu::match_2d_state_stride(plan); }
  static std::uint32_t rotations_at(const Header& plan) { return spu::match_2d_directions_at(plan); }
  static Vector written(const Eigen::Vector2f& v) { return {v.x(), v.y()}; }
  static Eigen::Vector2f read(const Vector& v) { return {v.x, v.y}; }
  static void set_rest(Particles& group, std::uint32_t lane,
                       const MatchingPlan<float, 2>::Particle& particle) {
    group.rest_x[lane] = particle.x0.x();
    group.rest_y[lane] = particle.x0.y();
  }
  static void set_rest(Regions& group, std::uint32_t lane, const MatchingPlan<float, 2>::Region& region) {
    group.centre_x[lane] = region.c0.x();
    group.centre_y[lane] = region.c0.y();
  }
};

template <>
struct MatchKernel<3> {
  static constexpr const char* kName = "match";
  static constexpr std::span<const dma::ElementRun> kJobRecord = kMatchJobRecord;
  using Plan = MatchPlan;
  using Header = spu::MatchPlanHeader;
  using Vector = spu::SkinCorner;  // x y z 0
  using Rotations = spu::MatchRotations;
  using Particles = spu::MatchParticles;
  using Regions = spu::MatchRegions;
  using Result = spu::MatchResult;
  using Job = spu::MatchJob;

  static constexpr Rotations kUnturned{{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {1, 1, 1, 1}};
  static std::uint32_t positions_stride(const Header& plan) { return spu::match_positions_stride(plan); }
  static std::uint32_t state_stride(const Header& plan) { return spu::match_state_stride(plan); }
  static std::uint32_t rotations_at(const Header& plan) { return spu::match_rotations_at(plan); }
  static Vector written(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z(), 0}; }
  static Eigen::Vector3f read(const Vector& v) { return {v.x, v.y, v.z}; }
  static void set_rest(Particles& group, std::uint32_t lane,
                       const MatchingPlan<float, 3>::Particle& particle) {
    std::ranges::copy(rest_moment(particle), group.rest_moment[lane]);
  }
  static void set_rest(Regions& group, std::uint32_t lane, const MatchingPlan<float, 3>::Region& region) {
    set_centre(group, lane, region);
  }
};

}  // namespace softcell::ppu
