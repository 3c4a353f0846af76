#pragma once
// Where the events of a run come from when it is a replay, and where they go when it is recorded.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "recording.h"
#include "scene/scene_hash.h"
#include "softcell/base/whole_file.h"

namespace softcell::demos {

struct RecordingFiles {
  std::optional<std::filesystem::path> record;  ///< where to write what happens
  std::optional<std::filesystem::path> replay;  ///< a recording to do again, in place of the scene's script
};

/// Used by one thread. Call in this order: the constructor, begin(), events_at() and note() for each frame,
/// save(), check().
template <int Dimension>
class InputLog {
 public:
  using Event = InputEvent<Dimension>;

  /// Reads the recording that is to be done again. @throws std::runtime_error  as read_recording().
  explicit InputLog(const RecordingFiles& files) : path_(files.record) {
    if (files.replay) {
      replay_ = read_recording<Dimension>(*files.replay);
      replay_name_ = files.replay->string();
    }
  }

  /// Of the scene that was recorded; none: this is no replay.
  std::optional<std::string> scene_name() const {
    return replay_ ? std::optional(replay_->scene) : std::nullopt;
  }

  /// Takes the scene's script away when this is a replay: its events are in the recording. Opens the file of
  /// what is recorded, so that one that cannot be written is no surprise at the end of a long run.
  /// @throws std::runtime_error  the replay is of another scene, or the file cannot be written.
  template <class SceneOfDimension>
  void begin(SceneOfDimension& scene) {
    record_.scene = recordable_name(scene.name);
    record_.scene_hash = scene_hash(scene);
    if (replay_) {
      if (replay_->scene_hash != record_.scene_hash) refuse_scene();
      scene.script = {};
    }
    if (path_) file_ = std::make_shared<base::WholeFile>(*path_);
  }

  bool replays() const { return replay_.has_value(); }
  /// The recording's. @pre replays()
  std::int64_t frames() const { return replay_->frames; }

  /// What the recording has for the frame; frames are asked for in order. Good until the next call.
  std::span<const Event> events_at(std::int64_t frame) {
    events_.clear();
    if (!replay_) return events_;
    const auto& recorded = replay_->events;
    for (; next_ < recorded.size() && recorded[next_].frame == frame; ++next_)
      events_.push_back(recorded[next_].event);
    return events_;
  }

  /// What happened at the beginning of the frame. A recording without room for it is given up, as nothing
  /// is known of the state before it: require_room().
  void note(std::int64_t frame, std::span<const Event> events) {
    record_.frames = frame + 1;
    if (!file_) return;
    if (frame >= kMaxRecordedFrames || record_.events.size() + events.size() > kMaxRecordedEvents) {
      file_.reset();
      return;
    }
    for (const Event& event : events) record_.events.push_back({frame, event});
  }

  /// @throws std::runtime_error  the recording was given up.
  void require_room() const {
    if (!path_ || file_) return;
    throw std::runtime_error(path_->string() + ": a recording has at most " +
                             std::to_string(kMaxRecordedFrames) + " frames and " +
                             std::to_string(kMaxRecordedEvents) + " events; nothing is recorded");
  }

  /// Writes the recording, if one is asked for; once. @throws std::runtime_error  it cannot be written.
  void save(std::uint64_t state_hash) {
    record_.state_hash = state_hash;
    if (!file_) return;
    file_->write(to_text(record_));
    file_->commit();
  }

  /// @throws std::runtime_error  all of the recording was done again and did not end in its state.
  void check() const {
    if (!replay_ || record_.frames != replay_->frames || record_.state_hash == replay_->state_hash) return;
    throw std::runtime_error(
        replay_name_ +
        ": the replay ends in another state than the recording; it depends on --engine, on what the kernels "
        "of this softcell compute and how they round, and on the last bits of Bullet and Box2D on the "
        "machine "
        "and its C library");
  }

 private:
  [[noreturn]] void refuse_scene() const {
    throw std::runtime_error(replay_name_ + ": a recording of " +
                             (replay_->scene == record_.scene
                                  ? "another version of the scene " + record_.scene
                                  : "the scene " + replay_->scene + ", and this is " + record_.scene) +
                             "; give the one that was recorded with --scene" +
                             (Dimension == 3 ? ", and the --mesh and the cells that it had" : ""));
  }

  std::optional<std::filesystem::path> path_;  // of what is recorded
  std::shared_ptr<base::WholeFile> file_;      // of all copies; one of them saves; null: given up
  std::optional<Recording<Dimension>> replay_;
  std::string replay_name_;
  std::size_t next_ = 0;  // event of the replay
  std::vector<Event> events_;
  Recording<Dimension> record_;
};

}  // namespace softcell::demos
