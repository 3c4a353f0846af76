#pragma once
// A frame of a demo is 1/60 s of simulated time, in substeps of equal length.

namespace softcell::demos {

inline constexpr float kFrameSeconds = 1.0f / 60;
/// The most substeps of a frame: in a scene file, in a recording and on the slider of the menu.
inline constexpr int kMaxSubsteps = 64;

}  // namespace softcell::demos
