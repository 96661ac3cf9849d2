// walls.cpp  see walls.hpp.
#include "perf/frames/walls.hpp"

#include "perf/frames/floor.hpp"
#include "perf/scale/require.hpp"
#include "sinew/occluders.hpp"

namespace sinew::perf {
namespace {

constexpr float kHalfWidth_m = 1.5f, kHeight_m = 3;
constexpr float kWall_m[] = {-kHalfWidth_m, 0,         0, kHalfWidth_m,  0,         0,
                             kHalfWidth_m,  kHeight_m, 0, -kHalfWidth_m, kHeight_m, 0};
constexpr uint32_t kTriangles[] = {0, 1, 2, 0, 2, 3};

}  // namespace

std::unique_ptr<OcclusionSource> make_walls(uint32_t instances) {
  auto walls = std::make_unique<Occluders>();
  require(Occluders::create({}, walls.get()));
  for (double x = 0; x <= side_of_floor_m(instances); x += 4 * static_cast<double>(kHalfWidth_m)) {
    OccluderId id;
    require(walls->add(
        {.triangles = kTriangles, .places_m = kWall_m, .root = {.position_m = {x, 0, kWalls_m}}}, &id));
  }
  walls->update();
  return walls;
}

}  // namespace sinew::perf
