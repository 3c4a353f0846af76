#pragma once
// The numbers of a glTF file: buffers, the views into them, and accessors, which give bytes a type.

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ppu/mesh_import/gltf_json.h"
#include "ppu/mesh_import/neighbours.h"

namespace softcell::ppu {

/// Bytes of a "data:" URI in base64. @throws std::runtime_error  a clause that begins with `place`.
std::string decode_data_uri(std::string_view uri, const std::string& place);

/// A URI that names a file, "%20" and the like decoded; empty: it names none here ("https:").
std::string file_of_uri(std::string_view uri);

/// Buffers, each read when it is first asked for, and views into them.
class GltfBuffers {
 public:
  /// @param root, bytes  of the document, which outlives this   @param read_neighbour  null: no file is opened
  GltfBuffers(const GltfValue& root, std::optional<std::string_view> bytes,
              const ReadNeighbour& read_neighbour)
      : root_(root), bytes_(bytes), read_neighbour_(read_neighbour) {}

  struct View {
    std::string_view bytes;
    std::size_t stride = 0;  ///< bytes from element to element; 0: they lie close together
  };
  /// The view of that number, inside its buffer. @throws std::runtime_error  a clause.
  View view(std::uint32_t number);
  std::size_t views() const { return root_.size("bufferViews"); }

 private:
  std::string_view buffer(std::uint32_t number);

  const GltfValue& root_;
  std::optional<std::string_view> bytes_;
  const ReadNeighbour& read_neighbour_;
  std::map<std::uint32_t, std::string> loaded_;
  std::size_t loaded_bytes_ = 0;
};

/// A row of elements of 1 to 4 numbers. All of it lies in its buffers, sparse elements included.
class GltfAccessor {
 public:
  /// @param accessor  an item of the document's array   @throws std::runtime_error  a clause that begins with its place.
  GltfAccessor(const GltfValue& accessor, GltfBuffers& buffers);

  std::size_t count() const { return count_; }
  std::size_t components() const { return components_; }
  bool is_normalized() const { return normalized_; }
  bool is_unsigned() const;
  const std::string& place() const { return place_; }

  /// An element as numbers; those it does not have are 0, or 1 for the fourth. Normalized ones are 0..1 or -1..1.
  Eigen::Vector4f element(std::size_t index) const;
  /// A scalar as it is. @pre  is_unsigned()
  std::uint32_t scalar(std::size_t index) const;

 private:
  const char* bytes_of(std::size_t index) const;
  void read_sparse(const GltfValue& sparse, GltfBuffers& buffers);

  std::string place_;
  std::size_t count_ = 0, components_ = 1, size_ = 1, stride_ = 0;
  std::uint32_t type_ = 0;  ///< of a component, as OpenGL numbers them
  bool normalized_ = false;
  std::string_view bytes_;                      ///< none: all elements are 0
  std::vector<std::uint32_t> sparse_elements_;  ///< ascending
  std::string_view sparse_values_;
};

}  // namespace softcell::ppu
