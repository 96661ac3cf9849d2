// side.cpp  see side.hpp.
#include "samples/demo/side.hpp"

#include <algorithm>
#include <cmath>

#include "baker/render/scene.hpp"

namespace sinew::demo {
namespace {

constexpr float kRadians = 0.017453293f;
constexpr size_t kRays = 4000;  // a side

Eigen::Vector3f towards_camera(float yaw_deg) {
  const float yaw = yaw_deg * kRadians, pitch = kPitch_deg * kRadians;
  return {std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch)};
}

// How much of what moves is turned to the camera and not hidden.
float seen_from(float yaw_deg, const render::Mesh& bind, const render::Scene& scene,
                std::span<const float> weights) {
  const Eigen::Vector3f to_camera = towards_camera(yaw_deg);
  const float skin = 1e-3f * render::bounding_box(bind.positions).diagonal().norm();
  const auto moved = static_cast<size_t>(std::ranges::count_if(weights, [](float w) { return w > 0; }));
  const size_t every = std::max<size_t>(1, moved / kRays);
  float seen = 0;
  for (size_t v = 0, met = 0; v < weights.size(); ++v) {
    if (!(weights[v] > 0) || met++ % every != 0) continue;
    const float turned = bind.normals[v].dot(to_camera);
    if (turned <= 0) continue;
    const Eigen::Vector3f start = bind.positions[v] + skin * bind.normals[v];
    if (!scene.occluded(start, to_camera, 0)) seen += turned * weights[v];
  }
  return seen;
}

}  // namespace

float camera_yaw_deg(const std::string& view, float facing_deg, const render::Mesh& bind,
                     std::span<const float> weights) {
  if (view == "front") return facing_deg;
  if (view == "side") return facing_deg + 90;
  if (view == "back") return facing_deg + 180;
  // The first is kept unless another shows a good deal more.
  constexpr float kThreeQuarters[] = {32, -32, 148, -148}, kGoodDeal = 1.25f;
  const render::Scene scene(bind);
  float best_deg = kThreeQuarters[0], most = 0;
  for (const float side_deg : kThreeQuarters) {
    const float seen = seen_from(facing_deg + side_deg, bind, scene, weights);
    if (seen <= kGoodDeal * most) continue;
    best_deg = side_deg;
    most = seen;
  }
  return facing_deg + best_deg;
}

}  // namespace sinew::demo
