// accessor.cpp  Bounds checks and decoding of accessors, sparse ones included (glTF 2.0, 3.6).
#include "baker/import/gltf/accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sinew::baker {
namespace {

constexpr const char* kMend = "the file is damaged; export it again";
constexpr size_t kMaxBytes = size_t{1} << 40;       // larger offsets and lengths could overflow sums
constexpr size_t kMaxImpliedElements = 16'000'000;  // an accessor without bytes may claim any count

// largest: what a normalised integer is divided by; 0 for a plain number.
template <class T>
double read_as(const unsigned char* bytes, double largest) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  const auto number = static_cast<double>(value);
  return largest == 0 ? number : std::max(-1.0, number / largest);
}

double decode(const unsigned char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return read_as<int8_t>(bytes, normalized ? 127 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return read_as<uint8_t>(bytes, normalized ? 255 : 0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return read_as<int16_t>(bytes, normalized ? 32767 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return read_as<uint16_t>(bytes, normalized ? 65535 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return read_as<uint32_t>(bytes, 0);
    default:
      return read_as<float>(bytes, 0);
  }
}

bool is_gltf_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT ||
         (type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

size_t component_bytes(int type) {
  return static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type)));
}

}  // namespace

const tinygltf::Accessor& AccessorReader::at(int accessor, const std::string& where) const {
  if (accessor < 0 || static_cast<size_t>(accessor) >= model_.accessors.size())
    source_.refuse(where,
                   "names accessor " + std::to_string(accessor) + ", the file has " +
                       std::to_string(model_.accessors.size()),
                   kMend);
  const tinygltf::Accessor& found = model_.accessors[static_cast<size_t>(accessor)];
  if (!is_gltf_type(found.componentType))
    source_.refuse(where,
                   "accessor " + std::to_string(accessor) + " has component type " +
                       std::to_string(found.componentType) + ", which glTF does not have",
                   kMend);
  return found;
}

size_t AccessorReader::count(int accessor, const std::string& where) const {
  return at(accessor, where).count;
}

int AccessorReader::components(int accessor, const std::string& where) const {
  return tinygltf::GetNumComponentsInType(static_cast<uint32_t>(at(accessor, where).type));
}

AccessorReader::Bytes AccessorReader::bytes(int view, size_t offset, size_t count, size_t element_bytes,
                                            const std::string& where) const {
  if (view < 0 || static_cast<size_t>(view) >= model_.bufferViews.size())
    source_.refuse(where,
                   "names bufferView " + std::to_string(view) + ", the file has " +
                       std::to_string(model_.bufferViews.size()),
                   kMend);
  const tinygltf::BufferView& found = model_.bufferViews[static_cast<size_t>(view)];
  const std::string name = "bufferView " + std::to_string(view);
  if (found.buffer < 0 || static_cast<size_t>(found.buffer) >= model_.buffers.size())
    source_.refuse(where,
                   name + " names buffer " + std::to_string(found.buffer) + ", the file has " +
                       std::to_string(model_.buffers.size()),
                   kMend);
  const size_t buffer_bytes = model_.buffers[static_cast<size_t>(found.buffer)].data.size();
  if (found.byteOffset > kMaxBytes || found.byteLength > kMaxBytes ||
      found.byteOffset + found.byteLength > buffer_bytes)
    source_.refuse(where,
                   name + " ends at byte " + std::to_string(found.byteOffset + found.byteLength) +
                       " of buffer " + std::to_string(found.buffer) + ", which has " +
                       std::to_string(buffer_bytes),
                   kMend);
  const size_t stride = found.byteStride == 0 ? element_bytes : found.byteStride;
  if (stride < element_bytes)
    source_.refuse(where,
                   name + " has a byteStride of " + std::to_string(stride) + ", its elements take " +
                       std::to_string(element_bytes),
                   kMend);
  if (count > kMaxBytes / stride || offset > kMaxBytes ||
      (count > 0 && offset + (count - 1) * stride + element_bytes > found.byteLength))
    source_.refuse(where,
                   std::to_string(count) + " elements from byte " + std::to_string(offset) +
                       " do not fit into " + name + " of " + std::to_string(found.byteLength) + " bytes",
                   kMend);
  const unsigned char* start = model_.buffers[static_cast<size_t>(found.buffer)].data.data();
  return {start + found.byteOffset + offset, stride};
}

void AccessorReader::overwrite_sparse(const tinygltf::Accessor& accessor, int components,
                                      const std::string& where, std::vector<double>* values) const {
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
      !is_index_type(sparse.indices.componentType))
    source_.refuse(where, "its sparse count, offset or index type is not valid", kMend);
  const size_t size = component_bytes(accessor.componentType), width = static_cast<size_t>(components);
  const size_t count = static_cast<size_t>(sparse.count);
  const Bytes places = bytes(sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset), count,
                             component_bytes(sparse.indices.componentType), where + " sparse indices");
  const Bytes replacements = bytes(sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset),
                                   count, size * width, where + " sparse values");
  for (size_t i = 0; i < count; ++i) {
    const auto place =
        static_cast<size_t>(decode(places.data + i * places.stride, sparse.indices.componentType, false));
    if (place >= accessor.count)
      source_.refuse(where,
                     "sparse index " + std::to_string(place) + " is past its " +
                         std::to_string(accessor.count) + " elements",
                     kMend);
    for (size_t k = 0; k < width; ++k)
      (*values)[place * width + k] = decode(replacements.data + i * replacements.stride + k * size,
                                            accessor.componentType, accessor.normalized);
  }
}

std::vector<double> AccessorReader::numbers(int index, int components, const std::string& where) const {
  const tinygltf::Accessor& accessor = at(index, where);
  if (this->components(index, where) != components)
    source_.refuse(where,
                   "accessor " + std::to_string(index) + " holds " +
                       std::to_string(this->components(index, where)) + " numbers an element instead of " +
                       std::to_string(components),
                   kMend);
  const size_t size = component_bytes(accessor.componentType), width = static_cast<size_t>(components);
  const std::string place = where + ", accessor " + std::to_string(index);
  if (accessor.bufferView < 0 && accessor.count > kMaxImpliedElements)
    source_.refuse(place, "claims " + std::to_string(accessor.count) + " elements without any bytes", kMend);

  Bytes source;
  if (accessor.bufferView >= 0)
    source = bytes(accessor.bufferView, accessor.byteOffset, accessor.count, size * width, place);
  std::vector<double> values(accessor.count * width, 0.0);
  if (source.data)
    for (size_t i = 0; i < accessor.count; ++i)
      for (size_t k = 0; k < width; ++k)
        values[i * width + k] =
            decode(source.data + i * source.stride + k * size, accessor.componentType, accessor.normalized);
  if (accessor.sparse.isSparse) overwrite_sparse(accessor, components, place, &values);
  return values;
}

double AccessorReader::largest_integer(int index, const std::string& where) const {
  const tinygltf::Accessor& accessor = at(index, where);
  if (accessor.normalized || accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) return 0;
  const bool is_signed = accessor.componentType == TINYGLTF_COMPONENT_TYPE_BYTE ||
                         accessor.componentType == TINYGLTF_COMPONENT_TYPE_SHORT;
  const size_t bits = 8 * component_bytes(accessor.componentType) - (is_signed ? 1 : 0);
  return std::ldexp(1.0, static_cast<int>(bits)) - 1;
}

bool AccessorReader::holds_indices(int index, const std::string& where) const {
  const tinygltf::Accessor& accessor = at(index, where);
  return is_index_type(accessor.componentType) && !accessor.normalized;
}

std::vector<uint32_t> AccessorReader::indices(int index, const std::string& where) const {
  if (!holds_indices(index, where))
    source_.refuse(where, "accessor " + std::to_string(index) + " does not hold unsigned integers", kMend);
  const std::vector<double> values = numbers(index, 1, where);
  return {values.begin(), values.end()};
}

uint32_t AccessorReader::restart_value(int index, const std::string& where) const {
  const size_t bytes = component_bytes(at(index, where).componentType);
  return bytes == 1 ? 0xffu : bytes == 2 ? 0xffffu : 0xffffffffu;
}

}  // namespace sinew::baker
