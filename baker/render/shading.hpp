// shading.hpp  The light that leaves a point towards the camera.
#pragma once
#include "baker/render/camera.hpp"
#include "baker/render/renderer.hpp"
#include "baker/render/sampling.hpp"
#include "baker/render/scene.hpp"

namespace sinew::render {

// The random numbers of one path.
struct PathSamples {
  Eigen::Vector2f key, sky;
};

class Shading {
 public:
  Shading(const Mesh& mesh, const Scene& scene, const Camera& camera, const RenderOptions& options);
  // What the camera sees along a ray.
  Rgb along(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
            const PathSamples& samples) const;

 private:
  struct Surface;
  Surface surface_at(const Hit& hit, const Eigen::Vector3f& view) const;
  Rgb body(const Surface& surface, const Eigen::Vector3f& view, const PathSamples& samples) const;
  Rgb floor(const Eigen::Vector3f& point, const Eigen::Vector3f& view, const PathSamples& samples) const;
  Rgb floor_color(const Eigen::Vector3f& point, float slope) const;
  Rgb backdrop(const Eigen::Vector3f& direction) const;
  Eigen::Vector3f key_sample(const Eigen::Vector2f& sample) const;

  const Mesh& mesh_;
  const Scene& scene_;
  const RenderOptions& options_;
  Basis key_basis_;
  float size_m_ = 1, offset_m_ = 0, pixel_rad_ = 0;
  Eigen::Vector3f center_, eye_;
};

}  // namespace sinew::render
