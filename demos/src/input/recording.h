#pragma once
// A record of what happened to a scene, frame by frame: --record writes it, --replay does it again. docs/guide/playing.md describes the
// file.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "input_event.h"

namespace softcell::demos {

/// Longer recordings are neither written nor read.
inline constexpr std::int64_t kMaxRecordedFrames = 10'000'000;  // 46 hours
inline constexpr std::size_t kMaxRecordedEvents = 2'000'000;

template <int Dimension>
struct RecordedEvent {
  std::int64_t frame = 0;  ///< counted from 0; the event happens at its beginning
  InputEvent<Dimension> event;

  bool operator==(const RecordedEvent&) const = default;
};

/// Dimension: 2 or 3.
template <int Dimension>
struct Recording {
  std::string scene;             ///< a recordable_name()
  std::uint64_t scene_hash = 0;  ///< see scene_hash.h
  std::int64_t frames = 0;       ///< simulated frames, pauses included
  std::uint64_t state_hash = 0;  ///< after the last frame
  /// Sorted by frame, each below `frames`; within a frame in the order in which they happened.
  std::vector<RecordedEvent<Dimension>> events = {};

  bool operator==(const Recording&) const = default;
};

template <int Dimension>
std::string to_text(const Recording<Dimension>& recording);

/// @throws std::runtime_error  one sentence: the line, what is wrong there, and what is expected.
template <int Dimension>
Recording<Dimension> parse_recording(std::string_view text);

/// The form in which recordings have a scene's name: without control characters, at most 255 bytes.
std::string recordable_name(std::string_view name);

/// The checksum of all lines before the last, which contains it.
std::uint64_t recording_checksum(std::string_view lines);

/// The file appears only when it is complete. @throws std::runtime_error  it cannot be written; the message names it.
template <int Dimension>
void write_recording(const std::filesystem::path& path, const Recording<Dimension>& recording);

/// @throws std::runtime_error  as parse_recording(), or it cannot be read; the message names the file.
template <int Dimension>
Recording<Dimension> read_recording(const std::filesystem::path& path);

}  // namespace softcell::demos
