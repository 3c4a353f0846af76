#pragma once
// What `softcell bench` measures. One function for each group; each adds its cases.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace softcell::demos {

/// One thing to measure: `run` does `items` items of work.
struct Benchmark {
  std::string name;
  std::size_t items = 0;
  std::function<void()> run;
  std::vector<double> nanoseconds = {};  ///< per item, one for each round
};

/// skin/<body>/<spe|scalar>: an item is a vertex.
void add_skin_benchmarks(std::vector<Benchmark>& all);

/// solver3d/<body>/w<n>/<spe|eigen|ppu|naive>: an item is a particle. `eigen` is as one writes it with Eigen,
/// `ppu` the PPU's solver, `naive` that one without shared sums.
void add_solver_benchmarks(std::vector<Benchmark>& all);

/// dma/<get|put>16k and dma/memcpy16k: an item is 16 KB. dma/command/<schedule>: an item is one get of 16
/// bytes, waits included.
void add_dma_benchmarks(std::vector<Benchmark>& all);

/// dispatch/queued: an item is an empty job of many that wait in a row; dispatch/round_trip: one that is
/// submitted and waited for while its SPE sleeps.
void add_dispatch_benchmarks(std::vector<Benchmark>& all);

}  // namespace softcell::demos
