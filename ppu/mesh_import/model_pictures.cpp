#include "ppu/mesh_import/model_pictures.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "ppu/mesh_import/mesh_file_text.h"
#include "ppu/mesh_import/picture.h"

namespace softcell::ppu {
namespace {

constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{256} << 20;
constexpr std::size_t kMaxPhrases = 20;  // of what is not read: a sentence must end

}  // namespace

void add_not_read(std::vector<std::string>& not_read, const std::string& phrase) {
  if (not_read.size() < kMaxPhrases && std::ranges::find(not_read, phrase) == not_read.end())
    not_read.push_back(phrase);
}

std::shared_ptr<const MeshPicture> ModelPictures::from_bytes(std::string_view bytes,
                                                             const std::string& name) {
  if (!is_picture(bytes)) {
    add_not_read(not_read_, "the picture " + name + ", which is neither PNG nor JPEG");
    return nullptr;
  }
  try {
    const auto picture = decode_picture(bytes, kMaxModelPixels - pixels_);
    pixels_ += picture->rgba.size() / 4;
    return picture;
  } catch (const std::runtime_error& problem) {
    refuse("its picture " + name + ": " + problem.what());
  }
}

std::shared_ptr<const MeshPicture> ModelPictures::from_file(const std::string& name) {
  const auto known = files_.find(name);
  if (known != files_.end()) return known->second;
  std::optional<std::string> bytes;
  if (read_neighbour_) bytes = read_neighbour_(name, kMaxPictureBytes);
  if (!bytes) {
    add_not_read(not_read_,
                 "the picture " + name_in_quotes(name) + ", which is not in the model's folder or below");
  }
  return files_[name] = bytes ? from_bytes(*bytes, name_in_quotes(name)) : nullptr;
}

}  // namespace softcell::ppu
