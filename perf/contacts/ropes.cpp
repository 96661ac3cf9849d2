// ropes.cpp  Ropes of Sinew's rods and of Bullet's soft bodies, on the same moving bodies, in the same steps.
//
// usage: perf_ropes [repetitions]  writes a table of comma-separated values
// Time is the thread's, of the world's step and the rope's together; the least of the repetitions' means.
// Depth is geometry's, of all steps, of the capsules between nodes, in shares of the rope's radius; of nodes
// alone as well, for these are what a soft body's contacts know. Stretch is the largest of any piece, and the
// rope's.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "rods/section.hpp"
#include "tests/scenes/ropes_in_bullet.hpp"

namespace {

using namespace sinew;

constexpr uint32_t kSegments = 48, kSteps = 600;
constexpr float kDt_s = 1.0f / 60, kFriction = 0.6f;
constexpr test::RopeMatter kMatter{.drag_per_s = 0};
const Eigen::Vector3d kFrom(-test::kRopeHalf_m, test::kRopeHeight_m, 0),
    kTo(test::kRopeHalf_m, test::kRopeHeight_m, 0);

struct Obstacle {
  const char* name;
  test::Swing swing;
  btConvexShape* shape;
};

struct Measured {
  double step_us = 0, depth = -1e9, node_depth = -1e9, piece_stretch = 0, rope_stretch = 0, lowest_m = 0;
};

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// From the ends of its pieces.
void measure(const std::vector<bullet::Axis>& pieces, const btRigidBody& body, Measured* m) {
  const auto radius = static_cast<double>(kMatter.radius_m);
  const double rest = (kTo - kFrom).norm() / kSegments;
  double length = 0, lowest = 1e9;
  for (const bullet::Axis& piece : pieces) {
    const double own = piece.length();
    length += own;
    lowest = std::min(lowest, piece.from[1]);
    m->piece_stretch = std::max(m->piece_stretch, std::fabs(own / rest - 1));
    m->depth = std::max(m->depth, test::depth_m(piece, radius, body) / radius);
    for (const rods::Vector& node : {piece.from, piece.to})
      m->node_depth = std::max(m->node_depth, test::depth_m({node, node}, radius, body) / radius);
  }
  m->rope_stretch = std::max(m->rope_stretch, std::fabs(length / (rest * kSegments) - 1));
  m->lowest_m = lowest;
}

// `take_step` makes one, `pieces` says where the rope then is.
template <class TakeStep, class Pieces>
Measured run(const Obstacle& obstacle, btRigidBody* body, TakeStep take_step, Pieces pieces) {
  Measured out;
  for (uint32_t i = 1; i <= kSteps; ++i) {
    body->setWorldTransform(obstacle.swing.at(i * static_cast<double>(kDt_s)));
    const double begin = thread_us();
    take_step();
    out.step_us += (thread_us() - begin) / kSteps;
    measure(pieces(), *body, &out);
  }
  return out;
}

btRigidBody* add(const Obstacle& obstacle, test::BulletWorld* world) {
  btRigidBody* body = world->kinematic(obstacle.shape, obstacle.swing.at(0));
  body->setFriction(kFriction);
  return body;
}

// Pieces of rods reach from joint to joint.
std::vector<bullet::Axis> joints(const test::RopeInBullet& rope) {
  std::vector<bullet::Axis> out;
  for (uint32_t i = 0; i < kSegments; ++i)
    out.push_back(test::axis_of_segment(rope.batch, rope.segments[i], i));
  for (uint32_t i = 0; i + 1 < kSegments; ++i) out[i].to = out[i + 1].from;
  return out;
}

Measured run_rods(const Obstacle& obstacle) {
  test::BulletWorld world({0, -9.81f, 0});
  btRigidBody* body = add(obstacle, &world);
  test::RopeInBullet rope;
  rope.segments = test::rod_through(test::straight_line(kFrom, kTo, kSegments), test::rope_segment(kMatter));
  const rods::RodSettings settings = rods::default_settings({.segments = kSegments, .contacts = true});
  const Status status = rope.create({.world = &world.world}, false, settings);
  if (!status.ok()) throw std::runtime_error(status.message);
  const auto take_step = [&] {
    rods::RodReport report;
    world.world.stepSimulation(kDt_s, 0, kDt_s);
    (void)rope.batch.step(kDt_s, &rope.collider, &report);
  };
  return run(obstacle, body, take_step, [&] { return joints(rope); });
}

struct SoftWorld {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
};

btVector3 bullet_vector(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Nodes collide by the bodies' distance fields; links at full stiffness; as many iterations as given.
btSoftBody* soft_rope(btSoftRigidDynamicsWorld* world, int iterations) {
  btSoftBodyWorldInfo& info = world->getWorldInfo();
  info.m_gravity = {0, -9.81f, 0};
  info.air_density = 0;
  info.m_sparsesdf.Initialize();
  btSoftBody* rope =
      btSoftBodyHelpers::CreateRope(info, bullet_vector(kFrom), bullet_vector(kTo), kSegments - 1, 0);
  const rods::SegmentDef segment =
      test::rod_through(test::straight_line(kFrom, kTo, kSegments), test::rope_segment(kMatter))[0];
  rope->setTotalMass(static_cast<float>(kSegments * rods::segment_inertia(segment).mass_kg));
  rope->m_materials[0]->m_kLST = 1;
  rope->m_cfg.piterations = iterations;
  rope->m_cfg.kDF = 1;  // times the body's own friction
  rope->m_cfg.kDP = 0.005f;
  rope->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  rope->getCollisionShape()->setMargin(kMatter.radius_m);
  world->addSoftBody(rope);
  return rope;
}

Measured run_soft(const Obstacle& obstacle, int iterations) {
  SoftWorld world;
  world.world.setGravity({0, -9.81f, 0});
  btRigidBody body(0, nullptr, obstacle.shape);
  body.setWorldTransform(obstacle.swing.at(0));
  body.setInterpolationWorldTransform(obstacle.swing.at(0));
  body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setFriction(kFriction);
  world.world.addRigidBody(&body);
  btSoftBody* rope = soft_rope(&world.world, iterations);
  const auto pieces = [&] {
    std::vector<bullet::Axis> out;
    const auto at = [&](int i) -> rods::Vector {
      const btVector3& x = rope->m_nodes[i].m_x;
      return {x.x(), x.y(), x.z()};
    };
    for (int i = 0; i + 1 < rope->m_nodes.size(); ++i) out.push_back({at(i), at(i + 1)});
    return out;
  };
  const Measured out = run(
      obstacle, &body, [&] { world.world.stepSimulation(kDt_s, 0, kDt_s); }, pieces);
  world.world.removeSoftBody(rope);
  world.world.removeRigidBody(&body);
  delete rope;
  return out;
}

template <class Run>
void print(const Obstacle& obstacle, const std::string& rope, int repetitions, Run run_one) {
  Measured best = run_one();
  for (int i = 1; i < repetitions; ++i) best.step_us = std::min(best.step_us, run_one().step_us);
  std::printf("%s,%s,%u,%u,%.2f,%.1f,%.4f,%.4f,%.2e,%.2e,%.3f\n", obstacle.name, rope.c_str(), kSegments,
              kSteps, 1e3 * static_cast<double>(kDt_s), best.step_us, best.depth, best.node_depth,
              best.piece_stretch, best.rope_stretch, best.lowest_m);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 3;
  btCylinderShapeZ bar(btVector3(test::kBarRadius_m, test::kBarRadius_m, 1));
  btBoxShape crate(btVector3(0.2f, 0.2f, 1));
  const Obstacle obstacles[] = {{"cylinder", test::kBarSwing, &bar}, {"box", test::kBarSwing, &crate}};
  std::printf(
      "obstacle,rope,segments,steps,dt_ms,step_us,deepest,deepest_node,piece_stretch,rope_stretch,lowest_"
      "m\n");
  for (const Obstacle& obstacle : obstacles) {
    print(obstacle, "sinew", repetitions, [&] { return run_rods(obstacle); });
    for (const int iterations : {4, 10, 40, 160, 1000})
      print(obstacle, "btSoftBody_" + std::to_string(iterations), repetitions,
            [&] { return run_soft(obstacle, iterations); });
  }
  return 0;
}
