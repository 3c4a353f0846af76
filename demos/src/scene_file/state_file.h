#pragma once
// The file beside a saved scene: positions and velocities of what moves in it. docs/reference/scenes.md describes it.

#include <cstddef>
#include <string>
#include <string_view>

#include "scene/beginning.h"

namespace softcell::demos {

/// Longer files are not read: more than a scene's particles take.
inline constexpr std::size_t kMaxStateBytes = std::size_t{64} << 20;

/// Soft bodies, rigid bodies and ended attachments of a moment; what else it has is in the scene file.
/// @throws std::runtime_error  a body is farther away or faster than a scene may say; one sentence.
template <int Dimension>
std::string state_to_text(const Beginning<Dimension>& moment);

/// Reads that. All numbers are finite and in range; whether they fit a scene, the caller finds out.
/// @throws std::runtime_error  one sentence: the line, what is wrong there, and what is expected.
template <int Dimension>
Beginning<Dimension> parse_state(std::string_view text);

/// Of all lines before the last, which carries it.
std::uint64_t state_checksum(std::string_view lines);

}  // namespace softcell::demos
