#pragma once

#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "demo.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::demos {

/// The measurements of a run.
struct RunRecord {
  /// One number per frame.
  std::vector<double> physics_ms, ppu_ms, gather_ms, solve_ms, apply_ms, contacts_ms, skin_ms, solver_wait_ms,
      skin_wait_ms, ps3_ms;
  std::vector<double> picture_ms;  ///< of each picture
  std::uint64_t upload_bytes = 0;  ///< of vertices or particles, for all pictures
  double seconds = 0;              ///< of the frame loop, pictures included
  int frames = 0;
  std::optional<int> asked_frames;  ///< none: the user decides when the run ends
  std::uint64_t image_hash = 0;     ///< of the last picture; 0 in a window, whose pictures are not read back
  bool interrupted = false;

  void add(const FrameTimes& times) {
    SC_ASSERT(physics_ms.size() == static_cast<std::size_t>(frames), "the times of {} frames of {}",
              physics_ms.size(), frames);
    physics_ms.push_back(times.physics_ms);
    ppu_ms.push_back(times.ppu_ms);
    gather_ms.push_back(times.gather_ms);
    solve_ms.push_back(times.solve_ms);
    apply_ms.push_back(times.apply_ms);
    contacts_ms.push_back(times.contacts_ms);
    skin_ms.push_back(times.skin_ms);
    solver_wait_ms.push_back(times.solver_wait_ms);
    skin_wait_ms.push_back(times.skin_wait_ms);
    ps3_ms.push_back(times.ps3_ms);
    ++frames;
  }

  /// The share of the PPU's time that softcell uses at 60 frames a second.
  double ppu_share() const { return frames == 0 ? 0 : sum(ppu_ms) / frames * 60 / 1000; }

  std::uint64_t upload_bytes_of_a_picture() const {
    return picture_ms.empty() ? 0 : upload_bytes / picture_ms.size();
  }

  /// Frames a second without pictures.
  double simulated_fps() const {
    const double total = sum(physics_ms) + sum(ppu_ms) + sum(solver_wait_ms) + sum(skin_wait_ms);
    return total > 0 ? 1000.0 * frames / total : 0;
  }

 private:
  static double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }
};

/// A run, and the demo at its end.
struct Run {
  std::unique_ptr<Demo> demo;
  RunRecord record;
};

/// Calls `work`, then saves the recording of its frames. If `work` throws, the recording is saved as well, with the frame that failed, so
/// that the failure can be replayed; a failure to save is then only printed, and the exception of `work` is passed on.
inline void run_recorded(Demo& demo, const std::function<void()>& work) {
  SC_ASSERT(static_cast<bool>(work), "a run of scene '{}' without work", demo.scene_name());
  try {
    work();
  } catch (...) {
    try {
      demo.save_recording();
    } catch (const std::exception& error) {
      std::fprintf(stderr, "softcell: %s\n", base::one_line(error.what()).c_str());
    }
    throw;
  }
  demo.save_recording();
}

}  // namespace softcell::demos
