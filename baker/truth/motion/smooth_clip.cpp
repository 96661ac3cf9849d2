// smooth_clip.cpp  see smooth_clip.hpp.
#include "baker/truth/motion/smooth_clip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr double kSampleRateHz = 60;

LocalPose weighted_sum(const std::array<const LocalPose*, 4>& poses, const std::array<double, 4>& weight) {
  const size_t joints = poses[0]->rotation.size();
  LocalPose out;
  out.translation.assign(joints, Vector3::Zero());
  out.scale.assign(joints, Vector3::Zero());
  out.rotation.resize(joints);
  for (size_t j = 0; j < joints; ++j) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (size_t k = 0; k < 4; ++k) {
      const Eigen::Vector4d& q = poses[k]->rotation[j].coeffs();
      sum += q * (q.dot(poses[0]->rotation[j].coeffs()) < 0 ? -weight[k] : weight[k]);
      out.translation[j] += weight[k] * poses[k]->translation[j];
      out.scale[j] += weight[k] * poses[k]->scale[j];
    }
    out.rotation[j].coeffs() = sum.normalized();
  }
  return out;
}

struct Step {
  double turn_rad, shift, stretch;
};

Step step_of(const LocalPose& a, const LocalPose& b, size_t joint) {
  return {a.rotation[joint].angularDistance(b.rotation[joint]),
          (a.translation[joint] - b.translation[joint]).norm(), (a.scale[joint] - b.scale[joint]).norm()};
}

// How far joints are from their parents: what a shift of one is small against.
double reach_of(const LocalPose& pose) {
  double reach = 0;
  for (const Vector3& t : pose.translation) reach = std::max(reach, t.norm());
  return reach;
}

// The last of the samples is the clip's end, and is left out of a loop: no joint may then step further over
// the seam than anywhere else.
bool leads_on(const std::vector<LocalPose>& samples) {
  constexpr double kRoom = 1.05, kLeastTurn_rad = 0.01, kLeastShift = 1e-3, kLeastStretch = 0.01;
  const LocalPose &first = samples.front(), &last = samples[samples.size() - 2];
  const double least_shift = kLeastShift * reach_of(first);
  for (size_t j = 0; j < first.rotation.size(); ++j) {
    Step largest{kLeastTurn_rad, least_shift, kLeastStretch};
    for (size_t i = 1; i < samples.size(); ++i) {
      const Step step = step_of(samples[i - 1], samples[i], j);
      largest = {std::max(largest.turn_rad, step.turn_rad), std::max(largest.shift, step.shift),
                 std::max(largest.stretch, step.stretch)};
    }
    const Step seam = step_of(last, first, j);
    if (seam.turn_rad > kRoom * largest.turn_rad || seam.shift > kRoom * largest.shift ||
        seam.stretch > kRoom * largest.stretch)
      return false;
  }
  return true;
}

}  // namespace

SmoothClip::SmoothClip(const Character& character, const Clip& clip)
    : duration_s_(std::max(clip.duration_s, 1 / kSampleRateHz)) {
  const auto count = std::max<size_t>(4, static_cast<size_t>(std::lround(duration_s_ * kSampleRateHz)));
  for (size_t i = 0; i <= count; ++i) {
    const double t = clip.duration_s * static_cast<double>(i) / static_cast<double>(count);
    samples_.push_back(local_pose(character, sinew::baker::joint_matrices(character, &clip, t)));
  }
  loops_ = leads_on(samples_);
  if (loops_) samples_.pop_back();
}

// Beyond the ends of a clip that does not loop, as on the way back.
const LocalPose& SmoothClip::sample(long i) const {
  const auto count = static_cast<long>(samples_.size());
  if (loops_) return samples_[static_cast<size_t>(((i % count) + count) % count)];
  const long last = count - 1, folded = std::abs(i) % (2 * last);
  return samples_[static_cast<size_t>(std::min(folded, 2 * last - folded))];
}

LocalPose SmoothClip::at(double place_s) const {
  const auto periods = static_cast<double>(loops_ ? samples_.size() : samples_.size() - 1);
  const double place = place_s / duration_s_ * periods, first = std::floor(place);
  const double u = place - first, v = 1 - u;
  const std::array<double, 4> weight = {v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6,
                                        (4 - 6 * v * v + 3 * v * v * v) / 6, u * u * u / 6};
  std::array<const LocalPose*, 4> near{};
  for (size_t k = 0; k < 4; ++k) near[k] = &sample(static_cast<long>(first) + static_cast<long>(k) - 1);
  return weighted_sum(near, weight);
}

double run_up_s(double t_s) {
  const double x = t_s / kRunUp_s;
  if (x <= 0) return 0;
  if (x >= 1) return t_s - kRunUp_s / 2;
  return kRunUp_s * x * x * x * x * (2.5 + x * (x - 3));
}

double run_s(double t_s, double length_s) { return run_up_s(t_s) - run_up_s(t_s - length_s); }

double ClipRun::place_s(double t_s) const {
  if (clip_->loops()) return start_s_ + speed_ * run_up_s(t_s);
  const double whole_s = clip_->duration_s() / speed_, first_s = whole_s - start_s_ / speed_;
  if (t_s < first_s + kRunUp_s) return start_s_ + speed_ * run_s(t_s, first_s);
  const double left_s = t_s - (first_s + kRunUp_s), there_s = whole_s + kRunUp_s;
  const double ways = std::floor(left_s / there_s);
  const double gone_s = speed_ * run_s(left_s - ways * there_s, whole_s);
  return std::fmod(ways, 2) == 0 ? clip_->duration_s() - gone_s : gone_s;
}

}  // namespace sinew::baker
