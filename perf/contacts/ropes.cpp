// ropes.cpp  Ropes of Sinew's rods and of Bullet's soft bodies, on the same moving bodies, in the same steps.
//
// usage: perf_ropes [repetitions]  writes a table of comma-separated values
// One rope, and sixteen side by side that do not touch each other. Time is the thread's, of the world's step
// and the ropes' together, over the number of ropes; the least of the repetitions' means. Depth is
// geometry's, of all steps and ropes, of the capsules between nodes, in shares of the rope's radius; of nodes
// alone as well, for these are what a soft body's contacts know. Stretch is the largest of any piece, and of
// any rope.
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>

#include "perf/help.hpp"
#include "rods/section.hpp"
#include "tests/scenes/ropes_in_bullet.hpp"

namespace {

using namespace sinew;

constexpr uint32_t kSegments = 48, kSteps = 600;
constexpr float kDt_s = 1.0f / 60, kFriction = 0.6f;
constexpr uint32_t kMany = 16;
constexpr double kApart_m = 0.1;  // along the obstacle's axis, 2 m long
constexpr test::RopeMatter kMatter{.drag_per_s = 0};
constexpr double kRest_m = 2 * test::kRopeHalf_m / kSegments;

// Of rope `index` of so many.
Eigen::Vector3d end_of(uint32_t index, uint32_t ropes, double side) {
  const double along = kApart_m * (index - 0.5 * (ropes - 1));
  return {side * test::kRopeHalf_m, test::kRopeHeight_m, along};
}

struct Obstacle {
  const char* name;
  test::Swing swing;
  btConvexShape* shape;
};

struct Measured {
  double rope_us = 0, depth = -1e9, node_depth = -1e9, piece_stretch = 0, rope_stretch = 0, lowest_m = 1e9;
};

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// A rope, from the ends of its pieces.
void measure(const std::vector<bullet::Axis>& pieces, const btRigidBody& body, Measured* m) {
  const auto radius = static_cast<double>(kMatter.radius_m);
  double length = 0, lowest = 1e9;
  for (const bullet::Axis& piece : pieces) {
    const double own = piece.length();
    length += own;
    lowest = std::min(lowest, piece.from[1]);
    m->piece_stretch = std::max(m->piece_stretch, std::fabs(own / kRest_m - 1));
    m->depth = std::max(m->depth, test::depth_m(piece, radius, body) / radius);
    for (const rods::Vector& node : {piece.from, piece.to})
      m->node_depth = std::max(m->node_depth, test::depth_m({node, node}, radius, body) / radius);
  }
  m->rope_stretch = std::max(m->rope_stretch, std::fabs(length / (kRest_m * kSegments) - 1));
  m->lowest_m = std::min(m->lowest_m, lowest);
}

// `take_step` makes one, `pieces` says where a rope then is.
template <class TakeStep, class Pieces>
Measured run(const Obstacle& obstacle, uint32_t ropes, btRigidBody* body, TakeStep take_step, Pieces pieces) {
  Measured out;
  for (uint32_t i = 1; i <= kSteps; ++i) {
    out.lowest_m = 1e9;  // where they end
    body->setWorldTransform(obstacle.swing.at(i * static_cast<double>(kDt_s)));
    const double begin = thread_us();
    take_step();
    out.rope_us += (thread_us() - begin) / kSteps / ropes;
    for (uint32_t r = 0; r < ropes; ++r) measure(pieces(r), *body, &out);
  }
  return out;
}

btRigidBody* add(const Obstacle& obstacle, test::BulletWorld* world) {
  btRigidBody* body = world->kinematic(obstacle.shape, obstacle.swing.at(0));
  body->setFriction(kFriction);
  return body;
}

// Pieces of rods reach from joint to joint.
std::vector<bullet::Axis> joints(const test::RopeInBullet& rope, uint32_t strand) {
  std::vector<bullet::Axis> out;
  for (uint32_t i = 0; i < kSegments; ++i)
    out.push_back(test::axis_of_segment(rope.batch, rope.segments[i], i, strand));
  for (uint32_t i = 0; i + 1 < kSegments; ++i) out[i].to = out[i + 1].from;
  return out;
}

std::vector<rods::SegmentDef> segments_of(uint32_t index, uint32_t ropes) {
  const auto line = test::straight_line(end_of(index, ropes, -1), end_of(index, ropes, 1), kSegments);
  return test::rod_through(line, test::rope_segment(kMatter));
}

Measured run_rods(const Obstacle& obstacle, uint32_t ropes) {
  test::BulletWorld world({0, -9.81f, 0});
  btRigidBody* body = add(obstacle, &world);
  test::RopeInBullet rope;
  rope.segments = segments_of(0, ropes);
  for (uint32_t r = 1; r < ropes; ++r) rope.others.push_back(segments_of(r, ropes));
  const rods::RodSettings settings = {.start = rods::RodStart::kContinued};
  const Status status = rope.create({.world = &world.world}, false, settings);
  if (!status.ok()) throw std::runtime_error(status.message);
  const auto take_step = [&] {
    rods::RodReport report;
    world.world.stepSimulation(kDt_s, 0, kDt_s);
    (void)rope.batch.step(kDt_s, &rope.collider, &report);
  };
  return run(obstacle, ropes, body, take_step, [&](uint32_t r) { return joints(rope, r); });
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
std::unique_ptr<btSoftBody> soft_rope(btSoftRigidDynamicsWorld* world, uint32_t index, uint32_t ropes,
                                      int iterations) {
  std::unique_ptr<btSoftBody> rope(
      btSoftBodyHelpers::CreateRope(world->getWorldInfo(), bullet_vector(end_of(index, ropes, -1)),
                                    bullet_vector(end_of(index, ropes, 1)), kSegments - 1, 0));
  const rods::SegmentDef segment = segments_of(index, ropes)[0];
  rope->setTotalMass(static_cast<float>(kSegments * rods::segment_inertia(segment).mass_kg));
  rope->m_materials[0]->m_kLST = 1;
  rope->m_cfg.piterations = iterations;
  rope->m_cfg.kDF = 1;  // times the body's own friction
  rope->m_cfg.kDP = 0.005f;
  rope->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  rope->getCollisionShape()->setMargin(kMatter.radius_m);
  world->addSoftBody(rope.get());
  return rope;
}

Measured run_soft(const Obstacle& obstacle, uint32_t count, int iterations) {
  SoftWorld world;
  world.world.setGravity({0, -9.81f, 0});
  btSoftBodyWorldInfo& info = world.world.getWorldInfo();
  info.m_gravity = {0, -9.81f, 0};
  info.air_density = 0;
  info.m_sparsesdf.Initialize();
  btRigidBody body(0, nullptr, obstacle.shape);
  body.setWorldTransform(obstacle.swing.at(0));
  body.setInterpolationWorldTransform(obstacle.swing.at(0));
  body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  body.setActivationState(DISABLE_DEACTIVATION);
  body.setFriction(kFriction);
  world.world.addRigidBody(&body);
  std::vector<std::unique_ptr<btSoftBody>> ropes;
  for (uint32_t r = 0; r < count; ++r) ropes.push_back(soft_rope(&world.world, r, count, iterations));
  const auto pieces = [&](uint32_t r) {
    std::vector<bullet::Axis> out;
    const auto at = [&](int i) -> rods::Vector {
      const btVector3& x = ropes[r]->m_nodes[i].m_x;
      return {x.x(), x.y(), x.z()};
    };
    for (int i = 0; i + 1 < ropes[r]->m_nodes.size(); ++i) out.push_back({at(i), at(i + 1)});
    return out;
  };
  const Measured out = run(
      obstacle, count, &body, [&] { world.world.stepSimulation(kDt_s, 0, kDt_s); }, pieces);
  for (const std::unique_ptr<btSoftBody>& rope : ropes) world.world.removeSoftBody(rope.get());
  world.world.removeRigidBody(&body);
  return out;
}

template <class Run>
void print(const Obstacle& obstacle, const std::string& rope, uint32_t ropes, int repetitions, Run run_one) {
  Measured best = run_one();
  for (int i = 1; i < repetitions; ++i) best.rope_us = std::min(best.rope_us, run_one().rope_us);
  std::printf("%s,%s,%u,%u,%u,%.2f,%.1f,%.4f,%.4f,%.2e,%.2e,%.3f\n", obstacle.name, rope.c_str(), ropes,
              kSegments, kSteps, 1e3 * static_cast<double>(kDt_s), best.rope_us, best.depth, best.node_depth,
              best.piece_stretch, best.rope_stretch, best.lowest_m);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(
          argc, argv,
          "usage: perf_ropes [REPETITIONS]\n"
          "Ropes over a cylinder and a box, compared with Bullet's soft bodies; CSV to standard "
          "output. 3 repetitions by default."))
    return 0;
  const int repetitions = argc > 1 ? std::atoi(argv[1]) : 3;
  btCylinderShapeZ bar(btVector3(test::kBarRadius_m, test::kBarRadius_m, 1));
  btBoxShape crate(btVector3(0.2f, 0.2f, 1));
  const Obstacle obstacles[] = {{"cylinder", test::kBarSwing, &bar}, {"box", test::kBarSwing, &crate}};
  std::printf(
      "obstacle,rope,ropes,segments,steps,dt_ms,us_a_rope,deepest,deepest_node,piece_stretch,rope_stretch,"
      "lowest_m\n");
  for (const Obstacle& obstacle : obstacles) {
    for (const uint32_t ropes : {1u, kMany}) {
      print(obstacle, "sinew", ropes, repetitions, [&] { return run_rods(obstacle, ropes); });
      for (const int iterations : {4, 10, 40, 160, 1000})
        print(obstacle, "btSoftBody_" + std::to_string(iterations), ropes, repetitions,
              [&] { return run_soft(obstacle, ropes, iterations); });
    }
  }
  return 0;
}
