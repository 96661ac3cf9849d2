// glb_writer.cpp  The container and its accessors (glTF 2.0, sections 3.6 and 4).
#include "baker/creature/glb_writer.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace sinew::baker {
namespace {

static_assert(std::endian::native == std::endian::little,
              "glTF is little-endian; write the bytes in that order");

enum Component { kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

const char* type_name(size_t width) {
  return width == 1 ? "SCALAR" : width == 3 ? "VEC3" : width == 4 ? "VEC4" : "MAT4";
}

void pad(std::vector<std::byte>& bytes, std::byte with) {
  while (bytes.size() % 4 != 0) bytes.push_back(with);
}

void append_word(std::vector<std::byte>& bytes, uint32_t word) {
  const auto* raw = reinterpret_cast<const std::byte*>(&word);
  bytes.insert(bytes.end(), raw, raw + sizeof word);
}

void append_chunk(std::vector<std::byte>& bytes, uint32_t type, const std::vector<std::byte>& data) {
  append_word(bytes, static_cast<uint32_t>(data.size()));
  append_word(bytes, type);
  bytes.insert(bytes.end(), data.begin(), data.end());
}

}  // namespace

size_t GlbWriter::add(const void* data, size_t bytes, int component, size_t count, size_t width,
                      Target target) {
  nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}};
  if (target != kNone) view["target"] = static_cast<int>(target);
  const auto* raw = static_cast<const std::byte*>(data);
  binary_.insert(binary_.end(), raw, raw + bytes);
  pad(binary_, std::byte{0});
  accessors_.push_back({{"bufferView", views_.size()},
                        {"componentType", component},
                        {"count", count},
                        {"type", type_name(width)}});
  views_.push_back(std::move(view));
  return accessors_.size() - 1;
}

size_t GlbWriter::add_floats(std::span<const float> values, size_t width, Target target, bool with_bounds) {
  const size_t index = add(values.data(), values.size_bytes(), kFloat, values.size() / width, width, target);
  if (!with_bounds) return index;
  std::vector<float> low(values.begin(), values.begin() + static_cast<long>(width)), high = low;
  for (size_t i = 0; i < values.size(); ++i) {
    low[i % width] = std::min(low[i % width], values[i]);
    high[i % width] = std::max(high[i % width], values[i]);
  }
  accessors_[index]["min"] = low;
  accessors_[index]["max"] = high;
  return index;
}

size_t GlbWriter::add_bytes(std::span<const uint8_t> values, size_t width, Target target) {
  return add(values.data(), values.size_bytes(), kUnsignedByte, values.size() / width, width, target);
}

size_t GlbWriter::add_shorts(std::span<const uint16_t> values, size_t width, Target target, bool normalized) {
  const size_t index =
      add(values.data(), values.size_bytes(), kUnsignedShort, values.size() / width, width, target);
  if (normalized) accessors_[index]["normalized"] = true;
  return index;
}

size_t GlbWriter::add_indices(std::span<const uint32_t> values) {
  constexpr uint32_t kPrimitiveRestart = 0xffff;
  if (*std::max_element(values.begin(), values.end()) >= kPrimitiveRestart)
    return add(values.data(), values.size_bytes(), kUnsignedInt, values.size(), 1, kIndices);
  std::vector<uint16_t> narrow;
  for (uint32_t value : values) narrow.push_back(static_cast<uint16_t>(value));
  return add_shorts(narrow, 1, kIndices, false);
}

std::vector<std::byte> GlbWriter::finish() {
  constexpr uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
  document["accessors"] = accessors_;
  document["bufferViews"] = views_;
  document["buffers"] = {{{"byteLength", binary_.size()}}};
  const std::string text = document.dump();
  std::vector<std::byte> json(text.size());
  std::memcpy(json.data(), text.data(), text.size());
  pad(json, std::byte{' '});
  std::vector<std::byte> file;
  append_word(file, kMagic);
  append_word(file, 2);
  append_word(file, static_cast<uint32_t>(12 + 8 + json.size() + 8 + binary_.size()));
  append_chunk(file, kJson, json);
  append_chunk(file, kBinary, binary_);
  return file;
}

}  // namespace sinew::baker
