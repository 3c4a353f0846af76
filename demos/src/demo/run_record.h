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
#include "softcell/base/text.h"

namespace softcell::demos {

/// What a run measured.
struct RunRecord {
  std::vector<double> physics_ms, ppu_ms, gather_ms, solve_ms, apply_ms, skin_ms, solver_wait_ms,
      skin_wait_ms;                ///< of each frame
  std::vector<double> picture_ms;  ///< of each picture
  std::uint64_t upload_bytes = 0;  ///< of vertices or particles, for all pictures
  double seconds = 0;              ///< of the frame loop, pictures included
  int frames = 0;
  std::optional<int> asked_frames;  ///< nothing when the user says when the run ends
  std::uint64_t image_hash = 0;     ///< of the last picture; a window's are not read back
  bool interrupted = false;

  void add(const FrameTimes& times) {
    physics_ms.push_back(times.physics_ms);
    ppu_ms.push_back(times.ppu_ms);
    gather_ms.push_back(times.gather_ms);
    solve_ms.push_back(times.solve_ms);
    apply_ms.push_back(times.apply_ms);
    skin_ms.push_back(times.skin_ms);
    solver_wait_ms.push_back(times.solver_wait_ms);
    skin_wait_ms.push_back(times.skin_wait_ms);
    ++frames;
  }

  /// What softcell takes of the PPU's time in a frame of 1/60 s.
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

/// Does the work and saves the recording of its frames, also when it fails, a frame that failed included:
/// that is the run that one wants to see again. What goes wrong with saving is only printed then: the work's
/// error is what ends the run.
inline void run_recorded(Demo& demo, const std::function<void()>& work) {
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
