// SPEs step and skin a textured jelly in a Bullet world: jelly_on_spes jelly.obj picture.png

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <stdexcept>

#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/mesh_import/mesh_import.h"
#include "softcell/render/offscreen_context.h"
#include "softcell/render/png_io.h"
#include "softcell/render/renderer.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "softcell/spe_bodies/spe_skinner.h"

using namespace softcell;

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("expected a mesh and a picture: jelly.obj picture.png");
  // A Bullet world as in any program: a floor, and a box in the air.
  btStaticPlaneShape ground({0, 1, 0}, 0);
  btRigidBody floor(0, nullptr, &ground);
  btBoxShape cube({0.25f, 0.25f, 0.25f});
  btVector3 inertia;
  cube.calculateLocalInertia(16, inertia);
  btRigidBody box(16, nullptr, &cube, inertia);
  box.setWorldTransform(btTransform(btQuaternion(0.6f, 0, 0), {0, 1.5f, 0}));
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  for (btRigidBody* const body : {&floor, &box}) world.addRigidBody(body);

  // The soft body. Six SPEs step and skin it.
  const ppu::TriangleMesh mesh = ppu::import_mesh(argv[1]);
  const auto painted = mesh.materials.empty() ? nullptr : mesh.materials[0].base_texture.picture;
  if (painted == nullptr) throw std::runtime_error("expected a mesh whose material has a texture");
  const auto model = ppu::make_soft_body_model(mesh, {.cell_size = 0.1f, .alpha = 0.06f, .damping = 0.2f});
  ppu::SpeRuntime spes;
  ppu::BulletSoftBodies bodies(world, spes);
  const ppu::SoftBody<3>& jelly = bodies.add(model, {0, 0.2f, 0});
  ppu::SpeSkinner skinner(spes);
  skinner.add(jelly);

  // What is drawn: the jelly with the texture that its material names, the box, the floor.
  const auto context = render::create_offscreen_context();
  render::Renderer renderer(*context, {.width = 960, .height = 640});
  const ppu::DrawOrder order = ppu::draw_order(*model);
  render::SkinnedDraw skin{.mesh = renderer.add_mesh(order.indices), .colour = {1, 1, 1}};
  renderer.set_texture_coordinates(skin.mesh, order.reorder(mesh.texture_coordinates));
  render::Image texture(painted->width, painted->height);
  texture.rgba = painted->rgba;
  skin.texture = renderer.add_texture(texture);
  const auto add = [&](const ppu::TriangleMesh& m) {
    return render::StaticDraw{.mesh = renderer.add_static_mesh(m.positions, m.normals, m.triangles)};
  };
  render::StaticDraw rigid[] = {add(ppu::make_box({12, 0.001f, 12}, 12)),
                                add(ppu::make_box({0.5f, 0.5f, 0.5f}, 1))};
  rigid[1].colour = render::srgb(0x4A7FB5), rigid[0].pattern = render::Pattern::kTiles;
  for (int frame = 0; frame < 75; ++frame) {
    world.stepSimulation(1 / 60.0f, 2, 1 / 120.0f);
    skinner.begin_frame();  // a game draws skinner.vertices(jelly) here: those of the frame before
  }
  skinner.finish_frame();
  const ppu::SkinnedVertices drawn = skinner.vertices(jelly);
  renderer.update_mesh(skin.mesh, std::as_bytes(drawn.vertices));
  skin.origin = drawn.origin;
  box.getWorldTransform().getOpenGLMatrix(rigid[1].pose.data());
  render::FrameDescription picture{.skinned = {&skin, 1}, .statics = rigid};
  picture.camera = {.eye = {-1.4f, 1.2f, 2.6f}, .target = {0, 0.5f, 0}, .tan_half_fov_y = 0.3f};
  picture.light.shadow_radius = 3;
  renderer.render(picture);
  render::write_png(argv[2], renderer.pixels());
} catch (const std::exception& error) {
  std::fprintf(stderr, "jelly_on_spes: %s\n", error.what());
  return 1;
}
