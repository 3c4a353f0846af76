#pragma once
// The widths of the numbers in the contracts of contact_find and contact_solve, and buffers that know them.

#include <cstddef>

#include "contact_find_job.h"
#include "contact_solve_job.h"
#include "ppu/spe_bodies/job_records.h"
#include "softcell/dma/buffer.h"

namespace softcell::ppu {

/// Of a structure of the contracts.
template <typename T>
struct ContactRecord;
template <>
struct ContactRecord<spu::FindCell> {
  static constexpr dma::ElementRun kRuns[] = {{32, 2}, {128, 4}};
};
template <>
struct ContactRecord<spu::FindGroup> {
  static constexpr dma::ElementRun kRuns[] = {{64, 4}};
};
template <>
struct ContactRecord<spu::FindEnd> {
  static constexpr dma::ElementRun kRuns[] = {{16, 4}};
};
template <>
struct ContactRecord<spu::FindTask> {
  static constexpr dma::ElementRun kRuns[] = {{24, 8}, {40, 4}, {24, 8}, {40, 4}, {16, 8}, {112, 4}};
};
template <>
struct ContactRecord<spu::FindCandidate> {
  static constexpr dma::ElementRun kRuns[] = {{8, 2}};
};
template <>
struct ContactRecord<spu::FindResult> {
  static constexpr dma::ElementRun kRuns[] = {{16, 4}};
};
template <>
struct ContactRecord<spu::FindJob> {
  static constexpr dma::ElementRun kRuns[] = {{16, 8}, {112, 4}};
};
template <>
struct ContactRecord<spu::SolveVelocity> {
  static constexpr dma::ElementRun kRuns[] = {{16, 4}};
};
template <>
struct ContactRecord<spu::SolveContact> {
  static constexpr dma::ElementRun kRuns[] = {{16, 2}, {32, 4}, {16, 2}, {32, 4}, {76, 4}, {4, 2}};
};
template <>
struct ContactRecord<spu::SolveCell> {
  static constexpr dma::ElementRun kRuns[] = {{16, 2}};
};
template <>
struct ContactRecord<spu::SolveRigid> {
  static constexpr dma::ElementRun kRuns[] = {{80, 4}};
};
template <>
struct ContactRecord<spu::SolveTask> {
  static constexpr dma::ElementRun kRuns[] = {{56, 8}, {72, 4}};
};
template <>
struct ContactRecord<spu::SolveJob> {
  static constexpr dma::ElementRun kRuns[] = {{8, 8}, {120, 4}};
};

/// A buffer that SPEs of either byte order read rightly.
template <typename T>
dma::Buffer<T> contact_buffer(dma::AddressSpace& memory, const char* name, std::size_t count,
                              const dma::BufferOptions& options = {}) {
  static_assert(covers<T>(ContactRecord<T>::kRuns));
  return dma::Buffer<T>(memory, name, count, of_record(ContactRecord<T>::kRuns, options));
}

}  // namespace softcell::ppu
