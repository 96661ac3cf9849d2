// main.cpp  consumer FILE.sinew: links the library as an engine would, loads a character, and sees its flesh
// and its rods swing. Ends with the line of the first check that failed, else 0.
#include <sinew/sinew.hpp>

#include <algorithm>
#include <cmath>
#include <vector>
#ifdef HAS_BULLET
#include <sinew/bullet.hpp>
#endif
#ifdef HAS_EMBREE
#include <sinew/surface_contacts.hpp>
#endif

#define CHECK(condition) \
  if (!(condition)) return __LINE__

namespace {

int look_at_adapters() {
#ifdef HAS_BULLET
  sinew::BulletContacts contacts;
  CHECK(!sinew::BulletContacts::create({}, &contacts).ok());  // a world is asked for
  CHECK(contacts.apply_impulses() == 0);
#endif
#ifdef HAS_EMBREE
  sinew::SurfaceContacts surfaces;
  CHECK(sinew::SurfaceContacts::create({}, &surfaces).ok());
#endif
  return 0;
}

struct Character {
  sinew::World world;
  sinew::InstanceId instance;
  std::vector<sinew::Matrix34> bind, joints;
  std::vector<float> displacement;  // bind space, three a vertex

  int load(const char* path) {
    sinew::AssetId asset;
    sinew::AssetInfo info;
    CHECK(sinew::World::create({}, &world).ok());
    CHECK(world.load_asset_file("no such file", &asset).code == sinew::StatusCode::kUnreadable);
    CHECK(world.load_asset_file(path, &asset).ok());
    CHECK(world.asset_info(asset, &info).ok());
    CHECK(info.rod_count > 0 && info.region_count > 0);
    bind.resize(info.joint_count);
    joints.resize(info.joint_count);
    displacement.resize(3 * size_t{info.vertex_count});
    CHECK(world.bind_pose(asset, bind).ok());
    CHECK(world.create_instance({.asset = asset}, &instance).ok());
    return 0;
  }

  int step(int frame) {
    const double height_m = 0.1 * std::sin(0.3 * frame);
    CHECK(world.set_pose(instance, {.joints = bind, .root = {.position_m = {0, height_m, 0}}}).ok());
    CHECK(world.step(1.0f / 60).instances_network == 1);
    CHECK(world.read_joint_matrices(instance, joints).ok());
    const size_t vertices = displacement.size() / 3;
    CHECK(world
              .read_positions(
                  instance, {.space = sinew::Space::kBind, .out = displacement.data(), .capacity = vertices})
              .ok());
    return 0;
  }
};

float flesh_moved_m(const Character& character) {
  float most = 0;
  for (float value : character.displacement) most = std::max(most, std::abs(value));
  return most;
}

// Of where bones begin.
float rods_moved_m(const Character& character) {
  float most = 0;
  for (size_t j = 0; j < character.joints.size(); ++j)
    for (const auto axis : {0, 1, 2})
      most = std::max(most, std::abs(character.joints[j].m[axis][3] - character.bind[j].m[axis][3]));
  return most;
}

}  // namespace

int main(int count, char** arguments) {
  CHECK(count == 2);
  if (const int line = look_at_adapters()) return line;
  Character character;
  if (const int line = character.load(arguments[1])) return line;
  float flesh_m = 0, rods_m = 0;
  for (int frame = 0; frame < 60; ++frame) {
    if (const int line = character.step(frame)) return line;
    flesh_m = std::max(flesh_m, flesh_moved_m(character));
    rods_m = std::max(rods_m, rods_moved_m(character));
  }
  // The root swings by 0.2 m. Flesh follows by some centimetres, a tail of four bones of 0.1 m by more, and
  // stays on.
  CHECK(flesh_m > 0.002f && flesh_m < 0.2f);
  CHECK(rods_m > 0.01f && rods_m < 0.5f);
  return 0;
}
