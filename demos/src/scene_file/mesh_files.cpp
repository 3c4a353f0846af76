#include "mesh_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <span>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// The pixels of all pictures of the mesh's materials, each counted once.
std::size_t pixels_of(const ppu::TriangleMesh& mesh) {
  std::set<const ppu::MeshPicture*> pictures;
  std::size_t pixels = 0;
  for (const ppu::MeshMaterial& material : mesh.materials) {
    for (const ppu::MeshTexture* texture : {&material.base_texture, &material.metallic_roughness_texture,
                                            &material.normal_texture, &material.emission_texture}) {
      if (texture->picture && pictures.insert(texture->picture.get()).second)
        pixels += texture->picture->rgba.size() / 4;
    }
  }
  return pixels;
}

}  // namespace

std::string not_read_of(const std::string& file, const ppu::ImportReport& report) {
  SC_ASSERT(!report.not_read.empty(), "all of {} was read", file);
  return fmt::format("{}: not read: {}", file, fmt::join(report.not_read, ", "));
}

const ppu::TriangleMesh& MeshFiles::mesh(const std::string& file, const Location& location) {
  const auto known = meshes_.find(file);
  if (known != meshes_.end()) return known->second;
  ppu::ImportReport report;
  ppu::TriangleMesh mesh;
  const base::EmbeddedFile* const embedded = source_.embedded_mesh(file);
  try {
    mesh = embedded != nullptr ? ppu::import_mesh(std::as_bytes(std::span(embedded->text)), file, &report)
                               : ppu::import_mesh(source_.mesh(file, location), &report);
  } catch (const SceneError&) {
    throw;
  } catch (const std::exception& error) {
    throw SceneError(location, error.what());
  }
  source_.add_files(report.files);
  if (!report.not_read.empty()) notes_.push_back(not_read_of(file, report));
  pixels_ += pixels_of(mesh);
  if (pixels_ > kMaxPixels) {
    throw SceneError(
        location,
        fmt::format("the pictures of the scene's meshes have {} pixels or more; they may have at most {}",
                    pixels_, kMaxPixels));
  }
  return meshes_.emplace(file, std::move(mesh)).first->second;
}

}  // namespace softcell::demos
