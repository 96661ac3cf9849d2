// test_soft_parts.cpp  Soft blocks against Bullet's bodies, through a world's own step.
#include "tests/scenes/bullet_world.hpp"

#include <cmath>

#include "sinew/bullet.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kRadius_m = 0.04, kHalfLength_m = 0.3, kHeight_m = 0.5;

// A bar along z, across the block's soft half; moved along x by the engine.
struct Bar {
  BulletWorld world;
  BulletContacts contacts;
  btRigidBody* body = nullptr;
  double at_x_m = 0.3;

  Bar() {
    body = world.kinematic(world.shape<btCapsuleShapeZ>(btScalar(kRadius_m), btScalar(2 * kHalfLength_m)));
    REQUIRE(BulletContacts::create({.world = &world.world}, &contacts).ok());
  }
  void move_to(double x_m) {
    const btTransform to(btQuaternion::getIdentity(), btVector3(btScalar(x_m), btScalar(kHeight_m), 0));
    const btVector3 velocity(btScalar((x_m - at_x_m) / kFrame_s), 0, 0);
    at_x_m = x_m;
    body->setWorldTransform(to);
    body->setInterpolationWorldTransform(to);
    body->setLinearVelocity(velocity);
    body->setInterpolationLinearVelocity(velocity);
    world.world.updateSingleAabb(body);
  }
  // No vertex lies beyond its ends.
  double deepest_m(const std::vector<float>& places) const {
    double most = 0;
    for (size_t v = 0; v < places.size(); v += 3)
      most = std::max(most, kRadius_m - std::hypot(static_cast<double>(places[v]) - at_x_m,
                                                   static_cast<double>(places[v + 1]) - kHeight_m));
    return most;
  }
};

}  // namespace

TEST_CASE("a_thin_bar_in_the_middle_of_flesh_has_nothing_inside_in_any_tick") {
  constexpr double kRounding_m = 2e-5;  // Bullet's places are floats, its touches a hundredth of a millimetre
  for (const double middle_m : {0.1, 0.05, 0.0}) {
    Bar bar;
    Stage stage(0);
    InstanceId made;
    REQUIRE(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &bar.contacts}}, &made)
                .ok());
    stage.blocks.push_back(made);
    for (int f = 0; f <= 90; ++f) {
      bar.move_to(0.3 + (middle_m - 0.3) * std::min(f, 30) / 30);
      stage.step([](double) { return scenes::bind_pose(); }, kFrame_s);
      CHECK(bar.deepest_m(stage.read()) < kRounding_m);
    }
    CHECK(stage.report().vertices_touched > 0);
    CHECK(stage.report().restarts == 0);
  }
}
