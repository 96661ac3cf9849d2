// paint.cpp  Brush layers and colour noise.
#include "baker/creature/paint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "baker/common/smooth_step.hpp"
#include "baker/creature/body_field.hpp"

namespace sinew::baker {
namespace {

using Eigen::Vector3d;

class Brush {
 public:
  Brush(const CreatureRecipe& recipe, const PaintLayer& layer)
      : layer_(layer),
        solid_(layer.solid),
        limited_(!layer.joints.empty()),
        chosen_(recipe.joints.size(), 0) {
    for (int joint : matching_joints(recipe, layer.joints)) chosen_[static_cast<size_t>(joint)] = 1;
  }

  double strength_at(const PaintSpot& spot) const {
    double strength = layer_.strength;
    if (!layer_.everywhere)
      strength *= 1 - smooth_step(0, layer_.fade_m, solid_.sample(spot.position).distance);
    if (!layer_.facing.isZero()) strength *= smooth_step(0, 0.7, spot.normal.dot(layer_.facing.normalized()));
    if (limited_) strength *= smooth_step(0.25, 0.75, chosen_share(spot.skin));
    return strength;
  }

 private:
  double chosen_share(const SkinWeights& skin) const {
    double share = 0;
    for (size_t i = 0; i < kCreatureInfluences; ++i)
      share += chosen_[static_cast<size_t>(skin.joint[i])] * skin.weight[i];
    return share;
  }

  const PaintLayer& layer_;
  SolidField solid_;
  bool limited_;
  std::vector<uint8_t> chosen_;
};

double lattice_noise(int x, int y, int z) {  // -1 .. 1, the same on every machine
  uint32_t h = static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u ^
               static_cast<uint32_t>(z) * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return static_cast<double>((h ^ (h >> 15)) & 0xffffu) / 32767.5 - 1;
}

double value_noise(const Vector3d& p) {
  const Vector3d base(std::floor(p.x()), std::floor(p.y()), std::floor(p.z()));
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<int, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = (corner >> axis) & 1;
      const double t = smooth_step(0, 1, p[axis] - base[axis]);
      weight *= bit ? t : 1 - t;
      cell[static_cast<size_t>(axis)] = static_cast<int>(base[axis]) + bit;
    }
    sum += weight * lattice_noise(cell[0], cell[1], cell[2]);
  }
  return sum;
}

}  // namespace

Vector3d linear_from_srgb(const Vector3d& srgb) {
  Vector3d linear;
  for (int i = 0; i < 3; ++i)
    linear[i] = srgb[i] <= 0.04045 ? srgb[i] / 12.92 : std::pow((srgb[i] + 0.055) / 1.055, 2.4);
  return linear;
}

std::vector<Vector3d> paint_color(const CreatureRecipe& recipe, const std::vector<PaintSpot>& spots) {
  std::vector<Vector3d> colors(spots.size(), Vector3d::Constant(0.8));
  for (const PaintLayer& layer : recipe.coat) {
    const Brush brush(recipe, layer);
    for (size_t i = 0; i < spots.size(); ++i)
      colors[i] += brush.strength_at(spots[i]) * (layer.color - colors[i]);
  }
  for (size_t i = 0; i < spots.size(); ++i) {
    const Vector3d place = spots[i].position / recipe.noise.size_m;
    const double shade =
        recipe.noise.strength * (0.65 * value_noise(place) + 0.35 * value_noise(2.3 * place));
    colors[i] = linear_from_srgb((colors[i] * (1 + shade)).cwiseMin(1.0).cwiseMax(0.0));
  }
  return colors;
}

std::vector<double> paint_stiffness(const CreatureRecipe& recipe, const std::vector<PaintSpot>& spots) {
  std::vector<double> stiffness(spots.size(), 1.0);
  for (const PaintLayer& layer : recipe.tissue) {
    const Brush brush(recipe, layer);
    for (size_t i = 0; i < spots.size(); ++i)
      stiffness[i] += brush.strength_at(spots[i]) * (layer.stiffness - stiffness[i]);
  }
  return stiffness;
}

}  // namespace sinew::baker
