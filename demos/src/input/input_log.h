#pragma once
// The events of a run: reads them from a recording in a replay, and writes them to one.

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "recording.h"
#include "scene/scene.h"
#include "scene/scene_hash.h"
#include "softcell/base/assert.h"
#include "softcell/base/whole_file.h"

namespace softcell::demos {

struct RecordingFiles {
  std::optional<std::filesystem::path> record;  ///< where to write what happens
  std::optional<std::filesystem::path> replay;  ///< a recording to replay, in place of the scene's script
};

/// One thread uses it. Call in this order: the constructor, begin(), events_at() and record() for each frame,
/// save(), check().
template <int Dimension>
class InputLog {
 public:
  using Event = InputEvent<Dimension>;

  /// Reads the recording that is to be replayed. @throws std::runtime_error  as read_recording().
  explicit InputLog(const RecordingFiles& files) : path_(files.record) {
    if (files.replay) {
      replay_ = read_recording<Dimension>(*files.replay);
      replay_name_ = files.replay->string();
    }
  }

  /// The name of the recorded scene; none: this is no replay.
  std::optional<std::string> scene_name() const {
    return replay_ ? std::optional(replay_->scene) : std::nullopt;
  }

  /// In a replay, removes the scene's script, because its events are in the recording. Opens the file of a new recording now, so that a
  /// file that cannot be written ends the run at its beginning.
  /// @param contacts  how bodies touch in this run; none: as the scene says
  /// @throws std::runtime_error  the replay is of another scene or of other contacts, or the file cannot be written.
  template <class SceneOfDimension>
  void begin(SceneOfDimension& scene, std::optional<ppu::ContactMethod> contacts = std::nullopt) {
    SC_ASSERT(record_.frames == 0 && !file_, "a log begins scene '{}' after {} frames", scene.name,
              record_.frames);
    record_.scene = recordable_name(scene.name);
    const ppu::ContactMethod method = contacts.value_or(scene.contacts);
    record_.scene_hash = scene_hash(scene, method);
    if (replay_) {
      if (replay_->scene_hash != record_.scene_hash) {
        for (const ppu::ContactMethod other : {ppu::ContactMethod::kSpheres, ppu::ContactMethod::kSurface})
          if (replay_->scene_hash == scene_hash(scene, other)) refuse_contacts(other, method);
        refuse_scene();
      }
      scene.script = {};
    }
    if (path_) file_ = std::make_shared<base::WholeFile>(*path_);
  }

  bool replays() const { return replay_.has_value(); }
  bool records() const { return path_.has_value(); }
  /// Frames of the recording. @pre replays()
  std::int64_t frames() const {
    SC_ASSERT(replay_, "frames() of a run in scene '{}', which is no replay", record_.scene);
    return replay_->frames;
  }

  /// The recorded events of a frame; none if this is no replay. Ask for the frames in order. Valid until the next call.
  std::span<const Event> events_at(std::int64_t frame) {
    events_.clear();
    if (!replay_) return events_;
    SC_ASSERT(next_ == replay_->events.size() || replay_->events[next_].frame >= frame,
              "frame {} is asked for, and event {} of frame {} was not", frame, next_,
              replay_->events[next_].frame);
    const auto& recorded = replay_->events;
    for (; next_ < recorded.size() && recorded[next_].frame == frame; ++next_)
      events_.push_back(recorded[next_].event);
    return events_;
  }

  /// Records the events at the beginning of a frame. If the recording has no room for them, drops all of it: see require_room().
  void record(std::int64_t frame, std::span<const Event> events) {
    SC_ASSERT(frame >= record_.frames, "frame {} behind {} frames", frame, record_.frames);
    record_.frames = frame + 1;
    if (!file_) return;
    if (frame >= kMaxRecordedFrames || record_.events.size() + events.size() > kMaxRecordedEvents) {
      file_.reset();
      return;
    }
    for (const Event& event : events) record_.events.push_back({frame, event});
  }

  /// @throws std::runtime_error  record() has dropped the recording.
  void require_room() const {
    if (!path_ || file_) return;
    throw std::runtime_error(path_->string() + ": a recording has at most " +
                             std::to_string(kMaxRecordedFrames) + " frames and " +
                             std::to_string(kMaxRecordedEvents) + " events; nothing is recorded");
  }

  /// Writes the recording once, if one is asked for. @throws std::runtime_error  it cannot be written.
  void save(std::uint64_t state_hash) {
    record_.state_hash = state_hash;
    if (!file_) return;
    file_->write(to_text(record_));
    file_->commit();
  }

  /// @throws std::runtime_error  the replay has reached the end of the recording, but in another state.
  void check() const {
    if (!replay_ || record_.frames != replay_->frames || record_.state_hash == replay_->state_hash) return;
    throw std::runtime_error(
        replay_name_ +
        ": the replay ends in another state than the recording; the state depends on --engine, on what the "
        "kernels "
        "of this softcell compute and how they round, and on the last bits of Bullet and Box2D on the "
        "machine "
        "and its C library");
  }

 private:
  [[noreturn]] void refuse_contacts(ppu::ContactMethod recorded, ppu::ContactMethod here) const {
    const auto name = [](ppu::ContactMethod method) {
      return std::string(kContactMethods.at(static_cast<std::size_t>(method)));
    };
    throw std::runtime_error(replay_name_ + ": a recording in which bodies touch with --contacts " +
                             name(recorded) + ", and here they touch with " + name(here) +
                             "; give --contacts " + name(recorded));
  }
  [[noreturn]] void refuse_scene() const {
    throw std::runtime_error(replay_name_ + ": a recording of " +
                             (replay_->scene == record_.scene
                                  ? "another version of the scene " + record_.scene
                                  : "the scene " + replay_->scene + ", and this is " + record_.scene) +
                             "; give the one that was recorded with --scene" +
                             (Dimension == 3 ? ", and the --mesh and the cells that it had" : ""));
  }

  std::optional<std::filesystem::path> path_;  // of the new recording
  // All copies share it, and one of them saves. Null: the recording was dropped, or none is asked for.
  std::shared_ptr<base::WholeFile> file_;
  std::optional<Recording<Dimension>> replay_;
  std::string replay_name_;
  std::size_t next_ = 0;  // the next event of the replay
  std::vector<Event> events_;
  Recording<Dimension> record_;
};

}  // namespace softcell::demos
