#pragma once
// What soft bodies install in a Bullet world, once however many clients there are.

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <chrono>
#include <vector>

namespace softcell::ppu {

/// Is called at the beginning of every internal substep.
class SubstepClient {
 public:
  virtual void begin_substep(float step) = 0;  ///< `step` in seconds

 protected:
  ~SubstepClient() = default;
};

/// The pre-tick callback and the overlap filter of one world. Both call what they found installed.
///
/// Bullet has one user pointer for all callbacks of a world, and it is the caller's. So hooks are found by
/// their world, in a list of the process behind a mutex; worlds may be stepped by different threads.
class BulletHook {
 public:
  static void attach(btDiscreteDynamicsWorld& world, SubstepClient& client);
  /// With the last client the world gets back what was installed before.
  static void detach(btDiscreteDynamicsWorld& world, SubstepClient& client);

  /// The hook of a world, or null.
  static BulletHook* find(const btDynamicsWorld& world);

  /// Adds to the time spent for this world. Bullet's profile has no such thing in a release build.
  void add_time(std::chrono::nanoseconds time) { spent_ += time; }
  std::chrono::nanoseconds spent() const { return spent_; }

  explicit BulletHook(btDiscreteDynamicsWorld& world);

 private:
  /// No contacts between particles of the same soft body.
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
