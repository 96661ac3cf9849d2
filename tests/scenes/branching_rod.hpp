// branching_rod.hpp  Trees of rods that grow by a rule: for tests, benches and samples.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "math/turn_between.hpp"
#include "rods/strand.hpp"

namespace sinew::test {

// Branches of one order: the trunk, what leaves it, what leaves those.
struct BranchOrder {
  uint32_t segments;  // of each branch, 1 or more
  uint32_t branches;  // of the next order that leave each one, over its outer part
  double length_m;    // of the lowest on its parent; higher ones are shorter, to half of it
  double radius_m;    // where it begins; at its end 0.45 of it
  double lean_rad;    // away from its parent
};

struct Timber {
  double young_pa = 3e9, torsion_pa = 1.2e9;  // green wood, soft
  float density_kg_m3 = 800;
  float damping_s = 0.012f;
};

struct BranchingRod {
  std::vector<rods::SegmentDef> segments;
  std::vector<uint32_t> order;  // of each segment: 0 is the trunk
};

// A young tree, 3.4 m high: 14 + 9 * 7 + 54 * 5 + 216 * 4 = 1,211 segments.
inline constexpr BranchOrder kYoungTree[] = {
    {14, 9, 2.7, 0.036, 0}, {7, 6, 1.35, 0.015, 0.95}, {5, 4, 0.62, 0.007, 0.85}, {4, 0, 0.32, 0.0035, 0.75}};

// Grows from the origin, its first segment fixed. The same tree for the same seed.
class TreeGrower {
 public:
  TreeGrower(std::span<const BranchOrder> orders, const Timber& timber, uint32_t seed = 1,
             const Eigen::Vector3d& up = Eigen::Vector3d::UnitY())
      : orders_(orders), timber_(timber), random_(seed), up_(up) {}

  BranchingRod grow() {
    branch(0, rods::kNoParent, Vector::Zero(), core::turn_between(Vector::UnitZ(), up_), 1);
    made_.segments[0].fixed = true;
    return std::move(made_);
  }

 private:
  using Vector = Eigen::Vector3d;
  struct Tip {  // where a branch may leave
    uint32_t segment;
    Vector end;
    Eigen::Quaterniond turn;
    double share;  // of its parent's length that lies below
  };

  void branch(uint32_t order, uint32_t parent, Vector at, Eigen::Quaterniond turn, double scale) {
    const BranchOrder& rule = orders_[order];
    const double length = scale * rule.length_m / rule.segments;
    std::vector<Tip> tips;
    for (uint32_t i = 0; i < rule.segments; ++i) {
      const double share = (i + 0.5) / rule.segments;
      turn = bent(order, turn);
      const auto index = static_cast<uint32_t>(made_.segments.size());
      add(order, parent, at + 0.5 * length * axis(turn), turn, length,
          rule.radius_m * (0.6 + 0.4 * scale) * (1 - 0.55 * share));
      at += length * axis(turn);
      parent = index;
      if (share > 0.25) tips.push_back({index, at, turn, share});
    }
    for (uint32_t k = 0; k < rule.branches; ++k) leave(order, k, tips);
  }

  // Round the branch by the golden angle, from its lower end to its tip.
  void leave(uint32_t order, uint32_t k, const std::vector<Tip>& tips) {
    const Tip& tip = tips[k * tips.size() / orders_[order].branches];
    const double around = 2.399963 * k + 0.6 * uniform();
    const double lean = orders_[order + 1].lean_rad * (0.85 + 0.3 * uniform());
    const Vector aim = tip.turn * (Eigen::AngleAxisd(around, Vector::UnitZ()) *
                                   (Eigen::AngleAxisd(lean, Vector::UnitX()) * Vector::UnitZ()));
    // The smallest turn there: a joint whose rest twists by half a turn has no stiffness.
    const Eigen::Quaterniond turn = core::turn_between(axis(tip.turn), aim) * tip.turn;
    branch(order + 1, tip.segment, tip.end, turn, (1.15 - 0.65 * tip.share) * (0.9 + 0.2 * uniform()));
  }

  // A little crooked, and towards the light.
  Eigen::Quaterniond bent(uint32_t order, const Eigen::Quaterniond& turn) {
    const double crooked = order == 0 ? 0.05 : 0.10, lift = order == 0 ? 0.02 : 0.07;
    const Vector aim = axis(turn) + crooked * Vector(signed_one(), signed_one(), signed_one()) + lift * up_;
    return core::turn_between(axis(turn), aim) * turn;
  }

  void add(uint32_t order, uint32_t parent, const Vector& middle, const Eigen::Quaterniond& turn,
           double length, double radius) {
    rods::SegmentDef s;
    const Eigen::Vector4d q = turn.normalized().coeffs();
    for (int k = 0; k < 3; ++k) s.position_m[k] = middle[k];
    for (int k = 0; k < 4; ++k) s.orientation[k] = static_cast<float>(q[k]);
    s.length_m = static_cast<float>(length);
    s.radius_m = static_cast<float>(radius);
    s.density_kg_m3 = timber_.density_kg_m3;
    s.parent = parent;
    s.young_modulus_pa = static_cast<float>(timber_.young_pa);
    s.torsion_modulus_pa = static_cast<float>(timber_.torsion_pa);
    s.damping_s = timber_.damping_s;
    made_.segments.push_back(s);
    made_.order.push_back(order);
  }

  static Vector axis(const Eigen::Quaterniond& turn) { return turn * Vector::UnitZ(); }
  // Not std::uniform_real_distribution, which differs between standard libraries.
  double uniform() { return static_cast<double>(random_()) / 4294967296.0; }
  double signed_one() { return 2 * uniform() - 1; }

  std::span<const BranchOrder> orders_;
  Timber timber_;
  std::mt19937 random_;
  Vector up_;
  BranchingRod made_;
};

// A tree of exactly this many segments, 4 or more: a trunk of two fifths, three branches, six from 50 on.
// Segments of 5 cm, 12 mm thick and less; it grows along +y, or -y for up -1.
inline std::vector<rods::SegmentDef> forked_rod(uint32_t count, double young_pa, double up = 1) {
  const uint32_t branches = count < 10   ? 1
                            : count < 50 ? 3
                                         : 6,
                 trunk = count - branches * (count * 3 / 5 / branches);
  const uint32_t each = (count - trunk) / branches;
  const BranchOrder orders[] = {{trunk, branches, 0.05 * trunk, 0.006, 0},
                                {each, 0, 0.05 * each, 0.004, 0.9}};
  const Timber timber{.young_pa = young_pa, .torsion_pa = young_pa, .density_kg_m3 = 1000, .damping_s = 0};
  return TreeGrower(orders, timber, 1, up * Eigen::Vector3d::UnitY()).grow().segments;
}

}  // namespace sinew::test
