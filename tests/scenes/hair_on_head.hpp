// hair_on_head.hpp  A thousand strands rooted on a head that stands or turns: sphere, neck and shoulders.
#pragma once
#include <Eigen/Geometry>

#include "math/turn_between.hpp"
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"
#include "tests/rods/rod_scenes.hpp"
#include "tests/scenes/hair.hpp"

namespace sinew::test {

// 16 segments of 1.5 cm, a millimetre thin; combed away from the crown, roots evenly down to the ears.
class HairOnHead {
 public:
  static constexpr float kHead_m = 0.1f;

  explicit HairOnHead(uint32_t strands, uint32_t segments = 16, float young_pa = 1e6f) {
    const Segments one = straight_rod({.segments = segments,
                                       .young_pa = young_pa,
                                       .length_m = 0.015 * segments,
                                       .radius_m = 0.001f,
                                       .torsion_pa = young_pa});
    for (uint32_t n = 0; n < strands; ++n) strands_.push_back(strand(one, n, strands));
  }

  const std::vector<Segments>& strands() const { return strands_; }

  rods::RodBatch batch(const rods::RodSettings& settings) const { return batch_of(strands_, settings); }

  // Where the head has turned to, about the vertical: still, or to and fro by 0.8 rad every two seconds.
  static double angle(double time_s, bool turning) { return turning ? 0.8 * std::sin(M_PI * time_s) : 0; }

  // Roots to where the head is at time_s.
  void turn(rods::RodBatch* batch, double time_s) const {
    const Eigen::Quaterniond by(Eigen::AngleAxisd(angle(time_s, true), Eigen::Vector3d::UnitY()));
    for (uint32_t n = 0; n < strands_.size(); ++n) {
      const rods::SegmentDef& root = strands_[n][0];
      const float* q = root.orientation;
      const Eigen::Vector3d place = by * Eigen::Vector3d(root.position_m);
      const Eigen::Quaterniond turn =
          by * Eigen::Quaternionf(q[3], q[0], q[1], q[2]).cast<double>().normalized();
      rods::SegmentPose pose;
      for (int k = 0; k < 3; ++k) pose.position_m[k] = place[k];
      for (int k = 0; k < 4; ++k) pose.orientation[k] = static_cast<float>(turn.coeffs()[k]);
      (void)batch->set_target(n, 0, pose);
    }
  }

  // Head, neck and shoulders; they turn with velocity_rad_s about the vertical.
  static Status put(rods::RodCollider* collider, double velocity_rad_s = 0) {
    const rods::ObstacleMotion motion = {.angular_rad_s = {0, static_cast<float>(velocity_rad_s), 0}};
    const rods::Sphere head = {.radius_m = kHead_m, .friction = 0.3f, .motion = motion};
    const rods::Capsule body[2] = {
        {.ends_m = {{0, 0, 0}, {0, -0.2, 0}}, .radius_m = 0.05f, .friction = 0.3f, .motion = motion},
        {
            .ends_m = {{-0.15, -0.24, 0}, {0.15, -0.24, 0}},
            .radius_m = 0.06f,
            .friction = 0.3f,
        }};
    const Status status = collider->set_spheres({&head, 1});
    return status.ok() ? collider->set_capsules(body) : status;
  }

 private:
  // The n-th of so many, on a spiral from the crown down.
  static Segments strand(const Segments& one, uint32_t n, uint32_t of) {
    const double height = 1 - 1.1 * (n + 0.5) / of, turn = 2.399963229728653 * n;  // the golden angle
    const double flat = std::sqrt(1 - height * height);
    const Eigen::Vector3d normal(flat * std::cos(turn), height, flat * std::sin(turn));
    const Eigen::Vector3d down(height * std::cos(turn), -flat, height * std::sin(turn));
    const Eigen::Vector3d along = (normal + 1.2 * down).normalized();
    Segments out = one;
    turn_strand(&out, core::turn_between(Eigen::Vector3d::UnitX(), along));
    const double longer = 1 + 0.05 * scattered(n, 0);
    for (SegmentDef& s : out) {
      s.damping_s = 0.01f;
      s.length_m *= static_cast<float>(longer);
      for (int k = 0; k < 3; ++k)
        s.position_m[k] = longer * s.position_m[k] + static_cast<double>(kHead_m) * normal[k];
    }
    return out;
  }

  std::vector<Segments> strands_;
};

}  // namespace sinew::test
