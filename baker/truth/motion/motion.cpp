// motion.cpp  What moves a character while the truth is simulated: a clip, and a root motion on top.
#include "baker/truth/motion/motion.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "baker/truth/motion/gesture.hpp"
#include "baker/truth/motion/local_pose.hpp"
#include "baker/truth/motion/smooth_clip.hpp"

namespace sinew::baker {
namespace {

constexpr double kStill_s = 0.1;   // at rest at the start of random and shaken motions
constexpr double kRamp_s = 0.35;   // from stillness to full motion and back
constexpr double kLength_s = 600;  // random motions stand still afterwards

// A sum of sines along fixed directions, zero in value at time 0.
struct Sway {
  struct Wave {
    Vector3 amplitude;
    double radians_per_s, phase;
  };
  std::vector<Wave> waves;

  Vector3 at(double t_s) const {
    Vector3 sum = Vector3::Zero();
    for (const Wave& w : waves)
      sum += w.amplitude * (std::sin(w.radians_per_s * t_s + w.phase) - std::sin(w.phase));
    return sum;
  }
};

Sway::Wave wave_of_acceleration(Random& random, const Vector3& acceleration, double low_hz, double high_hz) {
  const double w = kTau * low_hz * std::pow(high_hz / low_hz, random.uniform(0, 1));
  return {acceleration / (w * w), w, random.uniform(0, kTau)};
}

// An interval of motion between two of stillness.
struct Bout {
  double start_s, end_s;
  double activity(double t_s) const {
    return ease((t_s - start_s) / kRamp_s) - ease((t_s - end_s) / kRamp_s);
  }
};

std::vector<Bout> draw_bouts(Random& random) {
  std::vector<Bout> bouts;
  for (double t = kStill_s; t < kLength_s;) {
    const double end = t + random.uniform(1.5, 4.0);
    bouts.push_back({t, end});
    t = end + kRamp_s + (random.chance(0.25) ? random.uniform(1.5, 2.5) : random.uniform(0.2, 1.0));
  }
  return bouts;
}

struct RootTrack {
  RootGestures gestures;
  Sway sway, rock;

  Matrix4 at(double t_s, double activity) const {
    const Vector3 lean = sum_of(gestures.tilts, t_s) + activity * rock.at(t_s);
    Matrix4 root = Matrix4::Identity();
    root.topLeftCorner<3, 3>() =
        (rotation_from_vector(sum_of(gestures.turns, t_s)) * rotation_from_vector(lean)).toRotationMatrix();
    root.topRightCorner<3, 1>() = sum_of(gestures.dashes, t_s) + activity * sway.at(t_s);
    return root;
  }
};

RootTrack draw_sway(Random& random, double strength) {
  RootTrack track;
  for (int k = 0; k < 3; ++k) {
    const Vector3 acceleration = strength * random.uniform(0.5, 6) * random.direction();
    track.sway.waves.push_back(wave_of_acceleration(random, acceleration, 0.5, 3));
    const Vector3 turning = strength * random.uniform(0.5, 4) * random.direction();
    track.rock.waves.push_back(wave_of_acceleration(random, turning, 0.5, 3));
  }
  return track;
}

// A clip in a bout: it runs while that lasts, and begins where the last one came to rest.
struct BoutClip {
  double start_s, length_s;
  ClipRun run;
  PoseOffset from_last;  // from where this run begins to where the last one ended
  double fade_s = 0;     // over which that is given up

  LocalPose at(double t_s) const {
    const LocalPose pose = run.at(run_s(t_s - start_s, length_s));
    const double left = fade_s > 0 ? 1 - ease((t_s - start_s) / fade_s) : 0;
    return left > 0 ? moved_by(pose, from_last, left) : pose;
  }
};

// Time to give up an offset in: so that it takes no joint more than these accelerations.
double fade_of(const PoseOffset& offset, double strength) {
  constexpr double kEasePeak = 10 / std::numbers::sqrt3, kTurn_rad_per_s2 = 30, kShift_m_per_s2 = 10;
  constexpr double kShortest_s = 0.35, kLongest_s = 1.4;
  double largest = 0;
  for (size_t j = 0; j < offset.rotation.size(); ++j)
    largest = std::max({largest, offset.rotation[j].norm() / kTurn_rad_per_s2,
                        offset.translation[j].norm() / kShift_m_per_s2});
  return std::clamp(std::sqrt(kEasePeak * largest / strength), kShortest_s, kLongest_s);
}

std::vector<BoutClip> draw_clips(Random& random, const std::vector<std::shared_ptr<const SmoothClip>>& clips,
                                 const std::vector<Bout>& bouts, double strength) {
  std::vector<BoutClip> out;
  for (const Bout& bout : bouts) {
    if (clips.empty()) break;
    const auto& clip = clips[random.below(clips.size())];
    const double start_s = random.uniform(0, clip->duration_s());
    const ClipRun run(clip, start_s, std::sqrt(strength) * random.uniform(0.7, 1.4));
    BoutClip next{bout.start_s, bout.end_s - bout.start_s, run, {}};
    if (!out.empty()) {
      next.from_last = offset_between(run.at(0), out.back().at(bout.start_s));
      next.fade_s = fade_of(next.from_last, strength);
    }
    out.push_back(std::move(next));
  }
  return out;
}

std::vector<Sway> draw_joint_noise(Random& random, size_t joints, double strength) {
  std::vector<Sway> noise(joints);
  for (Sway& sway : noise) {
    for (int k = 0; k < 3; ++k) {
      const double hz = random.uniform(0.3, 3);
      const double angle = strength * random.uniform(0.02, 0.14) / (1 + hz * hz / 2);
      sway.waves.push_back({angle * random.direction(), kTau * hz, random.uniform(0, kTau)});
    }
  }
  return noise;
}

struct RandomTrack {
  Character character;
  LocalPose rest;
  std::vector<std::shared_ptr<const SmoothClip>> clips;
  std::vector<BoutClip> bout_clips;  // in order
  std::vector<Bout> bouts;
  std::vector<Sway> noise;
  JointGestures strikes;
  RootTrack root;

  LocalPose clip_pose(double t_s) const {
    if (bout_clips.empty()) return rest;
    const auto next = std::ranges::upper_bound(bout_clips, t_s, {}, &BoutClip::start_s);
    return next == bout_clips.begin() ? next->run.at(0) : (next - 1)->at(t_s);
  }

  double activity(double t_s) const {
    double sum = 0;
    for (const Bout& bout : bouts) {
      if (bout.start_s > t_s) break;
      sum += bout.activity(t_s);
    }
    return sum;
  }

  WorldPose at(double t_s) const {
    const double active = activity(t_s);
    LocalPose pose = clip_pose(t_s);
    for (size_t j = 0; j < noise.size(); ++j)
      pose.rotation[j] = pose.rotation[j] * rotation_from_vector(active * noise[j].at(t_s));
    for (size_t j = 0; j < strikes.size(); ++j)
      pose.rotation[j] = pose.rotation[j] * rotation_from_vector(sum_of(strikes[j], t_s));
    return {joint_matrices(character, pose), root.at(t_s, active)};
  }
};

LocalPose rest_pose(const Character& character) { return local_pose(character, bind_matrices(character)); }

// What posing needs of a character, without its mesh.
Character skeleton_of(const Character& character) {
  Character out;
  out.nodes = character.nodes;
  out.joint_node = character.joint_node;
  out.joint_parent = character.joint_parent;
  out.inverse_bind = character.inverse_bind;
  out.character_from_scene = character.character_from_scene;
  return out;
}

std::shared_ptr<RandomTrack> draw_track(Random& random, const Character& character, double strength,
                                        const std::vector<std::string>& held_out) {
  auto track = std::make_shared<RandomTrack>();
  track->character = skeleton_of(character);
  track->rest = rest_pose(character);
  for (const Clip& clip : character.clips)
    if (std::find(held_out.begin(), held_out.end(), clip.name) == held_out.end())
      track->clips.push_back(std::make_shared<const SmoothClip>(character, clip));
  track->bouts = draw_bouts(random);
  track->bout_clips = draw_clips(random, track->clips, track->bouts, strength);
  track->noise = draw_joint_noise(random, track->rest.rotation.size(), strength);
  track->root = draw_sway(random, strength);
  return track;
}

}  // namespace

Motion clip_motion(const Character& character, const Clip& clip, uint64_t seed, double strength) {
  Random random(seed);
  const double start_s = seed == 0 ? 0 : random.uniform(0, clip.duration_s);
  const double speed = std::sqrt(strength) * (seed == 0 ? 1 : random.uniform(0.75, 1.3));
  const auto skeleton = std::make_shared<const Character>(skeleton_of(character));
  const ClipRun run(std::make_shared<const SmoothClip>(*skeleton, clip), start_s, speed);
  return [=](double t_s) { return WorldPose{joint_matrices(*skeleton, run.at(t_s)), Matrix4::Identity()}; };
}

Motion shake_motion(const Character& character, uint64_t seed, double strength) {
  constexpr double kPeriod_s = 4, kMoving_s = 3;
  Random random(seed);
  double low = 1e30, high = -1e30;
  for (const Vector3& p : character.positions) low = std::min(low, p.y()), high = std::max(high, p.y());
  const double height = std::max(high - low, 1e-3);
  Sway sway, turn;
  for (int k = 0; k < 2; ++k) {
    sway.waves.push_back(
        {0.025 * height * strength * random.direction(), kTau * random.uniform(1.2, 2.6), 0});
    turn.waves.push_back({0.12 * strength * random.direction(), kTau * random.uniform(0.8, 1.8), 0});
  }
  const std::vector<Matrix4> rest = bind_matrices(character);
  return [=](double t_s) {
    const double in = t_s - kPeriod_s * std::floor(t_s / kPeriod_s);
    const double active = Bout{kStill_s, kMoving_s}.activity(in);
    return WorldPose{rest, RootTrack{{}, sway, turn}.at(t_s, active)};
  };
}

Motion random_motion(const Character& character, uint64_t seed, double strength,
                     const std::vector<std::string>& held_out) {
  Random random(seed);
  const auto track = draw_track(random, character, strength, held_out);
  for (const Bout& bout : track->bouts)
    draw_gestures(random, bout.start_s, bout.end_s, strength, &track->root.gestures);
  return [track](double t_s) { return track->at(t_s); };
}

Motion leap_motion(const Character& character, uint64_t seed, double strength,
                   const std::vector<std::string>& held_out) {
  Random random(~seed);
  const auto track = draw_track(random, character, strength, held_out);
  track->strikes.resize(character.joint_parent.size());
  for (const Bout& bout : track->bouts)
    draw_leaps(random, bout.start_s, bout.end_s, strength, character.joint_parent, &track->root.gestures,
               &track->strikes);
  put_in_order(&track->root.gestures.dashes);
  put_in_order(&track->root.gestures.tilts);
  for (std::vector<Gesture>& gestures : track->strikes) put_in_order(&gestures);
  return [track](double t_s) { return track->at(t_s); };
}

}  // namespace sinew::baker
