// scene.hpp  The one place that talks to Embree: a mesh, and what a ray meets in it.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "baker/render/mesh.hpp"

namespace sinew::render {

struct Hit {
  float distance = 0;
  uint32_t triangle = 0;
  float u = 0, v = 0;  // weights of the triangle's second and third corner
};

class Scene {
 public:
  // Copies what it needs of the mesh. Throws std::runtime_error when Embree cannot start.
  explicit Scene(const Mesh& mesh);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Any number of threads may ask at once.
  std::optional<Hit> closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                             float farthest) const;
  bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::render
