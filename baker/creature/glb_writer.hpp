// glb_writer.hpp  Collects accessors and JSON into a glTF 2.0 binary.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace sinew::baker {

class GlbWriter {
 public:
  enum Target { kNone = 0, kVertices = 34962, kIndices = 34963 };

  // Each returns the accessor's index. `width` is the number of components of an element: 1, 3, 4 or 16.
  size_t add_floats(std::span<const float> values, size_t width, Target target, bool with_bounds = false);
  size_t add_bytes(std::span<const uint8_t> values, size_t width, Target target);
  size_t add_shorts(std::span<const uint16_t> values, size_t width, Target target, bool normalized);
  size_t add_indices(std::span<const uint32_t> values);

  nlohmann::json document;  // everything but accessors, bufferViews and buffers

  std::vector<std::byte> finish();

 private:
  size_t add(const void* data, size_t bytes, int component, size_t count, size_t width, Target target);

  std::vector<std::byte> binary_;
  nlohmann::json accessors_ = nlohmann::json::array(), views_ = nlohmann::json::array();
};

}  // namespace sinew::baker
