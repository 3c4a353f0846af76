#pragma once
// The callbacks that soft bodies install in a Bullet world, once for all clients of the world.

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <chrono>
#include <vector>

namespace softcell::ppu {

/// Called at the beginning of every internal substep.
class SubstepClient {
 public:
  virtual void begin_substep(float step) = 0;  ///< `step` in seconds

 protected:
  ~SubstepClient() = default;
};

/// The pre-tick callback and the overlap filter of one world. Both also call the ones that were installed before.
///
/// Bullet has one user pointer for all callbacks of a world, and it belongs to the caller. So a list of the process, behind a mutex, finds
/// the hook of a world; different threads may step different worlds.
class BulletHook {
 public:
  static void attach(btDiscreteDynamicsWorld& world, SubstepClient& client);
  /// When the last client detaches, the world gets back the callbacks that were installed before.
  static void detach(btDiscreteDynamicsWorld& world, SubstepClient& client);

  /// The hook of a world, or null.
  static BulletHook* find(const btDynamicsWorld& world);

  /// Adds to the time spent on this world's soft bodies. Bullet's profiler does not count it in a release build.
  void add_time(std::chrono::nanoseconds time) { spent_ += time; }
  /// The elapsed time of the soft bodies of a world in its steps, since it got its hook; 0: it has none.
  static std::chrono::nanoseconds spent_in(const btDynamicsWorld& world) {
    const BulletHook* const hook = find(world);
    return hook != nullptr ? hook->spent_ : std::chrono::nanoseconds(0);
  }

  explicit BulletHook(btDiscreteDynamicsWorld& world);

 private:
  /// Prevents contacts between particles of the same soft body.
  struct Filter final : btOverlapFilterCallback {
    btOverlapFilterCallback* previous = nullptr;
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
  };

  static void on_pre_tick(btDynamicsWorld* world, btScalar step);
  void uninstall();

  btDiscreteDynamicsWorld& world_;
  btInternalTickCallback previous_tick_;
  Filter filter_;
  std::vector<SubstepClient*> clients_;
  std::chrono::nanoseconds spent_{0};
};

}  // namespace softcell::ppu
