// motions.cpp  Poses by formula and by clip.
#include "baker/audit/motions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr double kGravity = 9.80665, kTau = 2 * M_PI;
constexpr double kAfter_s = 1;  // of rest after a motion: what overshoots does so at once
constexpr double kHuman_m = 1.7;

std::vector<Matrix34> bind_pose(const pack::PackView& character) {
  using RowMajor = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
  std::vector<Matrix34> bind;
  for (const pack::JointRecord& joint : character.joints) {
    Eigen::Transform<float, 3, Eigen::Affine> inverse = Eigen::Transform<float, 3, Eigen::Affine>::Identity();
    inverse.affine() = Eigen::Map<const RowMajor>(joint.inverse_bind);
    Eigen::Map<RowMajor>(&bind.emplace_back().m[0][0]) = inverse.inverse().affine();
  }
  return bind;
}

// 0 to 1, with neither a step nor a kink.
double eased(double t) {
  const double u = std::clamp(t, 0.0, 1.0);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

AuditMotion of_root(const pack::PackView& character, std::string name, double moving_s, double resting_s,
                    std::function<void(double, RootTransform*)> root_at) {
  return {
      std::move(name), moving_s, resting_s,
      [bind = bind_pose(character), root_at](double t_s, std::span<Matrix34> joints, RootTransform* root) {
        std::ranges::copy(bind, joints.begin());
        root_at(t_s, root);
      }};
}

// Height of a jump: pushed off evenly, thrown, and caught as it was pushed off.
AuditMotion hop_motion(const pack::PackView& character) {
  const double height = character.character->height_m, rise = 0.4 * height;
  const double push_s = 0.12 * std::sqrt(height / kHuman_m);
  // The push rises by v push / 2 and the throw by v^2 / 2 g.
  const double speed =
      -kGravity * push_s / 2 + std::hypot(kGravity * push_s / 2, std::sqrt(2 * kGravity * rise));
  const double top_s = push_s + speed / kGravity;
  return of_root(character, "hop", 2 * top_s, kAfter_s, [=](double t_s, RootTransform* root) {
    const double t = std::min(t_s, std::max(0.0, 2 * top_s - t_s));  // it comes down as it went up
    const double thrown = std::max(0.0, t - push_s);
    const double pushed = std::min(t, push_s);
    root->position_m[1] =
        speed * pushed * pushed / (2 * push_s) + speed * thrown - kGravity * thrown * thrown / 2;
  });
}

// Two heights a second, and three steps a second that bob by 3 % of the height; stops in a fifth of a second.
AuditMotion run_motion(const pack::PackView& character) {
  const double height = character.character->height_m, unit_s = std::sqrt(height / kHuman_m);
  const double start_s = 0.4 * unit_s, run_s = 1.6 * unit_s, stop_s = 0.2 * unit_s;
  const double speed = 2 * height / unit_s;
  return of_root(character, "run and stop", run_s + stop_s, kAfter_s, [=](double t_s, RootTransform* root) {
    const auto ramped = [](double t, double over) {  // the integral of t / over, held at 1
      return t < over ? t * t / (2 * over) : t - over / 2;
    };
    const double t = std::max(0.0, t_s - run_s);
    root->position_m[2] = speed * (ramped(t_s, start_s) - ramped(t, stop_s));
    const double strength = eased(t_s / start_s) * (1 - eased(t / stop_s));
    root->position_m[1] = 0.015 * height * strength * (1 - std::cos(kTau * 3 * t_s / unit_s));
  });
}

AuditMotion spin_motion(const pack::PackView& character) {
  const double turn_s = 1.2 * std::sqrt(character.character->height_m / kHuman_m);
  return of_root(character, "spin", turn_s, kAfter_s, [=](double t_s, RootTransform* root) {
    const double half = 0.5 * kTau * eased(t_s / turn_s);
    root->rotation_xyzw[1] = static_cast<float>(std::sin(half));
    root->rotation_xyzw[3] = static_cast<float>(std::cos(half));
  });
}

std::span<const float> frame_of(const pack::PackView& character, const pack::ClipRecord& clip,
                                uint32_t frame) {
  const size_t floats = 12 * character.joints.size();
  return character.clip_frames.subspan((size_t{clip.first_frame} + frame) * floats, floats);
}

double seconds_of(const pack::ClipRecord& clip) {
  return (clip.frame_count - 1) / static_cast<double>(clip.rate_hz);
}

}  // namespace

AuditMotion bob_motion(const pack::PackView& character, double moving_s, double resting_s) {
  constexpr double kRate_hz = 2, kEase_s = 0.5, kOfHeight = 0.05;
  const double amplitude_m = kOfHeight * static_cast<double>(character.character->height_m);
  AuditMotion bob = of_root(character, "bob", moving_s, resting_s, [=](double t_s, RootTransform* root) {
    const double strength = eased(t_s / kEase_s) * (1 - eased((t_s - moving_s + kEase_s) / kEase_s));
    root->position_m[1] = amplitude_m * strength * std::sin(kTau * kRate_hz * t_s);
  });
  bob.is_everyday = true;
  return bob;
}

std::vector<AuditMotion> root_motions(const pack::PackView& character) {
  return {hop_motion(character), run_motion(character), spin_motion(character)};
}

AuditMotion clip_motion(const pack::PackView& character, size_t index) {
  const pack::ClipRecord& clip = character.clips[index];
  return {std::string("clip ") + pack::string_at(character, clip.name), seconds_of(clip), 0,
          [&character, &clip](double t_s, std::span<Matrix34> joints, RootTransform*) {
            const double place = std::min(t_s, seconds_of(clip)) * static_cast<double>(clip.rate_hz);
            const uint32_t frame = std::min(static_cast<uint32_t>(place), clip.frame_count - 1);
            const uint32_t next = std::min(frame + 1, clip.frame_count - 1);
            const auto share = static_cast<float>(place - frame);
            const std::span<const float> a = frame_of(character, clip, frame),
                                         b = frame_of(character, clip, next);
            float* out = &joints[0].m[0][0];
            for (size_t i = 0; i < a.size(); ++i) out[i] = a[i] + share * (b[i] - a[i]);
          },
          true};
}

std::vector<AuditMotion> audit_motions(const pack::PackView& character) {
  constexpr double kBob_s = 4, kRest_s = 60;
  std::vector<AuditMotion> motions = root_motions(character);
  for (size_t clip = 0; clip < character.clips.size(); ++clip)
    motions.push_back(clip_motion(character, clip));
  motions.push_back(bob_motion(character, kBob_s, kRest_s));
  return motions;
}

size_t liveliest_clip(const pack::PackView& character) {
  size_t best = 0;
  double most = -1;
  for (size_t c = 0; c < character.clips.size(); ++c) {
    const pack::ClipRecord& clip = character.clips[c];
    double travel = 0;
    for (uint32_t frame = 1; frame < clip.frame_count; ++frame) {
      const std::span<const float> a = frame_of(character, clip, frame - 1),
                                   b = frame_of(character, clip, frame);
      for (size_t i = 3; i < a.size(); i += 4) travel += std::abs(double{b[i]} - double{a[i]});
    }
    const double speed = travel / std::max(seconds_of(clip), 1.0);
    if (speed > most) most = speed, best = c;
  }
  return best;
}

}  // namespace sinew::baker
