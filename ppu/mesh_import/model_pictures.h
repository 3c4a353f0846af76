#pragma once
// The pictures of one model, each read once.

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ppu/mesh_import/neighbours.h"
#include "softcell/soft_bodies/mesh_material.h"

namespace softcell::ppu {

/// All pixels of a model's pictures together: 256 MB.
inline constexpr std::size_t kMaxModelPixels = std::size_t{64} << 20;

/// Adds a phrase to what is not read, once.
void add_not_read(std::vector<std::string>& not_read, const std::string& phrase);

class ModelPictures {
 public:
  /// @param read_neighbour  null: no file is opened   @param not_read  receives pictures that are missing or of another
  /// format. Both outlive this.
  ModelPictures(const ReadNeighbour& read_neighbour, std::vector<std::string>& not_read)
      : read_neighbour_(read_neighbour), not_read_(not_read) {}

  /// The picture in a file; null: there is none, or it has another format.
  /// @throws std::runtime_error  a clause: it is damaged, or there are too many pixels.
  std::shared_ptr<const MeshPicture> from_file(const std::string& name);

  /// The picture in these bytes; null: it has another format. @throws as from_file().
  /// @param name  of the picture in sentences: "'bark.png'"
  std::shared_ptr<const MeshPicture> from_bytes(std::string_view bytes, const std::string& name);

 private:
  const ReadNeighbour& read_neighbour_;
  std::vector<std::string>& not_read_;
  std::map<std::string, std::shared_ptr<const MeshPicture>> files_;
  std::size_t pixels_ = 0;
};

}  // namespace softcell::ppu
