// limbs.hpp  How deep points are inside of a character's own limbs.
#pragma once
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "sinew/types.hpp"

namespace sinew::sample {

// The capsules about the bones whose names begin so.
class Limbs {
 public:
  Limbs(const demo::CharacterFile& character, std::span<const std::string> names);
  // In the character's space.
  void move_to(std::span<const Matrix34> joints);
  // 0 outside.
  double depth_m(const Eigen::Vector3d& point) const;

 private:
  struct Capsule {
    Eigen::Vector3d from, to;
    double radius_m;
  };
  const demo::CharacterFile& character_;
  std::vector<const pack::ProxyRecord*> records_;
  std::vector<Capsule> capsules_;
};

}  // namespace sinew::sample
