// boxes.cpp  see boxes.hpp.
#include "samples/contacts/boxes.hpp"

#include <btBulletDynamicsCommon.h>

#include <stdexcept>
#include <utility>

namespace sinew::sample {
namespace {

btVector3 vector(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

struct Body {
  btBoxShape shape;
  btRigidBody body;
  explicit Body(const Box& box)
      : shape(vector(box.half_m)), body(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape)) {
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
  }
};

void add_box(const Eigen::Vector3d& middle, const Eigen::Vector3d& half, const render::Rgb& color,
             render::Mesh* mesh) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double side = face % 2 ? 1 : -1;
    Eigen::Vector3d out = Eigen::Vector3d::Zero(), u = out, v = out;
    out[axis] = side, u[(axis + 1) % 3] = side, v[(axis + 2) % 3] = 1;
    const auto first = static_cast<uint32_t>(mesh->positions.size());
    for (const auto& [a, c] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      const Eigen::Vector3d corner = middle + half.cwiseProduct(out + double(a) * u + double(c) * v);
      mesh->positions.push_back(corner.cast<float>());
      mesh->normals.push_back(out.cast<float>());
      mesh->colors.push_back(color);
    }
    mesh->triangles.push_back({first, first + 1, first + 2});
    mesh->triangles.push_back({first, first + 2, first + 3});
  }
}

}  // namespace

struct Boxes::Bodies {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<Body>> bodies;
  BulletContacts contacts;
};

Boxes::Boxes(std::vector<Box> boxes) : boxes_(std::move(boxes)), bodies_(std::make_unique<Bodies>()) {
  for (const Box& box : boxes_) {
    bodies_->bodies.push_back(std::make_unique<Body>(box));
    bodies_->world.addRigidBody(&bodies_->bodies.back()->body);
    middles_.push_back(box.middle_m(0));
  }
  const Status status = BulletContacts::create({.world = &bodies_->world}, &bodies_->contacts);
  if (!status.ok()) throw std::runtime_error(status.message);
  move_to(0, 1);
}

Boxes::~Boxes() {
  for (const auto& body : bodies_->bodies) bodies_->world.removeRigidBody(&body->body);
}

void Boxes::move_to(double t_s, double dt_s) {
  for (size_t b = 0; b < boxes_.size(); ++b) {
    const Eigen::Vector3d before = std::exchange(middles_[b], boxes_[b].middle_m(t_s));
    btRigidBody& body = bodies_->bodies[b]->body;
    btTransform place = btTransform::getIdentity();
    place.setOrigin(vector(middles_[b]));
    body.setWorldTransform(place);
    body.setInterpolationWorldTransform(place);
    const btVector3 velocity = vector((middles_[b] - before) / dt_s);
    body.setLinearVelocity(velocity);
    body.setInterpolationLinearVelocity(velocity);
    bodies_->world.updateSingleAabb(&body);
  }
}

ContactSource* Boxes::source() const { return &bodies_->contacts; }
BulletReport Boxes::report() const { return bodies_->contacts.report(); }

double Boxes::depth_m(const Eigen::Vector3d& point) const {
  double deepest = 0;
  for (size_t b = 0; b < boxes_.size(); ++b) {
    const Eigen::Vector3d inside = boxes_[b].half_m - (point - middles_[b]).cwiseAbs();
    deepest = std::max(deepest, inside.minCoeff());
  }
  return deepest;
}

void Boxes::add_to(render::Mesh* mesh) const {
  for (size_t b = 0; b < boxes_.size(); ++b) add_box(middles_[b], boxes_[b].half_m, boxes_[b].color, mesh);
}

void Boxes::add_edges_to(render::Mesh* mesh) const {
  constexpr double kHalfWidth_m = 0.004;
  for (size_t b = 0; b < boxes_.size(); ++b) {
    const Eigen::Vector3d& half = boxes_[b].half_m;
    for (int edge = 0; edge < 12; ++edge) {
      const int along = edge / 4;
      Eigen::Vector3d middle = Eigen::Vector3d::Zero(), size = Eigen::Vector3d::Constant(kHalfWidth_m);
      size[along] = half[along];
      for (int side = 0; side < 2; ++side) {
        const int axis = (along + 1 + side) % 3;
        middle[axis] = (edge >> side & 1 ? 1 : -1) * (half[axis] - kHalfWidth_m);
      }
      add_box(middles_[b] + middle, size, boxes_[b].color, mesh);
    }
  }
}

}  // namespace sinew::sample
