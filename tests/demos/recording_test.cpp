// Recordings: what is written is read back, what is broken is refused, and a replay is the run again.

#include "input/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "input/input_log.h"
#include "random_events.h"
#include "scene/scene_hash.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_2d.h"
#include "simulation/simulation_3d.h"
#include "support/run_command.h"
#include "support/scratch_folder.h"

namespace softcell::demos {
namespace {

using test::random_event;

template <int Dimension>
Recording<Dimension> random_recording(std::uint32_t seed, std::size_t events) {
  std::mt19937 random(seed);
  Recording<Dimension> recording{
      .scene = "a scene", .scene_hash = random(), .frames = 0, .state_hash = random()};
  std::int64_t frame = 0;
  for (std::size_t i = 0; i < events; ++i) {
    frame += random() % 3;
    recording.events.push_back({frame, random_event<Dimension>(random)});
  }
  recording.frames = frame + 10;
  return recording;
}

/// Text of a recording around these lines, its checksum right.
std::string with_lines(const std::string& lines) {
  const std::string text =
      "softcell recording 1\ndimension 2\nscene man\nscene_hash 0123456789abcdef\n" + lines;
  return text + fmt::format("end {:016x}\n", recording_checksum(text));
}

testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' does not say: " << part;
}

std::string refusal(const std::string& text) {
  try {
    parse_recording<2>(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Recording, AThousandRandomEventsAreReadBackAsTheyWere) {
  const auto flat = random_recording<2>(1, 1000);
  const auto solid = random_recording<3>(2, 1000);
  EXPECT_EQ(parse_recording<2>(to_text(flat)), flat);
  EXPECT_EQ(parse_recording<3>(to_text(solid)), solid);
}

TEST(Recording, ExtremeNumbersAreReadBackAsTheyWere) {
  Recording<2> recording{
      .scene = "\xc3\xa4", .scene_hash = ~0ull, .frames = kMaxRecordedFrames, .state_hash = 0};
  using Limits = std::numeric_limits<float>;
  for (const float value :
       {-0.0f, 0.1f, Limits::min(), Limits::denorm_min(), Limits::max(), Limits::lowest()}) {
    recording.events.push_back({kMaxRecordedFrames - 1, {.action = Action::kPush, .value = {value, value}}});
    const Recording<2> again = parse_recording<2>(to_text(recording));
    EXPECT_EQ(std::signbit(again.events.back().event.value.x()), std::signbit(value));
    EXPECT_EQ(again, recording);
  }
}

TEST(Recording, EveryTruncationIsRefused) {
  const std::string text = to_text(random_recording<2>(3, 20));
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_THROW(parse_recording<2>(text.substr(0, size)), std::runtime_error) << size;
  EXPECT_TRUE(contains(refusal(text.substr(0, text.size() / 2)), "it was cut off"));
  EXPECT_TRUE(contains(refusal(text + "x\n"), "something follows the last line"));
}

TEST(Recording, EveryChangedByteIsRefused) {
  const std::string text = to_text(random_recording<2>(4, 20));
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const int bit : {0, 3, 5, 7}) {
      std::string changed = text;
      changed[i] = static_cast<char>(changed[i] ^ (1 << bit));
      EXPECT_THROW(parse_recording<2>(changed), std::runtime_error) << "byte " << i << ", bit " << bit;
    }
  }
}

TEST(Recording, WhatIsWrongIsSaidWithItsLine) {
  const std::string end = "frames 10\nstate_hash 0000000000000000\n";
  EXPECT_EQ(refusal(with_lines("0 reset\n" + end)), "accepted");
  const std::vector<std::pair<std::string, std::string>> cases{
      {with_lines("0 jump\n" + end), "line 5: there is no action 'jump'"},
      {with_lines("0 tilt 0 0\n" + end), "line 5: there is no action 'tilt'"},
      {with_lines("3 reset\n2 pause\n" + end), "line 6: the frame '2' is not a number from 3 to 9999999"},
      {with_lines("-1 reset\n" + end), "line 5: the frame '-1' is not a number from 0 to 9999999"},
      {with_lines("10 reset\n" + end),
       "line 6: the number of frames '10' is not a number from 11 to 10000000"},
      {with_lines("0 gravity 0 nan\n" + end), "line 5: 'nan' is no finite number"},
      {with_lines("0 gravity 0 1e99\n" + end), "line 5: '1e99' is no finite number"},
      {with_lines("0 gravity 0\n" + end), "line 5: a number is missing"},
      {with_lines("0 gravity 0 1 2\n" + end), "line 5: '2' was not expected here"},
      {with_lines("0 release 4294967295\n" + end),
       "line 5: a hand '4294967295' is not a number from 0 to 4294967292"},
      {with_lines("0 home userland\n" + end),
       "line 5: a body 'userland' is not a number from 0 to 4294967294"},
      {with_lines(std::string(1000, '0') + "\n" + end), "line 5: is longer than any line of a recording"},
      {"P6 1 1\n", "line 1: this is not a recording: it does not begin with 'softcell recording'"},
      {"softcell recording 2\n",
       "line 1: a recording of another version, 'softcell recording 2'; this softcell reads 'softcell "
       "recording 1'"},
      {"softcell recording 1\r\ndimension 2\r\n",
       "line 1: the line ends in CR LF, as of Windows; lines of a recording end in LF"},
      {"softcell recording 1\ndimension 3\n", "line 2: this is a recording of demo 3d, and this is demo 2d"},
      {"softcell recording 1\ndimension 4\n", "line 2: the dimension '4' is not a number from 2 to 3"},
      {"softcell recording 1\ndimension 2\nscene \n",
       "line 3: the scene has no name, or one with control characters"},
      {"softcell recording 1\ndimension 2\nscene man\nscene_hash 12\n",
       "line 4: the scene's hash '12' is not a number of 16 hexadecimal digits"},
      {"", "line 1: the file ends here, before its line 'end': it was cut off"},
  };
  for (const auto& [text, sentence] : cases) EXPECT_EQ(refusal(text), sentence);
}

TEST(Recording, AFileThatIsNoneIsRefusedByName) {
  EXPECT_THROW(read_recording<2>("/dev/zero"), std::runtime_error);
  EXPECT_THROW(read_recording<2>("/nowhere/at.all"), std::runtime_error);
  EXPECT_THROW(read_recording<2>("/"), std::runtime_error);
  EXPECT_THROW(write_recording<2>("/nowhere/at.all", {.scene = "s"}), std::runtime_error);
}

// A run and its replay, by way of the file.

/// @param seed  of what the user does in a run that is no replay
template <class Simulation, int Dimension>
std::uint64_t run(Simulation& simulation, InputLog<Dimension>& log, std::int64_t frames, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<InputEvent<Dimension>> events;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    events.clear();
    if (log.replays()) {
      const auto recorded = log.events_at(frame);
      events.assign(recorded.begin(), recorded.end());
    } else {
      for (std::uint32_t i = static_cast<std::uint32_t>(random() % 5); i > 0; --i)
        events.push_back(random_event<Dimension>(random));
    }
    simulation.step(events);
    log.record(frame, simulation.last_events());
  }
  log.save(simulation.state_hash());
  return simulation.state_hash();
}

constexpr const char* kScene2d =
    "dimension = 2\n[framework]\nwidth = 6\nheight = 5\n[[soft_body]]\nname = \"b\"\ncell_size = 0.4\n"
    "rows = [\"###\", \"#.#\"]\n[[drag]]\nbody = \"b\"\nbegin = 0.1\nend = 0.5\nfrom = [0, 0]\nto = [2, 1]\n";

TEST(Replay, OfRandomInputEndsInTheSameState2d) {
  const tests::ScratchFolder scratch;
  RecordingFiles recorded, repeated;
  recorded.record = repeated.replay = scratch.path() / "run.rec";
  repeated.record = scratch.path() / "again.rec";
  Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  Scene2d again = scene;

  InputLog<2> first(recorded);
  first.begin(scene);
  Simulation2d simulation(scene);
  const std::uint64_t state = run(simulation, first, 500, 5);

  InputLog<2> second(repeated);
  EXPECT_EQ(second.scene_name(), "s");
  EXPECT_EQ(second.frames(), 500);
  second.begin(again);
  EXPECT_TRUE(again.script.drags.empty()) << "the script's events are in the recording";
  Simulation2d repeat(again);
  EXPECT_EQ(run(repeat, second, 500, 0), state);
  second.check();

  const auto recording = read_recording<2>(*recorded.record);
  EXPECT_GT(recording.events.size(), 900u);
  EXPECT_EQ(read_recording<2>(*repeated.record), recording) << "a replay can be recorded too";
}

TEST(Replay, EndsInTheSameStateForAnyNumberOfSpesAndSchedule3d) {
  const tests::ScratchFolder scratch;
  RecordingFiles recorded, repeated;
  recorded.record = repeated.replay = scratch.path() / "run.rec";
  const Scene scene = std::get<Scene>(
      parse_scene("[framework]\n[[box]]\nsize = [0.3, 0.3, 0.3]\nmass = 5\nposition = [0.4, 0.6, 0]\n"
                  "[[soft_body]]\nname = \"cube\"\ncell_size = 0.25\nposition = [0, 1.2, 0]\n"
                  "shape = { kind = \"box\", size = [0.5, 0.5, 0.5] }\n",
                  "s.toml"));
  InputLog<3> first(recorded);
  Scene played = scene;
  first.begin(played);
  Simulation3d simulation(played, {});
  const std::uint64_t state = run(simulation, first, 120, 6);
  for (const auto& [spes, schedule] : {std::pair{1, "lazy"}, {3, "random:7"}, {6, "eager"}}) {
    InputLog<3> second(repeated);
    second.begin(played);
    Simulation3d repeat(played, {.spes = spes, .schedule = dma::parse_schedule(schedule)});
    EXPECT_EQ(run(repeat, second, 120, 0), state) << spes << " SPEs, " << schedule;
    second.check();
  }
}

TEST(Replay, OfAnotherSceneIsRefused) {
  const tests::ScratchFolder scratch;
  RecordingFiles recorded, repeated;
  recorded.record = repeated.replay = scratch.path() / "run.rec";
  Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  InputLog<2> log(recorded);
  log.begin(scene);
  log.save(0);
  const auto refusal_of = [&](Scene2d other) -> std::string {
    try {
      InputLog<2>(repeated).begin(other);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  Scene2d other = scene;
  other.camera.height = 1;
  other.script = {};
  other.soft_bodies[0].colour = {0, 0, 0};
  EXPECT_EQ(refusal_of(other), "accepted") << "looks and script are not what a recording depends on";
  other.soft_bodies[0].settings.alpha *= 0.999f;
  EXPECT_TRUE(contains(refusal_of(other), "another version of the scene s"));
  other.name = "t";
  EXPECT_TRUE(contains(refusal_of(other), "a recording of the scene s, and this is t"));
}

TEST(Replay, WithOtherContactsIsRefused) {
  const tests::ScratchFolder scratch;
  RecordingFiles recorded, repeated;
  recorded.record = repeated.replay = scratch.path() / "run.rec";
  Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  ASSERT_EQ(scene.contacts, ppu::ContactMethod::kSurface);
  InputLog<2> log(recorded);
  log.begin(scene, ppu::ContactMethod::kSpheres);
  log.save(0);
  EXPECT_NO_THROW(InputLog<2>(repeated).begin(scene, ppu::ContactMethod::kSpheres));
  for (const std::optional<ppu::ContactMethod> contacts :
       {std::optional<ppu::ContactMethod>(), std::optional(ppu::ContactMethod::kSurface)}) {
    try {
      InputLog<2>(repeated).begin(scene, contacts);
      ADD_FAILURE() << "accepted";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()),
                repeated.replay->string() +
                    ": a recording in which bodies touch with --contacts spheres, and here they touch with "
                    "surface; give --contacts spheres");
    }
  }
  scene.contacts = ppu::ContactMethod::kSpheres;
  EXPECT_NO_THROW(InputLog<2>(repeated).begin(scene)) << "the scene may say so, too";
}

TEST(Replay, ThatEndsInAnotherStateIsSaidSo) {
  const tests::ScratchFolder scratch;
  RecordingFiles options;
  options.replay = scratch.path() / "run.rec";
  Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  write_recording<2>(
      *options.replay,
      {.scene = "s", .scene_hash = scene_hash(scene), .frames = 2, .state_hash = 7, .events = {}});
  InputLog<2> log(options);
  log.begin(scene);
  log.record(0, {});
  log.save(8);
  EXPECT_NO_THROW(log.check()) << "not all of it was done again";
  log.record(1, {});
  log.save(8);
  EXPECT_THROW(log.check(), std::runtime_error);
  log.save(7);
  EXPECT_NO_THROW(log.check());
}

// A particle that is no number ends a run.
TEST(Replay, OfARunThatFailedFailsAgain) {
  const tests::ScratchFolder scratch;
  const std::filesystem::path bad = scratch.path() / "bad.rec", again = scratch.path() / "again.rec";
  const InputEvent<3> push{.action = Action::kPush, .body = kEveryBody, .value = {3e38f, 0, 0}};
  const Recording<3> recording{.scene = "drop",
                               .scene_hash = scene_hash(load_scene_3d("drop")),
                               .frames = 9,
                               .state_hash = 0,
                               .events = {{3, push}, {3, push}, {3, push}}};
  write_recording<3>(bad, recording);
  const auto replay = [](const std::filesystem::path& file, const std::string& options) {
    return tests::run_softcell("demo 3d --headless --quiet --size 32x32 --replay " + file.string() + options);
  };
  const tests::CommandResult first = replay(bad, " --record " + again.string());
  EXPECT_EQ(first.status, 1) << first.output;
  const auto recorded = read_recording<3>(again);
  EXPECT_EQ(recorded.events, recording.events);
  EXPECT_EQ(recorded.frames, 4) << "the last is the one that failed";
  const tests::CommandResult second = replay(again, "");
  EXPECT_EQ(second.status, 1);
  EXPECT_EQ(second.output, first.output);
}

TEST(Replay, OfARunThatFailedAndCannotBeRecordedHasTheFirstErrorsStatus) {
  const tests::ScratchFolder scratch;
  const std::filesystem::path bad = scratch.path() / "bad.rec";
  const InputEvent<3> push{.action = Action::kPush, .body = kEveryBody, .value = {3e38f, 0, 0}};
  write_recording<3>(bad, {.scene = "drop",
                           .scene_hash = scene_hash(load_scene_3d("drop")),
                           .frames = 1,
                           .state_hash = 0,
                           .events = {{0, push}, {0, push}, {0, push}}});
  const tests::CommandResult result = tests::run_softcell(
      "demo 3d --headless --quiet --size 32x32 --record /dev/full --replay " + bad.string());
  EXPECT_EQ(result.status, 1);
  EXPECT_TRUE(contains(result.output, "cannot write /dev/full: No space left"));
  EXPECT_TRUE(contains(result.output, "not finite"));
}

// What is known of its state is of a frame that it has no room for.
TEST(Recording, ThatIsFullIsGivenUp) {
  const tests::ScratchFolder scratch;
  RecordingFiles options;
  options.record = scratch.path() / "full.rec";
  Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  {
    InputLog<2> log(options);
    log.begin(scene);
    const std::vector<InputEvent<2>> events(kMaxRecordedEvents - 1);
    log.record(0, events);
    log.record(1, std::span(events).first(1));
    EXPECT_NO_THROW(log.require_room());
    log.record(2, std::span(events).first(1));
    try {
      log.require_room();
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(contains(error.what(), "full.rec: a recording has at most 10000000 frames and 2000000 ev"));
    }
    log.save(0);
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

/// A part of a scene, and a change of it.
template <class AScene>
struct SceneChange {
  const char* part;
  std::function<void(AScene&)> change;
};

/// Expects that each change gives the scene another hash, which no other change gives.
template <class AScene>
void expect_other_hashes(const AScene& scene, const std::vector<SceneChange<AScene>>& changes) {
  std::map<std::uint64_t, const char*> seen{{scene_hash(scene), "the scene itself"}};
  for (const SceneChange<AScene>& each : changes) {
    AScene other = scene;
    each.change(other);
    const auto [place, is_new] = seen.emplace(scene_hash(other), each.part);
    EXPECT_TRUE(is_new) << each.part << " has the hash of " << place->second;
  }
}

/// What scenes of both dimensions have.
template <class AScene>
std::vector<SceneChange<AScene>> common_changes() {
  constexpr int kDimension = std::is_same_v<AScene, Scene> ? 3 : 2;
  const auto change_begin = [](AScene& s, const auto& change) {
    auto begin = std::make_shared<Beginning<kDimension>>();
    begin->soft_bodies.resize(1);
    begin->rigid_bodies.resize(1);
    begin->pins.resize(1);
    change(*begin);
    s.begin = begin;
  };
  std::vector<SceneChange<AScene>> changes{
      {"gravity", [](AScene& s) { s.gravity += 1; }},
      {"friction", [](AScene& s) { s.friction += 0.1f; }},
      {"restitution", [](AScene& s) { s.restitution += 0.1f; }},
      {"substeps", [](AScene& s) { s.substeps += 1; }},
      {"contacts", [](AScene& s) { s.contacts = ppu::ContactMethod::kSpheres; }},
      {"sleep", [](AScene& s) { s.sleep = !s.sleep; }},
      {"number of soft bodies", [](AScene& s) { s.soft_bodies.push_back(s.soft_bodies.front()); }},
      {"position of a soft body", [](AScene& s) { s.soft_bodies[0].position.x() += 1e-6f; }},
      {"strength of a soft body", [](AScene& s) { s.soft_bodies[0].strengths.emplace_back(); }},
      {"attachment", [](AScene& s) { s.attachments.emplace_back(); }},
      {"cut", [](AScene& s) { s.cuts.emplace_back(); }},
      {"begin", [=](AScene& s) { change_begin(s, [](auto&) {}); }},
      {"gravity of begin",
       [=](AScene& s) { change_begin(s, [](auto& b) { b.gravity.emplace().setOnes(); }); }},
      {"tilt of begin", [=](AScene& s) { change_begin(s, [](auto& b) { b.tilt.emplace().setOnes(); }); }},
      {"time_scale of begin", [=](AScene& s) { change_begin(s, [](auto& b) { b.time_scale = 2; }); }},
      {"frames of begin", [=](AScene& s) { change_begin(s, [](auto& b) { b.frames = 7; }); }},
      {"seconds of begin", [=](AScene& s) { change_begin(s, [](auto& b) { b.seconds = 7; }); }},
      {"ended attachment", [=](AScene& s) { change_begin(s, [](auto& b) { b.ended_attachments = {3}; }); }},
      {"pin", [=](AScene& s) { change_begin(s, [](auto& b) { b.pins[0].radius = 1; }); }},
      {"pinned particle", [=](AScene& s) { change_begin(s, [](auto& b) { b.pins[0].particles = {1}; }); }},
      {"velocity of begin",
       [=](AScene& s) { change_begin(s, [](auto& b) { b.rigid_bodies[0].velocity.x() = 1; }); }},
      {"rest of begin",
       [=](AScene& s) { change_begin(s, [](auto& b) { b.soft_bodies[0].rest.emplace_back().setOnes(); }); }},
  };
  using Settings = ppu::SoftBodySettings;
  for (const auto& [part, change] : std::initializer_list<std::pair<const char*, void (*)(Settings&)>>{
           {"cell_size", [](Settings& s) { s.cell_size *= 2; }},
           {"half_width", [](Settings& s) { s.half_width += 1; }},
           {"density", [](Settings& s) { s.density *= 2; }},
           {"alpha", [](Settings& s) { s.alpha *= 0.5f; }},
           {"damping", [](Settings& s) { s.damping += 0.1f; }},
           {"friction of a soft body", [](Settings& s) { s.friction += 0.1f; }},
           {"restitution of a soft body", [](Settings& s) { s.restitution += 0.1f; }},
           {"contacts of a soft body", [](Settings& s) { s.contacts = !s.contacts; }},
           {"self_contacts", [](Settings& s) { s.self_contacts = !s.self_contacts; }},
           {"frequency", [](Settings& s) { s.frequency = 2.0f; }},
           {"damping_time", [](Settings& s) { s.damping_time = 3.0f; }},
           {"plasticity", [](Settings& s) { s.plasticity = ppu::Plasticity{}; }},
           {"yield", [](Settings& s) { s.plasticity = ppu::Plasticity{.yield = 0.2f}; }},
           {"creep", [](Settings& s) { s.plasticity = ppu::Plasticity{.creep = 3}; }},
           {"limit", [](Settings& s) { s.plasticity = ppu::Plasticity{.limit = 2}; }},
           {"fracture", [](Settings& s) { s.fracture = ppu::Fracture{}; }},
           {"stretch", [](Settings& s) { s.fracture = ppu::Fracture{.stretch = 0.1f}; }},
           {"turn", [](Settings& s) { s.fracture = ppu::Fracture{.turn = 0.1f}; }},
           {"least_cells", [](Settings& s) { s.fracture = ppu::Fracture{.least_cells = 3}; }}})
    changes.push_back({part, [function = change](AScene& s) { function(s.soft_bodies[0].settings); }});
  using Attachment = AttachmentPlacement<kDimension>;
  for (const auto& [part, change] : std::initializer_list<std::pair<const char*, void (*)(Attachment&)>>{
           {"attached body", [](Attachment& a) { a.body = 1; }},
           {"other body", [](Attachment& a) { a.other = 1; }},
           {"box", [](Attachment& a) { a.box = 1; }},
           {"rigid body", [](Attachment& a) { a.rigid = 1; }},
           {"at", [](Attachment& a) { a.at.setOnes(); }},
           {"radius", [](Attachment& a) { a.radius = 1; }},
           {"other_at", [](Attachment& a) { a.other_at.setOnes(); }},
           {"other_radius", [](Attachment& a) { a.other_radius = 1; }},
           {"kind", [](Attachment& a) { a.settings.kind = ppu::AttachmentKind::kRope; }},
           {"point", [](Attachment& a) { a.settings.point.emplace().setOnes(); }},
           {"axis", [](Attachment& a) { a.settings.axis = -a.settings.axis; }},
           {"length", [](Attachment& a) { a.settings.length = 1.0f; }},
           {"compliance", [](Attachment& a) { a.settings.compliance = 1; }},
           {"break_force", [](Attachment& a) { a.settings.break_force = 1; }},
           {"touch", [](Attachment& a) { a.settings.touch = true; }}})
    changes.push_back({part, [function = change](AScene& s) { function(s.attachments.emplace_back()); }});
  return changes;
}

TEST(SceneHash, DependsOnEachPartOfTheSimulation2d) {
  const Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  std::vector<SceneChange<Scene2d>> changes = common_changes<Scene2d>();
  for (const SceneChange<Scene2d>& each : std::vector<SceneChange<Scene2d>>{
           {"cells", [](Scene2d& s) { s.soft_bodies[0].cells.pop_back(); }},
           {"contact_radius", [](Scene2d& s) { s.soft_bodies[0].contact_radius += 0.1f; }},
           {"wall", [](Scene2d& s) { s.rigid_bodies.pop_back(); }},
           {"circle", [](Scene2d& s) { s.rigid_bodies.back().shape = CircleShape{}; }},
           {"radius of a circle", [](Scene2d& s) { s.rigid_bodies.back().shape = CircleShape{2}; }},
           {"polygon", [](Scene2d& s) { s.rigid_bodies.back().shape = PolygonShape{}; }},
           {"mass", [](Scene2d& s) { s.rigid_bodies.back().mass = 1; }},
           {"position of a rigid body", [](Scene2d& s) { s.rigid_bodies.back().position.x() += 1e-6f; }},
           {"angle", [](Scene2d& s) { s.rigid_bodies.back().angle += 0.1f; }},
           {"has_end", [](Scene2d& s) { s.cuts.emplace_back().where.has_end = false; }},
           {"time of a cut", [](Scene2d& s) { s.cuts.emplace_back().time = 3; }},
           {"body of a cut", [](Scene2d& s) { s.cuts.emplace_back().body = 3; }},
           {"way of a cut", [](Scene2d& s) {
              s.cuts.emplace_back().where.way = {3, 4};
            }}})
    changes.push_back(each);
  expect_other_hashes(scene, changes);
}

TEST(SceneHash, DependsOnEachPartOfTheSimulation3d) {
  const Scene scene = std::get<Scene>(parse_scene(
      "[framework]\nhalf_width = 3\n[[soft_body]]\nname = \"a\"\nposition = [0, 1, 0]\ncell_size = 0.4\n"
      "shape = { kind = \"box\", size = [1, 1, 1] }\n[[obstacle]]\nposition = [2, 1, 0]\n"
      "shape = { kind = \"box\", size = [1, 1, 1] }\n",
      "s.toml"));
  ASSERT_FALSE(scene.obstacles.empty());
  const auto change_body = [](Scene& s, const auto& change) {
    RigidBody& body = s.rigid_bodies.emplace_back();
    body.parts.emplace_back();
    change(body);
  };
  const auto change_motion = [=](Scene& s, const auto& change) {
    change_body(s, [&](RigidBody& body) { change(body.motion.emplace()); });
  };
  const Eigen::Quaternionf turned(0, 1, 0, 0);
  std::vector<SceneChange<Scene>> changes = common_changes<Scene>();
  for (const SceneChange<Scene>& each : std::vector<SceneChange<Scene>>{
           {"mesh", [](Scene& s) { s.soft_bodies[0].mesh.positions[0].x() += 0.1f; }},
           {"triangles", [](Scene& s) { s.soft_bodies[0].mesh.triangles.pop_back(); }},
           {"twist", [](Scene& s) { s.soft_bodies[0].twist = 1; }},
           {"wall", [](Scene& s) { s.boxes.pop_back(); }},
           {"size of a box", [](Scene& s) { s.boxes[0].size.x() += 1; }},
           {"mass of a box", [](Scene& s) { s.boxes[0].mass = 1; }},
           {"position of a box", [](Scene& s) { s.boxes[0].position.x() += 1; }},
           {"rotation of a box", [=](Scene& s) { s.boxes[0].rotation = turned; }},
           {"mesh of an obstacle", [](Scene& s) { s.obstacles[0].mesh.positions[0].x() += 0.1f; }},
           {"position of an obstacle", [](Scene& s) { s.obstacles[0].position.x() += 1; }},
           {"tilt", [](Scene& s) { s.tilt.amplitude_x = 1; }},
           {"tilt about z", [](Scene& s) { s.tilt.amplitude_z = 1; }},
           {"period_x", [](Scene& s) { s.tilt.period_x = 2; }},
           {"period_z", [](Scene& s) { s.tilt.period_z = 2; }},
           {"begin of the tilt", [](Scene& s) { s.tilt.begin = 1; }},
           {"rigid body", [=](Scene& s) { change_body(s, [](RigidBody&) {}); }},
           {"parts", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.parts.emplace_back(); }); }},
           {"kind of a part",
            [=](Scene& s) {
              change_body(s, [](RigidBody& b) { b.parts[0].shape.kind = ppu::RigidShapeKind::kCone; });
            }},
           {"size of a part", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.parts[0].shape.size.x() = 2; }); }},
           {"radius of a part", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.parts[0].shape.radius = 2; }); }},
           {"height of a part", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.parts[0].shape.height = 2; }); }},
           {"position of a part",
            [=](Scene& s) { change_body(s, [](RigidBody& b) { b.parts[0].shape.position.x() = 2; }); }},
           {"rotation of a part",
            [=](Scene& s) { change_body(s, [=](RigidBody& b) { b.parts[0].shape.rotation = turned; }); }},
           {"mass", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.mass = 1; }); }},
           {"position of a rigid body", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.position.x() = 1; }); }},
           {"rotation of a rigid body", [=](Scene& s) { change_body(s, [=](RigidBody& b) { b.rotation = turned; }); }},
           {"friction of a rigid body", [=](Scene& s) { change_body(s, [](RigidBody& b) { b.friction = 1.0f; }); }},
           {"motion", [=](Scene& s) { change_motion(s, [](Motion&) {}); }},
           {"axis of a motion", [=](Scene& s) { change_motion(s, [](Motion& m) { m.axis = {1, 0, 0}; }); }},
           {"spin", [=](Scene& s) { change_motion(s, [](Motion& m) { m.spin = 1; }); }},
           {"swing", [=](Scene& s) { change_motion(s, [](Motion& m) { m.swing = {1, 0, 0}; }); }},
           {"period", [=](Scene& s) { change_motion(s, [](Motion& m) { m.period = 2; }); }},
           {"stop", [=](Scene& s) { change_motion(s, [](Motion& m) { m.stops = {{.time = 1}}; }); }},
           {"angle of a stop", [=](Scene& s) { change_motion(s, [](Motion& m) { m.stops = {{.angle = 1}}; }); }},
           {"joint", [](Scene& s) { s.joints = {Joint{}}; }},
           {"body of a joint", [](Scene& s) { s.joints = {{.a = 1}}; }},
           {"other body of a joint", [](Scene& s) { s.joints = {{.b = 1}}; }},
           {"point of a joint", [](Scene& s) { s.joints = {{.point = {1, 0, 0}}}; }},
           {"axis of a joint", [](Scene& s) { s.joints = {{.axis = {0, 1, 0}}}; }},
           {"speed of a joint", [](Scene& s) { s.joints = {{.speed = 1}}; }},
           {"torque of a joint", [](Scene& s) { s.joints = {{.torque = 1}}; }},
           {"has_end", [](Scene& s) { s.cuts.emplace_back().where.has_end = false; }},
           {"time of a cut", [](Scene& s) { s.cuts.emplace_back().time = 3; }},
           {"body of a cut", [](Scene& s) { s.cuts.emplace_back().body = 3; }},
           {"corner of a cut", [](Scene& s) { s.cuts.emplace_back().where.corner = {3, 4, 5}; }}})
    changes.push_back(each);
  expect_other_hashes(scene, changes);
}

/// Recordings replay in scenes that only look different.
TEST(SceneHash, DependsOnNothingElse) {
  const Scene2d scene = std::get<Scene2d>(parse_scene(kScene2d, "s.toml"));
  Scene2d other = scene;
  other.name = other.title = other.soft_bodies[0].name = "other";
  other.camera.height += 1;
  other.script = {};
  other.frames += 1;
  other.soft_bodies[0].colour = other.rigid_bodies[0].colour = {0, 0, 0};
  EXPECT_EQ(scene_hash(other), scene_hash(scene));
}

}  // namespace
}  // namespace softcell::demos
