// bullet_world.hpp  A Bullet world as an engine has it, with what keeps it alive.
#pragma once
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

namespace sinew::test {

class BulletWorld {
 public:
  explicit BulletWorld(const btVector3& gravity_m_s2 = {0, 0, 0}) { world.setGravity(gravity_m_s2); }
  ~BulletWorld() {
    while (world.getNumCollisionObjects() > 0)
      world.removeCollisionObject(world.getCollisionObjectArray()[0]);
  }

  template <class Shape, class... Arguments>
  Shape* shape(Arguments&&... arguments) {
    auto made = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
    Shape* out = made.get();
    shapes_.push_back(std::move(made));
    return out;
  }

  // Mass 0: static.
  btRigidBody* body(btCollisionShape* shape, const btTransform& at = btTransform::getIdentity(),
                    float mass_kg = 0, int group = 1, int mask = -1) {
    btVector3 inertia(0, 0, 0);
    if (mass_kg > 0) shape->calculateLocalInertia(mass_kg, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass_kg, nullptr, shape, inertia));
    btRigidBody* out = bodies_.back().get();
    out->setWorldTransform(at);
    out->setInterpolationWorldTransform(at);
    world.addRigidBody(out, group, mask);
    return out;
  }
  btRigidBody* body(btCollisionShape* shape, const btVector3& at, float mass_kg = 0) {
    return body(shape, btTransform(btQuaternion::getIdentity(), at), mass_kg);
  }
  // Moved by the engine: mass 0 and kinematic.
  btRigidBody* kinematic(btCollisionShape* shape, const btTransform& at = btTransform::getIdentity()) {
    btRigidBody* out = body(shape, at);
    world.removeRigidBody(out);
    out->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    out->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(out);
    return out;
  }

  // Vertices and indices stay here.
  btTriangleMesh* mesh(const std::vector<btVector3>& corners) {
    meshes_.push_back(std::make_unique<btTriangleMesh>());
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
      meshes_.back()->addTriangle(corners[i], corners[i + 1], corners[i + 2]);
    return meshes_.back().get();
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;

 public:
  btDiscreteDynamicsWorld world{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

}  // namespace sinew::test
