#pragma once
// The benchmarks of `softcell bench`. One function for each group adds the group's cases; it builds nothing yet, because only what is
// measured is built.

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::tool {

/// A piece of work to be timed: `run` does `items` items of it.
struct Work {
  std::size_t items = 0;
  std::function<void()> run;
  /// The time that counts, as a total up to now; null: the clock's time.
  std::function<std::chrono::nanoseconds()> spent = {};
  std::function<std::string()> note = {};  ///< another result to report, computed after all measurements
  std::function<void()> before = {};       ///< called right before each run, not timed; null: nothing
};

/// One thing to measure.
struct Benchmark {
  std::string name;
  std::function<Work()> prepare;  ///< builds what the work needs; called once
};

/// A rig that several benchmarks share; it is made when the first of them is prepared.
template <typename Rig>
class Shared {
 public:
  explicit Shared(std::function<std::shared_ptr<Rig>()> make)
      : state_(std::make_shared<State>(State{std::move(make), nullptr})) {}

  const std::shared_ptr<Rig>& get() const {
    SC_ASSERT(state_->rig || state_->make, "the rig of {} benchmarks has no function that makes it",
              state_.use_count());
    if (!state_->rig) state_->rig = state_->make();
    return state_->rig;
  }

 private:
  struct State {
    std::function<std::shared_ptr<Rig>()> make;
    std::shared_ptr<Rig> rig;
  };
  std::shared_ptr<State> state_;
};

/// skin/<body>/<spe|scalar>: an item is a vertex.
void add_skin_benchmarks(std::vector<Benchmark>& all);

/// solver3d/<body>/w<n>/<spe|eigen|ppu|naive>: an item is a particle. `eigen` is the way one writes it with Eigen, `ppu` the PPU's solver,
/// `naive` that solver without shared sums. solver3d/one1000/w2/spe: a single body of 1000 particles, handed over and waited for.
void add_solver_benchmarks(std::vector<Benchmark>& all);

/// solver3d/<body>/w<n>/bullet-<pose|links>: a btSoftBody with a node for each of the body's particles, held either as one region by shape
/// matching or by links; the same for every half-width. An item is a node.
void add_bullet_benchmarks(std::vector<Benchmark>& all);

/// solver2d/<body>/w<n>/<spe|eigen|ppu|naive>: likewise.
void add_solver_2d_benchmarks(std::vector<Benchmark>& all);

/// rotation/<random|converged>/<spe|ppu>: an item is one region's matrix. `random`: any matrix, from random quaternions, with as many
/// iterations as it takes. `converged`: a turn of 0.01 rad, as in a step, with two iterations.
void add_rotation_benchmarks(std::vector<Benchmark>& all);

/// solver3d/<big|bigcube>/w2/spe: over 200,000 particles in tiles; an item is a particle. `big` is a mattress, whose shape suits tiles;
/// `bigcube` has a shape that does not.
void add_tiles_benchmarks(std::vector<Benchmark>& all);

/// dma/<get|put>16k and dma/memcpy16k: an item is 16 KB. dma/command/<schedule>: an item is one get of 16
/// bytes, waits included.
void add_dma_benchmarks(std::vector<Benchmark>& all);

/// dispatch/queued: an item is one of many empty jobs in one stage; dispatch/round_trip: an item is an empty job that is kicked and waited
/// for while its SPE sleeps, or while all six sleep.
void add_dispatch_benchmarks(std::vector<Benchmark>& all);

/// interpreter/mix: an item is one instruction of a program built for the SPU, run by the interpreter: integers, single
/// precision, shuffles, loads and stores, branches.
void add_interpreter_benchmarks(std::vector<Benchmark>& all);

/// frame/<scene>: a whole frame of 1/60 s without its picture, in wall-clock time. Of the same frames, .../ppu: the processor time that the
/// PPU spends on soft bodies, without the engine. .../solver: one step of shape matching and damping of the scene's bodies on one SPE,
/// nothing else. .../spheres: frames of the same scene with a loose Bullet sphere for each particle that Bullet handles, with no shape
/// matching and no skinning.
void add_frame_benchmarks(std::vector<Benchmark>& all);

/// contact/<fall|rest|pile|self|mesh|coarse_mesh>/<ours|spheres|btsoftbody>: frames in which bodies touch, in processor time of all
/// threads; an item is a particle in one frame. `ours`: contacts of what is drawn; `spheres`: a rigid sphere at each outer particle;
/// `btsoftbody`: Bullet's own soft bodies with a node for each particle, whose clusters touch. `mesh`: 1,000 static triangles near a body;
/// `coarse_mesh`: ten.
void add_contact_benchmarks(std::vector<Benchmark>& all);

/// frame/<scene> and .../ppu, as above; .../circles: like spheres, with circles in Box2D.
void add_frame_2d_benchmarks(std::vector<Benchmark>& all);

}  // namespace softcell::tool
