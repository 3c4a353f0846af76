#pragma once
// The widths of the numbers in the job contracts of contact_find, contact_solve and attach, and buffers with such numbers.

#include <cstddef>

#include "attach_job.h"
#include "contact_find_job.h"
#include "contact_solve_job.h"
#include "ppu/spe_bodies/job_records.h"
#include "softcell/dma/buffer.h"

namespace softcell::ppu {

/// The widths in a structure of the contracts.
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
  static constexpr dma::ElementRun kRuns[] = {{24, 8}, {40, 4}, {24, 8}, {40, 4}, {8, 8}, {120, 4}};
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
  static constexpr dma::ElementRun kRuns[] = {{24, 8}, {104, 4}};
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
  static constexpr dma::ElementRun kRuns[] = {{224, 4}};
};
template <>
struct ContactRecord<spu::SolveTask> {
  static constexpr dma::ElementRun kRuns[] = {{56, 8}, {72, 4}};
};
template <>
struct ContactRecord<spu::SolveJob> {
  static constexpr dma::ElementRun kRuns[] = {{8, 8}, {120, 4}};
};

template <>
struct ContactRecord<spu::AttachRun> {
  static constexpr dma::ElementRun kRuns[] = {{8, 8}, {8, 4}};
};
template <>
struct ContactRecord<spu::AttachRigid> {
  static constexpr dma::ElementRun kRuns[] = {{8, 8}, {8, 4}};
};
template <>
struct ContactRecord<spu::AttachLink> {
  static constexpr dma::ElementRun kRuns[] = {{256, 4}};
};
template <>
struct ContactRecord<spu::AttachPoint> {
  static constexpr dma::ElementRun kRuns[] = {{96, 4}};
};
template <>
struct ContactRecord<spu::AttachRow> {
  static constexpr dma::ElementRun kRuns[] = {{128, 4}};
};
template <>
struct ContactRecord<spu::AttachEntry> {
  static constexpr dma::ElementRun kRuns[] = {{48, 4}};
};
template <>
struct ContactRecord<spu::AttachJob> {
  static constexpr dma::ElementRun kRuns[] = {{48, 8}, {80, 4}};
};

/// A buffer that SPEs of either byte order read correctly.
template <typename T>
dma::Buffer<T> contact_buffer(dma::AddressSpace& memory, const char* name, std::size_t count,
                              const dma::BufferOptions& options = {}) {
  static_assert(covers<T>(ContactRecord<T>::kRuns));
  return dma::Buffer<T>(memory, name, count, of_record(ContactRecord<T>::kRuns, options));
}

/// Sets one of four boxes.
template <typename Vector>
void set_box(spu::FindBoxes& four, std::size_t lane, const Vector& low, const Vector& high) {
  four.low_x[lane] = low[0], four.low_y[lane] = low[1], four.low_z[lane] = low[2];
  four.high_x[lane] = high[0], four.high_y[lane] = high[1], four.high_z[lane] = high[2];
}

/// Makes room for at least `count` elements; the buffer's content is lost.
template <typename T>
void make_room(dma::AddressSpace& memory, const char* name, dma::Buffer<T>& buffer, std::size_t count) {
  if (count <= buffer.size()) return;
  buffer = {};
  buffer = contact_buffer<T>(memory, name, count + count / 4);
}

}  // namespace softcell::ppu
