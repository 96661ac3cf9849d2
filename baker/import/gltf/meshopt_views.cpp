// meshopt_views.cpp  EXT_meshopt_compression decoded by meshoptimizer.
#include "baker/import/gltf/meshopt_views.hpp"

#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "baker/import/gltf/vrm_values.hpp"

namespace sinew::baker {
namespace {

using tinygltf::Value;

constexpr const char* kExtension = "EXT_meshopt_compression";
constexpr const char* kMend = "the file is damaged; export or pack it again";
constexpr size_t kMostBytes = size_t{1} << 30;
constexpr size_t kJsonBegin = 20;  // of a .glb

bool is_glb(const std::vector<unsigned char>& bytes) {
  return bytes.size() >= kJsonBegin && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

uint32_t u32_at(const std::vector<unsigned char>& bytes, size_t offset) {
  uint32_t value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

void put_u32(std::vector<unsigned char>& bytes, size_t offset, size_t value) {
  const auto number = static_cast<uint32_t>(value);
  std::memcpy(bytes.data() + offset, &number, sizeof number);
}

// Of a .glb the JSON chunk, else all.
std::string_view json_of(const std::vector<unsigned char>& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  if (!is_glb(bytes)) return {text, bytes.size()};
  return {text + kJsonBegin, u32_at(bytes, 12)};
}

void replace_json(std::vector<unsigned char>& bytes, std::string json) {
  if (!is_glb(bytes)) return bytes.assign(json.begin(), json.end());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto begin = bytes.begin() + kJsonBegin;
  bytes.insert(bytes.erase(begin, begin + static_cast<std::ptrdiff_t>(json_of(bytes).size())), json.begin(),
               json.end());
  put_u32(bytes, 12, json.size());
  put_u32(bytes, 8, bytes.size());
}

bool is_fallback(const nlohmann::json& buffer) {
  const nlohmann::json::json_pointer place(std::string("/extensions/") + kExtension + "/fallback");
  return buffer.contains(place) && buffer[place] == true;
}

// What the extension says of one view.
struct Packed {
  size_t buffer = 0, offset = 0, length = 0, stride = 0, count = 0;
  std::string mode, filter;
};

class Decoder {
 public:
  Decoder(tinygltf::Model& model, const Source& source) : model_(model), source_(source) {}

  void run() {
    for (size_t v = 0; v < model_.bufferViews.size(); ++v) {
      refuse_newer(v);
      const auto found = model_.bufferViews[v].extensions.find(kExtension);
      if (found == model_.bufferViews[v].extensions.end()) continue;
      where_ = "bufferView " + std::to_string(v) + " " + kExtension;
      const Packed packed = read(found->second);
      tinygltf::Buffer decoded;
      decoded.data = decode(packed);
      tinygltf::BufferView& view = model_.bufferViews[v];
      view.buffer = static_cast<int>(model_.buffers.size());
      view.byteOffset = 0;
      view.byteLength = packed.count * packed.stride;
      view.byteStride = packed.mode == "ATTRIBUTES" ? packed.stride : 0;
      model_.buffers.push_back(std::move(decoded));
    }
  }

 private:
  // Its uncompressed bytes may be there; the ones that stand for them are one.
  void refuse_newer(size_t v) const {
    const tinygltf::BufferView& view = model_.bufferViews[v];
    const auto buffer = static_cast<size_t>(view.buffer);
    if (view.extensions.contains("KHR_meshopt_compression") && buffer < model_.buffers.size() &&
        model_.buffers[buffer].data.size() <= 1)
      source_.refuse("bufferView " + std::to_string(v),
                     "the geometry is compressed by KHR_meshopt_compression",
                     "export without mesh compression (gltf-transform copy IN OUT unpacks it)");
  }

  [[noreturn]] void refuse(const std::string& what) const { source_.refuse(where_, what, kMend); }

  size_t whole(const Value& value, const char* key, double otherwise) const {
    const Value& stated = part(value, key);
    const double given = stated.IsNumber() ? stated.GetNumberAsDouble() : otherwise;
    if (!(given >= 0 && given <= 4e9 && given == std::floor(given)))
      refuse(std::string("its ") + key + " is not a whole number");
    return static_cast<size_t>(given);
  }

  static std::string text(const Value& value, const char* key) {
    const Value& stated = part(value, key);
    return stated.IsString() ? stated.Get<std::string>() : "";
  }

  Packed read(const Value& value) const {
    Packed packed{.buffer = whole(value, "buffer", -1),
                  .offset = whole(value, "byteOffset", 0),
                  .length = whole(value, "byteLength", -1),
                  .stride = whole(value, "byteStride", -1),
                  .count = whole(value, "count", -1),
                  .mode = text(value, "mode"),
                  .filter = text(value, "filter")};
    if (packed.buffer >= model_.buffers.size() ||
        packed.offset + packed.length > model_.buffers[packed.buffer].data.size())
      refuse("reaches past the end of its buffer");
    if (packed.count > kMostBytes || packed.stride > 256 ||
        (decoded_ + packed.count * packed.stride) > kMostBytes)
      refuse("would be more than 1 GiB");
    check_shape(packed);
    return packed;
  }

  // meshoptimizer takes these for granted.
  void check_shape(const Packed& packed) const {
    const size_t stride = packed.stride;
    const bool attributes = packed.mode == "ATTRIBUTES";
    const bool indices = packed.mode == "TRIANGLES" || packed.mode == "INDICES";
    if (!attributes && !indices) refuse("has the unknown mode '" + packed.mode + "'");
    if (attributes ? stride == 0 || stride % 4 != 0 : stride != 2 && stride != 4)
      refuse("has a byteStride that its mode does not allow");
    if (packed.mode == "TRIANGLES" && packed.count % 3 != 0) refuse("has no whole triangles");
    const std::string& filter = packed.filter;
    const bool plain = filter.empty() || filter == "NONE";
    const bool fits = (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                      (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL";
    if (!plain && !(attributes && fits)) refuse("has a filter '" + filter + "' that does not fit");
  }

  std::vector<unsigned char> decode(const Packed& packed) {
    decoded_ += packed.count * packed.stride;
    std::vector<unsigned char> out(packed.count * packed.stride);
    const unsigned char* from = model_.buffers[packed.buffer].data.data() + packed.offset;
    int failed = 0;
    if (packed.count == 0) return out;
    if (packed.mode == "ATTRIBUTES")
      failed = meshopt_decodeVertexBuffer(out.data(), packed.count, packed.stride, from, packed.length);
    else if (packed.mode == "TRIANGLES")
      failed = meshopt_decodeIndexBuffer(out.data(), packed.count, packed.stride, from, packed.length);
    else
      failed = meshopt_decodeIndexSequence(out.data(), packed.count, packed.stride, from, packed.length);
    if (failed != 0) refuse("its bytes do not decode");
    if (packed.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), packed.count, packed.stride);
    if (packed.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), packed.count, packed.stride);
    if (packed.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), packed.count, packed.stride);
    return out;
  }

  tinygltf::Model& model_;
  const Source& source_;
  std::string where_;
  size_t decoded_ = 0;
};

}  // namespace

void give_fallback_buffers_bytes(std::vector<unsigned char>& bytes) {
  if (json_of(bytes).find("_meshopt_compression") == std::string_view::npos) return;
  nlohmann::json json = nlohmann::json::parse(json_of(bytes), nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return;
  for (size_t b = 0; b < json["buffers"].size(); ++b) {
    nlohmann::json& buffer = json["buffers"][b];
    const bool is_chunk = is_glb(bytes) && b == 0;
    if (!buffer.is_object() || is_chunk || (buffer.contains("uri") && !is_fallback(buffer))) continue;
    buffer["byteLength"] = 1;
    buffer["uri"] = "data:application/octet-stream;base64,AA==";
  }
  replace_json(bytes, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void decode_meshopt_views(tinygltf::Model& model, const Source& source) { Decoder(model, source).run(); }

}  // namespace sinew::baker
