#include "ppu/mesh_import/gltf_accessors.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include "ppu/mesh_import/mesh_file_text.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::uint64_t kMaxBufferBytes = std::uint64_t{1} << 30;  // of all together
constexpr std::uint32_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                        kUnsignedInt = 5125, kFloat = 5126;

std::size_t component_size(std::uint32_t type, const std::string& place) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      refuse(place + ".componentType is " + std::to_string(type) + ", which glTF does not have");
  }
}

std::size_t component_count(const std::string& type, const std::string& place) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 4> kTypes{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}};
  for (const auto& [name, count] : kTypes) {
    if (type == name) return count;
  }
  refuse(place + ".type is " + in_quotes(type) + "; SCALAR, VEC2, VEC3 or VEC4 was expected");
}

template <class Number>
Number load(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

/// One component as a number; a normalized one as a share of the largest.
float component(const char* bytes, std::uint32_t type, bool normalized) {
  const auto share = [normalized](auto number, float largest) {
    const auto value = static_cast<float>(number);
    return normalized ? std::max(value / largest, -1.0f) : value;
  };
  switch (type) {
    case kByte:
      return share(load<std::int8_t>(bytes), 127);
    case kUnsignedByte:
      return share(load<std::uint8_t>(bytes), 255);
    case kShort:
      return share(load<std::int16_t>(bytes), 32767);
    case kUnsignedShort:
      return share(load<std::uint16_t>(bytes), 65535);
    case kUnsignedInt:
      return share(load<std::uint32_t>(bytes), 4294967295.0f);
    default:
      return load<float>(bytes);
  }
}

std::uint32_t whole_number(const char* bytes, std::uint32_t type) {
  switch (type) {
    case kUnsignedByte:
      return load<std::uint8_t>(bytes);
    case kUnsignedShort:
      return load<std::uint16_t>(bytes);
    default:
      SC_ASSERT(type == kUnsignedInt, "a component of type {} is to be a whole number", type);
      return load<std::uint32_t>(bytes);
  }
}

/// 0..63; 64: no letter of base64.
std::uint32_t base64_digit(char c) {
  static const std::array<std::uint8_t, 256> table = [] {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> digits;
    digits.fill(64);
    for (std::size_t i = 0; i < kLetters.size(); ++i)
      digits[static_cast<unsigned char>(kLetters[i])] = static_cast<std::uint8_t>(i);
    return digits;
  }();
  return table[static_cast<unsigned char>(c)];
}

/// @return  false where one of the letters is none.
bool decode_base64(std::string_view text, std::string& out) {
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint32_t digit = base64_digit(c);
    if (digit == 64) return false;
    bits = (bits << 6) | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>((bits >> count) & 0xFFu);
  }
  return true;
}

/// A part of a buffer or view. @throws std::runtime_error  it is not inside.
std::string_view part_of(std::string_view bytes, std::uint64_t offset, std::uint64_t size,
                         const std::string& place) {
  if (offset > bytes.size() || size > bytes.size() - offset) {
    refuse(place + " reaches from byte " + std::to_string(offset) + " to " + std::to_string(offset + size) +
           " of " + std::to_string(bytes.size()));
  }
  return bytes.substr(offset, size);
}

constexpr std::uint64_t kAnyOffset = std::uint64_t{1} << 40;

}  // namespace

std::string decode_data_uri(std::string_view uri, const std::string& place) {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.substr(0, 256).find(kMark);
  if (mark == std::string_view::npos) refuse(place + " holds data that are not in base64");
  std::string bytes;
  if (!decode_base64(uri.substr(mark + kMark.size()), bytes))
    refuse(place + " holds data that are not base64");
  return bytes;
}

std::string file_of_uri(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon != std::string_view::npos && uri.substr(0, colon).find('/') == std::string_view::npos) return {};
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned value = 0;
    const auto hex = uri.substr(std::min(i + 1, uri.size()), 2);
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), value, 16);
    if (uri[i] == '%' && hex.size() == 2 && error == std::errc() && end == hex.data() + 2) {
      name += static_cast<char>(value);
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

std::string_view GltfBuffers::buffer(std::uint32_t number) {
  const GltfValue description = root_.item("buffers", number);
  const std::string* const uri = description.whole_text("uri");
  const std::uint64_t length = description.required_whole("byteLength", kMaxBufferBytes);
  std::string_view bytes;
  if (uri == nullptr) {
    if (number != 0 || !bytes_) description.refuse("it has no uri, and the file has no bytes for it");
    bytes = *bytes_;
  } else {
    const auto known = loaded_.find(number);
    std::string& kept = loaded_[number];
    if (known == loaded_.end()) {
      if (uri->starts_with("data:")) {
        kept = decode_data_uri(*uri, description.place());
      } else {
        const std::string name = file_of_uri(*uri);
        std::optional<std::string> read;
        if (read_neighbour_) read = read_neighbour_(name, kMaxBufferBytes - loaded_bytes_);
        if (!read) description.refuse(name_in_quotes(*uri) + " is no file in the model's folder or below");
        kept = std::move(*read);
      }
      loaded_bytes_ += kept.size();
      if (loaded_bytes_ > kMaxBufferBytes) refuse("its buffers have more than 1 GB");
    }
    bytes = kept;
  }
  if (bytes.size() < length) {
    description.refuse("it is to have " + std::to_string(length) + " bytes and has " +
                       std::to_string(bytes.size()));
  }
  return bytes.substr(0, length);
}

GltfBuffers::View GltfBuffers::view(std::uint32_t number) {
  SC_ASSERT(number < views(), "view {} of {}", number, views());
  const GltfValue description = root_.item("bufferViews", number);
  const auto in = description.index("buffer", "buffers", root_.size("buffers"));
  if (!in) description.refuse("it has no 'buffer'");
  const std::uint64_t offset = description.whole("byteOffset", kAnyOffset, 0);
  const std::uint64_t size = description.required_whole("byteLength", kAnyOffset);
  const std::uint64_t stride = description.whole("byteStride", 252, 0);
  return {part_of(buffer(*in), offset, size, description.place()), stride};
}

GltfAccessor::GltfAccessor(const GltfValue& accessor, GltfBuffers& buffers)
    : place_(accessor.place()),
      count_(accessor.required_whole("count", kAnyOffset)),
      components_(component_count(accessor.text("type", 16), place_)),
      type_(static_cast<std::uint32_t>(accessor.required_whole("componentType", 0xFFFF))),
      normalized_(accessor.flag("normalized", false)) {
  const std::size_t component = component_size(type_, place_);
  size_ = components_ * component;
  stride_ = size_;
  if (const auto number = accessor.index("bufferView", "bufferViews", buffers.views())) {
    const GltfBuffers::View view = buffers.view(*number);
    if (view.stride != 0) stride_ = view.stride;
    if (stride_ < size_) {
      accessor.refuse("its elements of " + std::to_string(size_) + " bytes lie " + std::to_string(stride_) +
                      " bytes apart");
    }
    const std::uint64_t offset = accessor.whole("byteOffset", kAnyOffset, 0);
    bytes_ = part_of(view.bytes, offset, count_ == 0 ? 0 : (count_ - 1) * stride_ + size_, place_);
  }
  if (const auto sparse = accessor.optional_object("sparse")) read_sparse(*sparse, buffers);
}

void GltfAccessor::read_sparse(const GltfValue& sparse, GltfBuffers& buffers) {
  const std::uint64_t count = sparse.required_whole("count", count_);
  const auto part = [&](const GltfValue& of, std::uint64_t size) {
    const auto view = of.index("bufferView", "bufferViews", buffers.views());
    if (!view) of.refuse("it has no 'bufferView'");
    return part_of(buffers.view(*view).bytes, of.whole("byteOffset", kAnyOffset, 0), size, of.place());
  };
  const GltfValue indices = sparse.object("indices"), values = sparse.object("values");
  const auto type = static_cast<std::uint32_t>(indices.required_whole("componentType", 0xFFFF));
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt)
    indices.refuse("its componentType is not one of whole numbers of 0 or more");
  const std::size_t size = component_size(type, indices.place());
  const std::string_view bytes = part(indices, count * size);
  sparse_values_ = part(values, count * size_);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = whole_number(bytes.data() + i * size, type);
    if (element >= count_ || (i > 0 && element <= sparse_elements_.back()))
      indices.refuse("its numbers do not ascend below " + std::to_string(count_));
    sparse_elements_.push_back(element);
  }
}

bool GltfAccessor::is_unsigned() const {
  return type_ == kUnsignedByte || type_ == kUnsignedShort || type_ == kUnsignedInt;
}

const char* GltfAccessor::bytes_of(std::size_t index) const {
  SC_ASSERT(index < count_, "element {} of {} of {}", index, count_, place_);
  if (!sparse_elements_.empty()) {
    const auto found = std::ranges::lower_bound(sparse_elements_, index);
    if (found != sparse_elements_.end() && *found == index)
      return sparse_values_.data() + static_cast<std::size_t>(found - sparse_elements_.begin()) * size_;
  }
  return bytes_.empty() ? nullptr : bytes_.data() + index * stride_;
}

Eigen::Vector4f GltfAccessor::element(std::size_t index) const {
  Eigen::Vector4f numbers(0, 0, 0, 1);
  const char* const bytes = bytes_of(index);
  for (std::size_t c = 0; c < components_; ++c) {
    numbers[static_cast<Eigen::Index>(c)] =
        bytes == nullptr ? 0.0f : component(bytes + c * (size_ / components_), type_, normalized_);
  }
  return numbers;
}

std::uint32_t GltfAccessor::scalar(std::size_t index) const {
  const char* const bytes = bytes_of(index);
  return bytes == nullptr ? 0 : whole_number(bytes, type_);
}

}  // namespace softcell::ppu
