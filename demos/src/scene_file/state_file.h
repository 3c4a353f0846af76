#pragma once
// The file beside a saved scene: positions and velocities of everything that moves in it. docs/reference/scenes.md describes it.

#include <cstddef>
#include <string>
#include <string_view>

#include "scene/beginning.h"

namespace softcell::demos {

/// Longer files are not read: this is more than the particles of any scene need.
inline constexpr std::size_t kMaxStateBytes = std::size_t{64} << 20;

/// Writes the soft bodies, rigid bodies and ended attachments of a moment; the rest of the moment is in the scene file.
/// @throws std::runtime_error  a body is farther away or faster than a scene file may state; one sentence.
template <int Dimension>
std::string state_to_text(const Beginning<Dimension>& moment);

/// Reads such a text. All numbers are finite and in range; the caller checks whether they fit the scene.
/// @throws std::runtime_error  one sentence: the line, what is wrong there, and what is expected.
template <int Dimension>
Beginning<Dimension> parse_state(std::string_view text);

/// The checksum of all lines before the last, which contains it.
std::uint64_t state_checksum(std::string_view lines);

}  // namespace softcell::demos
