#pragma once
// The widths of the numbers in the kernels' job contracts, for SPEs that run programs built for the SPU.

#include <span>

#include "match_2d_job.h"
#include "match_job.h"
#include "match_tiles_job.h"
#include "skin_job.h"
#include "softcell/dma/address_space.h"
#include "strain_job.h"

namespace softcell::ppu {

/// Whether the runs add up to the size of one T.
template <typename T, std::size_t kRuns>
constexpr bool covers(const dma::ElementRun (&record)[kRuns]) {
  std::size_t bytes = 0;
  for (const dma::ElementRun& run : record) bytes += run.bytes;
  return bytes == sizeof(T);
}

inline constexpr dma::ElementRun kMatchBodyRecord[] = {{16, 8}};
static_assert(covers<spu::MatchBody>(kMatchBodyRecord));

inline constexpr dma::ElementRun kMatchJobRecord[] = {{16, 8}, {112, 4}};
static_assert(covers<spu::MatchJob>(kMatchJobRecord));

inline constexpr dma::ElementRun kMatchJob2dRecord[] = {{24, 8}, {104, 4}};
static_assert(covers<spu::MatchJob2d>(kMatchJob2dRecord));

inline constexpr dma::ElementRun kTiledBodyRecord[] = {{96, 8}, {160, 4}};
static_assert(covers<spu::TiledBody>(kTiledBodyRecord));

inline constexpr dma::ElementRun kTileJobRecord[] = {{16, 8}, {112, 4}};
static_assert(covers<spu::TileJob>(kTileJobRecord));

inline constexpr dma::ElementRun kSkinGroupRecord[] = {{96, 4}, {32, 2}};
static_assert(covers<spu::SkinGroup>(kSkinGroupRecord));

inline constexpr dma::ElementRun kSkinJobRecord[] = {{16, 8}, {8, 8}, {8, 4}, {8, 8}, {8, 4}, {80, 4}};
static_assert(covers<spu::SkinJob>(kSkinJobRecord));

inline constexpr dma::ElementRun kStrainLengthsRecord[] = {{16, 2}, {16, 4}};
static_assert(covers<spu::StrainLengths>(kStrainLengthsRecord));

inline constexpr dma::ElementRun kStrainFacesRecord[] = {{96, 2}, {16, 4}};
static_assert(covers<spu::StrainFaces>(kStrainFacesRecord));

inline constexpr dma::ElementRun kStrainResultRecord[] = {{16, 4}};
static_assert(covers<spu::StrainResult>(kStrainResultRecord));

inline constexpr dma::ElementRun kStrainJobRecord[] = {{32, 8}, {96, 4}};
static_assert(covers<spu::StrainJob>(kStrainJobRecord));

/// The options of a buffer of structures with this record.
inline dma::BufferOptions of_record(std::span<const dma::ElementRun> record,
                                    dma::BufferOptions options = {}) {
  options.record = record;
  return options;
}

}  // namespace softcell::ppu
