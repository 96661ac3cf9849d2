// triangles.cpp  Index lists to triangles (glTF 2.0, 3.7.2.1).
#include "baker/import/meshes/triangles.hpp"

#include <numeric>

namespace sinew::baker {
namespace {

std::vector<uint32_t> read_corners(const tinygltf::Primitive& primitive, size_t vertex_count,
                                   const AccessorReader& accessors, const std::string& where,
                                   const Source& source) {
  std::vector<uint32_t> corners;
  if (primitive.indices < 0) {
    corners.resize(vertex_count);
    std::iota(corners.begin(), corners.end(), 0u);
    return corners;
  }
  const std::string place = where + " indices";
  corners = accessors.indices(primitive.indices, place);
  const uint32_t restart = accessors.restart_value(primitive.indices, place);
  for (size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] == restart)
      source.refuse(place,
                    "index " + std::to_string(i) + " is " + std::to_string(restart) +
                        ", primitive restart, which glTF does not have",
                    "split the strip into primitives, or export triangles");
    if (corners[i] >= vertex_count)
      source.refuse(place,
                    "index " + std::to_string(i) + " is " + std::to_string(corners[i]) + ", there are " +
                        std::to_string(vertex_count) + " vertices",
                    "the file is damaged; export it again");
  }
  return corners;
}

}  // namespace

bool is_triangle_mode(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

std::vector<std::array<int, 3>> read_triangles(const tinygltf::Primitive& primitive, size_t vertex_count,
                                               const AccessorReader& accessors, const std::string& where,
                                               Source& source) {
  const std::vector<uint32_t> corners = read_corners(primitive, vertex_count, accessors, where, source);
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES,
             fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
  const size_t count = list ? corners.size() / 3 : corners.size() < 3 ? 0 : corners.size() - 2;
  if (list && corners.size() % 3 != 0)
    source.note(where,
                std::to_string(corners.size() % 3) + " corners after the last whole triangle: left out");
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(count);
  for (size_t t = 0; t < count; ++t) {
    const size_t a = list ? 3 * t : fan ? t + 1 : t;
    const size_t b = list  ? a + 1
                     : fan ? t + 2
                           : t + 1 + t % 2;  // every second triangle of a strip is turned
    const size_t c = list ? a + 2 : fan ? 0 : t + 2 - t % 2;
    triangles.push_back(
        {static_cast<int>(corners[a]), static_cast<int>(corners[b]), static_cast<int>(corners[c])});
  }
  return triangles;
}

}  // namespace sinew::baker
