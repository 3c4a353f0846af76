#include "ppu/bullet/bullet_hook.h"

#include <algorithm>
#include <memory>
#include <mutex>

#include "ppu/bullet/contact_sphere.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// Gives access to the pre-tick callback: Bullet lets it be set but not read.
struct TickSlot : btDynamicsWorld {
  static constexpr btInternalTickCallback btDynamicsWorld::*kPreTick = &TickSlot::m_internalPreTickCallback;
};

struct Entry {
  const btDynamicsWorld* world;
  std::unique_ptr<BulletHook> hook;
};

std::mutex g_mutex;
std::vector<Entry> g_hooks;  // guarded by g_mutex; a hook itself belongs to its world's thread

auto entry_of(const btDynamicsWorld& world) {
  return std::find_if(g_hooks.begin(), g_hooks.end(), [&](const Entry& e) { return e.world == &world; });
}

}  // namespace

bool BulletHook::Filter::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const auto& object_a = *static_cast<const btCollisionObject*>(a->m_clientObject);
  const auto& object_b = *static_cast<const btCollisionObject*>(b->m_clientObject);
  if (object_a.getUserPointer() == object_b.getUserPointer() && ContactSphere::is_shape_of(object_a) &&
      ContactSphere::is_shape_of(object_b)) {
    return false;
  }
  if (previous) return previous->needBroadphaseCollision(a, b);
  return (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
         (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
}

BulletHook::BulletHook(btDiscreteDynamicsWorld& world)
    : world_(world), previous_tick_(world.*TickSlot::kPreTick) {
  world.setInternalTickCallback(&on_pre_tick, world.getWorldUserInfo(), true);
  filter_.previous = world.getPairCache()->getOverlapFilterCallback();
  world.getPairCache()->setOverlapFilterCallback(&filter_);
}

void BulletHook::uninstall() {
  // Keep a callback that somebody else has installed later.
  if (world_.*TickSlot::kPreTick == &on_pre_tick) {
    world_.setInternalTickCallback(previous_tick_, world_.getWorldUserInfo(), true);
  }
  if (world_.getPairCache()->getOverlapFilterCallback() == &filter_) {
    world_.getPairCache()->setOverlapFilterCallback(filter_.previous);
  }
}

void BulletHook::on_pre_tick(btDynamicsWorld* world, btScalar step) {
  BulletHook* hook = find(*world);
  if (!hook) return;
  if (hook->previous_tick_) hook->previous_tick_(world, step);
  hook = find(*world);  // the program's callback may have destroyed the soft bodies
  if (!hook) return;
  for (SubstepClient* client : hook->clients_) client->begin_substep(step);
}

BulletHook* BulletHook::find(const btDynamicsWorld& world) {
  const std::lock_guard lock(g_mutex);
  const auto entry = entry_of(world);
  return entry == g_hooks.end() ? nullptr : entry->hook.get();
}

void BulletHook::attach(btDiscreteDynamicsWorld& world, SubstepClient& client) {
  const std::lock_guard lock(g_mutex);
  auto entry = entry_of(world);
  if (entry == g_hooks.end()) {
    g_hooks.push_back({&world, std::make_unique<BulletHook>(world)});
    entry = g_hooks.end() - 1;
  }
  SC_ASSERT(std::ranges::count(entry->hook->clients_, &client) == 0, "the client {} is attached twice",
            &client);
  entry->hook->clients_.push_back(&client);
}

void BulletHook::detach(btDiscreteDynamicsWorld& world, SubstepClient& client) {
  const std::lock_guard lock(g_mutex);
  const auto entry = entry_of(world);
  SC_ASSERT(entry != g_hooks.end() && std::ranges::count(entry->hook->clients_, &client) == 1,
            "the client {} was not attached to this world", &client);
  std::erase(entry->hook->clients_, &client);
  if (!entry->hook->clients_.empty()) return;
  entry->hook->uninstall();
  g_hooks.erase(entry);
}

}  // namespace softcell::ppu
