// smooth_clip.hpp  A clip as truth samples it, between ticks too: without kinks, and nowhere faster than it
// is.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "baker/truth/motion/local_pose.hpp"

namespace sinew::baker {

// Poses whose second derivative is continuous: a uniform cubic B-spline over samples at 60 Hz, which rounds
// the kinks of linear and step keys. A clip whose last pose leads on to its first is a loop; any other is
// played to its end and back.
class SmoothClip {
 public:
  SmoothClip(const Character& character, const Clip& clip);
  LocalPose at(double place_s) const;  // any place in a loop; 0 .. duration_s() in another
  double duration_s() const { return duration_s_; }
  bool loops() const { return loops_; }

 private:
  const LocalPose& sample(long i) const;

  double duration_s_;
  bool loops_;
  std::vector<LocalPose> samples_;  // of a loop, without its end
};

// Half a second in which speed is reached, and in which it is lost before an end.
inline constexpr double kRunUp_s = 0.5;

// Where time that runs up to full pace from 0 on has come to, seconds: the integral of the ease.
double run_up_s(double t_s);
// The same, and slowed down to rest at length_s + kRunUp_s, having come by length_s.
double run_s(double t_s, double length_s);

// A clip that starts to play, from a place in it and at a speed: at rest at time 0.
class ClipRun {
 public:
  ClipRun(std::shared_ptr<const SmoothClip> clip, double start_s, double speed)
      : clip_(std::move(clip)), start_s_(start_s), speed_(speed) {}
  LocalPose at(double t_s) const { return clip_->at(place_s(t_s)); }

 private:
  double place_s(double t_s) const;

  std::shared_ptr<const SmoothClip> clip_;
  double start_s_, speed_;
};

}  // namespace sinew::baker
