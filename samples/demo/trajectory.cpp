// trajectory.cpp  see trajectory.hpp.
#include "samples/demo/trajectory.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/truth/trajectory.hpp"
#include "samples/demo/pose_blend.hpp"

namespace sinew::demo {
namespace {

// The tensor's numbers; rows x width of them, all finite.
std::vector<float> finite_rows(const baker::Safetensors& file, const std::string& name,
                               const std::vector<long>& shape) {
  std::vector<float> values = file.need(name, shape).as_f32();
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    throw baker::BadInput(file.path + ": tensor " + name + " is not finite at " + std::to_string(i) +
                          "; simulate it again");
  }
  return values;
}

double rate_of(const baker::Safetensors& file) {
  if (!file.metadata.contains("sinew.trajectory")) {
    throw baker::BadInput(
        file.path +
        ": is not a trajectory; make one with: sinew-bake truth IN.glb --positions -o T.safetensors");
  }
  if (file.metadata.at("sinew.trajectory") != baker::kTrajectoryVersion)
    throw baker::BadInput(file.path + ": is a trajectory of another version; simulate it again");
  const auto rate = file.metadata.find("rate_hz");
  const double rate_hz = rate == file.metadata.end() ? 0 : std::strtod(rate->second.c_str(), nullptr);
  if (!(rate_hz > 0 && rate_hz < 1e5))
    throw baker::BadInput(file.path + ": metadata rate_hz is missing or not above 0; simulate it again");
  return rate_hz;
}

}  // namespace

Trajectory::Trajectory(const std::string& path, const CharacterFile& character) {
  const baker::Safetensors file = baker::read_safetensors(path);
  rate_hz_ = rate_of(file);
  joints_ = character.view.joints.size();
  vertices_ = character.view.character->vertex_count;
  if (!file.tensors.contains("positions")) {
    throw baker::BadInput(path + ": holds no positions; simulate it with: sinew-bake truth ... --positions");
  }
  position_rows_ = finite_rows(file, "positions", {-1, static_cast<long>(vertices_), 3});
  rows_ = position_rows_.size() / (3 * vertices_);
  const auto rows = static_cast<long>(rows_);
  joint_rows_ = finite_rows(file, "joints", {rows, static_cast<long>(joints_), 12});
  root_rows_ = finite_rows(file, "root", {rows, 7});
  if (rows_ == 0) throw baker::BadInput(path + ": holds no frames; simulate it again");
  const auto motion = file.metadata.find("motion");
  motion_ = motion == file.metadata.end() ? "trajectory" : motion->second;
  if (motion_.starts_with("clip:")) motion_.erase(0, 5);
}

Trajectory::Place Trajectory::place_at(double t_s) const {
  const double place = std::clamp(t_s * rate_hz_, 0.0, static_cast<double>(rows_ - 1));
  // Frames that fall on a tick are exactly that tick, whatever the product was rounded to.
  const double near = std::round(place);
  const double snapped = std::abs(place - near) < 1e-6 ? near : place;
  const auto row = static_cast<size_t>(snapped);
  return {row, std::min(row + 1, rows_ - 1), static_cast<float>(snapped - static_cast<double>(row))};
}

void Trajectory::pose_at(double t_s, std::span<Matrix34> joints, RootTransform* root) const {
  const auto [row, next, share] = place_at(t_s);
  const std::span<const float> all(joint_rows_);
  mix_near(all.subspan(row * 12 * joints_, 12 * joints_), all.subspan(next * 12 * joints_, 12 * joints_),
           share, joints);
  const float *a = &root_rows_[7 * row], *b = &root_rows_[7 * next];
  for (int i = 0; i < 3; ++i) root->position_m[i] = a[i] + double(share) * (double(b[i]) - a[i]);
  const Eigen::Quaternionf turn = Eigen::Quaternionf(a + 3).slerp(share, Eigen::Quaternionf(b + 3));
  std::copy_n(turn.coeffs().data(), 4, root->rotation_xyzw);
}

void Trajectory::positions_at(double t_s, std::span<Eigen::Vector3f> out) const {
  const auto [row, next, share] = place_at(t_s);
  const float *a = &position_rows_[3 * vertices_ * row], *b = &position_rows_[3 * vertices_ * next];
  for (size_t v = 0; v < vertices_; ++v) {
    const Eigen::Map<const Eigen::Vector3f> here(a + 3 * v), there(b + 3 * v);
    out[v] = here + share * (there - here);
  }
}

}  // namespace sinew::demo
