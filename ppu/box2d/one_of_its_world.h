#pragma once
// Ensures that a Box2D world has only one object with soft bodies, as that object does the world's step.

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <vector>

class b2World;

namespace softcell::ppu {

/// Box2D offers no place in a world for such data, so a list of the process, behind a mutex, holds the worlds that have an object:
/// different threads may use different worlds.
class OneOfItsWorld {
 public:
  /// @throws std::invalid_argument  the world already has one.
  explicit OneOfItsWorld(const b2World& world) : world_(&world) {
    const std::lock_guard lock(mutex());
    if (std::ranges::find(worlds(), world_) != worlds().end())
      throw std::invalid_argument(
          "this Box2D world has a Box2dSoftBodies already; a world can have only one");
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
