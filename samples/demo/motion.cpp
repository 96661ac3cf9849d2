// motion.cpp  see motion.hpp.
#include "samples/demo/motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "samples/demo/pose_blend.hpp"

namespace sinew::demo {
namespace {

constexpr double kSpeedUp_s = 0.6;   // from rest to full speed
constexpr double kFade_s = 0.3;      // from clip to clip
constexpr double kShortest_s = 2.5;  // a clip plays at least this long before the next

// Time in the motion: starts at rest and reaches full speed smoothly, so that the start itself shakes
// nothing.
double eased_time(double t_s) {
  const double u = std::min(t_s / kSpeedUp_s, 1.0);
  return kSpeedUp_s * (u * u * u - 0.5 * u * u * u * u) + std::max(0.0, t_s - kSpeedUp_s);
}

double smooth_step(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

class ClipMotion final : public Motion {
 public:
  ClipMotion(const CharacterFile& character, std::vector<size_t> clips) : character_(character) {
    for (const size_t clip : clips) {
      const double length = std::max(duration_s(clip), 1.0 / character.view.clips[clip].rate_hz);
      const double plays = clips.size() == 1 ? 1 : std::ceil(kShortest_s / length);
      parts_.push_back({clip, total_s_, plays * length});
      total_s_ += parts_.back().length_s;
    }
  }

  void pose_at(double t_s, std::span<Matrix34> joints, RootTransform* root) const override {
    *root = {};
    const double t = eased_time(t_s);
    const size_t index = part_at(t);
    const double into = std::fmod(t, total_s_) - parts_[index].start_s;
    sample(parts_[index].clip, into, joints);
    if (parts_.size() == 1 || into >= kFade_s || t < kFade_s) return;
    const Part& before = parts_[(index + parts_.size() - 1) % parts_.size()];
    std::vector<Matrix34> last(joints.size());
    sample(before.clip, before.length_s + into, last);
    mix_far(character_.view.joints, last, joints, static_cast<float>(smooth_step(into / kFade_s)), joints);
  }

  std::string name_at(double t_s) const override {
    return character_.clip_name(parts_[part_at(eased_time(t_s))].clip);
  }

 private:
  struct Part {
    size_t clip;
    double start_s, length_s;
  };

  double duration_s(size_t clip) const {
    const pack::ClipRecord& record = character_.view.clips[clip];
    return (record.frame_count - 1) / static_cast<double>(record.rate_hz);
  }

  size_t part_at(double t) const {
    const double place = std::fmod(t, total_s_);
    size_t index = 0;
    while (index + 1 < parts_.size() && parts_[index + 1].start_s <= place) ++index;
    return index;
  }

  void sample(size_t clip, double t_s, std::span<Matrix34> joints) const {
    const pack::ClipRecord& record = character_.view.clips[clip];
    const double length = duration_s(clip);
    const double place = length > 0 ? std::fmod(t_s, length) * static_cast<double>(record.rate_hz) : 0;
    const uint32_t frame = std::min(static_cast<uint32_t>(place), record.frame_count - 1);
    const uint32_t next = std::min(frame + 1, record.frame_count - 1);
    mix_near(frame_of(record, frame), frame_of(record, next), static_cast<float>(place - frame), joints);
  }

  std::span<const float> frame_of(const pack::ClipRecord& record, uint32_t frame) const {
    const size_t floats = 12 * character_.view.joints.size();
    return character_.view.clip_frames.subspan((size_t{record.first_frame} + frame) * floats, floats);
  }

  const CharacterFile& character_;
  std::vector<Part> parts_;
  double total_s_ = 0;
};

// The joints rest; the root goes to and fro, turns and bobs, in proportion to the character's height, with a
// pause in each round.
class RootShake final : public Motion {
 public:
  explicit RootShake(const CharacterFile& character) : height_m_(character.view.character->height_m) {
    for (const pack::JointRecord& joint : character.view.joints) {
      Eigen::Transform<float, 3, Eigen::Affine> inverse =
          Eigen::Transform<float, 3, Eigen::Affine>::Identity();
      inverse.affine() = Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(joint.inverse_bind);
      Matrix34 bind;
      Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&bind.m[0][0]) = inverse.inverse().affine();
      bind_.push_back(bind);
    }
  }

  void pose_at(double t_s, std::span<Matrix34> joints, RootTransform* root) const override {
    std::copy(bind_.begin(), bind_.end(), joints.begin());
    constexpr double kTau = 6.283185307179586, kRound_s = 4;
    const double t = eased_time(t_s), place = std::fmod(t, kRound_s);
    const double strength = smooth_step(place / 0.5) * (1 - smooth_step((place - 2.6) / 0.5));
    const double turn = 0.35 * strength * std::sin(kTau * 1.3 * place);
    *root = {.position_m = {0.10 * height_m_ * strength * std::sin(kTau * 1.7 * place),
                            0.06 * height_m_ * strength * (1 - std::cos(kTau * 2.1 * place)), 0},
             .rotation_xyzw = {0, static_cast<float>(std::sin(turn / 2)), 0,
                               static_cast<float>(std::cos(turn / 2))}};
  }

  std::string name_at(double) const override { return "built-in shake"; }

 private:
  double height_m_;
  std::vector<Matrix34> bind_;
};

std::vector<size_t> chosen_clips(const CharacterFile& character, const std::string& name) {
  std::vector<size_t> out;
  std::string known;
  for (size_t clip = 0; clip < character.view.clips.size(); ++clip) {
    const std::string clip_name = character.clip_name(clip);
    if (name.empty() || name == clip_name || clip_name.ends_with("|" + name)) out.push_back(clip);
    known += (known.empty() ? "" : ", ") + clip_name;
  }
  if (out.empty() && !name.empty()) {
    throw baker::BadInput(character.path + ": no clip '" + name + "'; it has " +
                          (known.empty() ? "none" : known));
  }
  return out;
}

}  // namespace

std::unique_ptr<Motion> make_motion(const CharacterFile& character, const std::string& clip) {
  std::vector<size_t> clips = chosen_clips(character, clip);
  if (clips.empty()) return std::make_unique<RootShake>(character);
  return std::make_unique<ClipMotion>(character, std::move(clips));
}

}  // namespace sinew::demo
