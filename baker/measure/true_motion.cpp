// true_motion.cpp  see true_motion.hpp.
#include "baker/measure/true_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/truth/trajectory.hpp"
#include "tissue/modes/guard.hpp"

namespace sinew::baker {
namespace {

[[noreturn]] void refuse(const Safetensors& file, const std::string& what) {
  throw BadInput(file.path + ": " + what);
}

std::vector<float> finite_values(const Safetensors& file, const std::string& name,
                                 const std::vector<long>& shape) {
  std::vector<float> values = file.need(name, shape).as_f32();
  if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
    refuse(file, "tensor '" + name + "' is not finite; simulate it again");
  return values;
}

void check_version(const Safetensors& file) {
  const auto version = file.metadata.find("sinew.trajectory");
  if (version == file.metadata.end())
    refuse(file, "is not a trajectory; make one with: sinew-bake truth IN.glb --motion M -o T.safetensors");
  if (version->second != kTrajectoryVersion)
    refuse(file, "is a trajectory of another version; simulate it again");
}

void check_rate(const Safetensors& file, const pack::PackView& character) {
  const auto found = file.metadata.find("rate_hz");
  const double rate_hz = found == file.metadata.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
  const double wanted_hz = static_cast<double>(character.network->rate_hz);
  if (rate_hz != wanted_hz)
    refuse(file, "is of " + std::to_string(rate_hz) + " ticks a second, the character of " +
                     std::to_string(wanted_hz) + "; simulate it with that --rate");
}

// Shares of a region's radius that float rounding may move a node's resting place by.
constexpr float kSamePlace = 1e-4f;

void check_nodes(const Safetensors& file, const pack::PackView& character) {
  const std::vector<float> rest =
      finite_values(file, "node.rest_position", {static_cast<long>(character.nodes.size()), 3});
  for (size_t n = 0; n < character.nodes.size(); ++n) {
    const pack::NodeRecord& node = character.nodes[n];
    const pack::RegionRecord& region = character.regions[node.region];
    for (size_t k = 0; k < 3; ++k) {
      const float place = (node.position_m[k] - region.center_m[k]) / region.radius_m;
      if (!(std::fabs(rest[3 * n + k] - place) <= kSamePlace))
        refuse(file,
               "control node " + std::to_string(n) +
                   " is not where the character has it; simulate the glTF and recipe it was baked from");
    }
  }
}

// Place and quaternion in double, as they were simulated.
std::vector<RootTransform> read_roots(const Safetensors& file) {
  constexpr size_t kNumbers = 7;
  const Tensor& tensor = file.need("root", {-1, kNumbers});
  if (tensor.dtype != Dtype::kF64) refuse(file, "tensor 'root' is not of doubles; simulate it again");
  std::vector<double> values(tensor.count());
  if (!values.empty()) std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
    refuse(file, "tensor 'root' is not finite; simulate it again");
  std::vector<RootTransform> roots(values.size() / kNumbers);
  for (size_t t = 0; t < roots.size(); ++t) {
    std::copy_n(&values[t * kNumbers], 3, roots[t].position_m);
    for (size_t k = 0; k < 4; ++k)
      roots[t].rotation_xyzw[k] = static_cast<float>(values[t * kNumbers + 3 + k]);
  }
  return roots;
}

}  // namespace

void check_trajectory_of(const Safetensors& file, const pack::PackView& character) {
  check_version(file);
  check_rate(file, character);
  file.need("joints", {-1, static_cast<long>(character.joints.size()), 12});
  check_nodes(file, character);
}

TrueMotion::TrueMotion(const Safetensors& file, const pack::PackView& character)
    : nodes_(character.nodes.size()),
      joint_count_(character.joints.size()),
      region_count_(character.regions.size()) {
  check_trajectory_of(file, character);
  roots_ = read_roots(file);
  const auto rows = static_cast<long>(roots_.size());
  if (rows < 2) refuse(file, "holds no tick; simulate it for longer");
  displacement_ = finite_values(file, "displacement", {rows, static_cast<long>(nodes_), 3});
  limit(character);
  const std::vector<float> joints =
      finite_values(file, "joints", {rows, static_cast<long>(joint_count_), 12});
  joints_.resize(joints.size() / 12);
  std::memcpy(joints_.data(), joints.data(), joints.size() * sizeof(float));
}

void TrueMotion::limit(const pack::PackView& character) {
  for (size_t tick = 0; tick < roots_.size(); ++tick)
    for (const pack::RegionRecord& region : character.regions) {
      float* u = &displacement_[3 * (tick * nodes_ + region.first_node)];
      const float share = tissue::limit_share(tissue::largest_displacement_m(u, region.node_count),
                                              region.displacement_limit_m);
      for (float* end = u + size_t{3} * region.node_count; u != end; ++u) *u *= share;
      limited_.push_back(share);
    }
}

std::span<const Matrix34> TrueMotion::joints(size_t tick) const {
  return std::span(joints_).subspan(tick * joint_count_, joint_count_);
}

}  // namespace sinew::baker
