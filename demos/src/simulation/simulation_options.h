#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "scene/frame_time.h"
#include "softcell/dma/addresses.h"
#include "softcell/dma/schedule.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/ls_sim/trace.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/spu_kernels/load_kernel.h"

namespace softcell::demos {

/// Who does shape matching and damping.
enum class Solver {
  kSpe,       ///< the kernels, on the SPEs
  kReference  ///< the PPU, with Eigen
};

/// Who makes mesh vertices from particles, in three dimensions.
enum class Skin {
  kSpe,  ///< the kernel `skin`, on the SPEs
  kGpu   ///< the renderer, from the particles
};

/// The factor on the time limit of an interpreted job.
inline constexpr int kInterpretedDeadline = 30;

/// How a scene is simulated. The result depends on the contact method and, by rounding, on the solver.
struct SimulationOptions {
  Solver solver = Solver::kSpe;
  /// What the SPEs execute: kernels built for the host or, interpreted, kernels built for the SPU. Both give the same bits.
  ls_sim::Machine machine = ls_sim::Machine::kHost;
  Skin skin = Skin::kSpe;
  std::optional<ppu::ContactMethod> contacts = {};  ///< none: the scene's
  int spes = dma::kSpeCount;
  dma::Schedule schedule{};
  ls_sim::Findings* findings = nullptr;  ///< where checked kernels report; null: kernels are not checked
  ls_sim::Trace* trace = nullptr;        ///< for at least as many SPEs; null: nothing is recorded
  /// Counts what the work would take on a PS3, for at least as many SPEs and for kernels built for the SPU. The SPEs then take turns. Null:
  /// nothing is timed.
  ls_sim::Timing* timing = nullptr;

  ls_sim::SpeOptions spe_options() const {
    ls_sim::SpeOptions options{.spes = spes, .schedule = schedule, .findings = findings, .trace = trace};
    ls_sim::time_by(timing, options);
    if (machine == ls_sim::Machine::kSpu) options.deadline *= kInterpretedDeadline;
    return options;
  }
  ls_sim::KernelImage kernel(std::string_view name) const {
    return spu_kernels::load_kernel(name, findings != nullptr, machine);
  }
  ls_sim::KernelImage job_loop() const { return spu_kernels::load_kernel("job_loop", false, machine); }
};

/// Milliseconds of one frame, measured on the PPU thread.
struct FrameTimes {
  double physics_ms = 0;      ///< in Bullet or Box2D
  double ppu_ms = 0;          ///< in softcell, processor time of the thread: the sum of the next five
  double gather_ms = 0;       ///< copying particles from the engine
  double solve_ms = 0;        ///< handing work to the solver and taking it back, or doing it
  double apply_ms = 0;        ///< copying the new velocities to the engine
  double contacts_ms = 0;     ///< of surfaces; contacts of spheres are Bullet's
  double skin_ms = 0;         ///< handing over the skinning jobs
  double solver_wait_ms = 0;  ///< wall-clock time until the solver has finished; not included above
  /// Waiting for the SPEs, so that pictures are the same on every host; not included above.
  double skin_wait_ms = 0;
  /// On a PS3, by the clocks of the SPEs: from the frame's first job to its last, without the PPU's time. 0: nothing is timed.
  double ps3_ms = 0;
};

/// Measures FrameTimes::ps3_ms.
class FrameOnPs3 {
 public:
  /// @param timing  null: the time is 0 ms
  explicit FrameOnPs3(const ls_sim::Timing* timing) : timing_(timing), begin_(now()) {}
  double milliseconds() const {
    return static_cast<double>(now() - begin_) * 1e3 / static_cast<double>(ls_sim::kCyclesPerSecond);
  }

 private:
  std::uint64_t now() const { return timing_ == nullptr ? 0 : timing_->now(); }
  const ls_sim::Timing* timing_;
  std::uint64_t begin_;
};

}  // namespace softcell::demos
