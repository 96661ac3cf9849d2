// boxes.hpp  Boxes that move as told, in a Bullet world: what a creature runs into.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "baker/render/mesh.hpp"
#include "sinew/bullet.hpp"

namespace sinew::sample {

struct Box {
  Eigen::Vector3d half_m;
  std::function<Eigen::Vector3d(double t_s)> middle_m;
  render::Rgb color = {0.55f, 0.38f, 0.22f};
};

class Boxes {
 public:
  // Throws std::runtime_error with what BulletContacts refused.
  explicit Boxes(std::vector<Box> boxes);
  ~Boxes();
  Boxes(const Boxes&) = delete;
  Boxes& operator=(const Boxes&) = delete;

  // To where they are at t_s; their velocity is what brings them there from where they were.
  void move_to(double t_s, double dt_s);
  ContactSource* source() const;
  BulletReport report() const;
  // How deep a point is inside of any of them, 0 outside; by the boxes themselves, not by Bullet.
  double depth_m(const Eigen::Vector3d& point) const;
  void add_to(render::Mesh* mesh) const;
  // Their edges alone, so that one sees into them.
  void add_edges_to(render::Mesh* mesh) const;

 private:
  struct Bodies;
  std::vector<Box> boxes_;
  std::vector<Eigen::Vector3d> middles_;
  std::unique_ptr<Bodies> bodies_;
};

}  // namespace sinew::sample
