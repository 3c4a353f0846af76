#pragma once
// A Box2D world has one object with soft bodies: its step is that object's.

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <vector>

class b2World;

namespace softcell::ppu {

/// Box2D has no place of ours in a world, so those that have an object are a list of the process, behind a mutex: worlds may be
/// used by different threads.
class OneOfItsWorld {
 public:
  /// @throws std::invalid_argument  the world has one already.
  explicit OneOfItsWorld(const b2World& world) : world_(&world) {
    const std::lock_guard lock(mutex());
    if (std::ranges::find(worlds(), world_) != worlds().end())
      throw std::invalid_argument("this Box2D world has a Box2dSoftBodies already, and may have one");
    worlds().push_back(world_);
  }
  ~OneOfItsWorld() {
    const std::lock_guard lock(mutex());
    std::erase(worlds(), world_);
  }
  OneOfItsWorld(const OneOfItsWorld&) = delete;
  OneOfItsWorld& operator=(const OneOfItsWorld&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::vector<const b2World*>& worlds() {
    static std::vector<const b2World*> worlds;
    return worlds;
  }

  const b2World* world_;
};

}  // namespace softcell::ppu
