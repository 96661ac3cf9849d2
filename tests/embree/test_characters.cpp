// test_characters.cpp  A tail on the skin of another character, where both are simulated in one world.
#include "tests/embree/surface_scenes.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;
using scenes::kTail;
using scenes::kTailRadius_m;

namespace {

constexpr float kFrame_s = 1.0f / 60;
constexpr int kSettling = 90, kWatched = 240;  // frames
// Below the tail's middle: it droops on to the other's upper side.
constexpr double kBelow[3] = {0, -0.25, -0.35};

const scenes::PackBytes& tailed_pack() {
  static const scenes::PackBytes pack =
      scenes::soft_block({.rods = scenes::RodMatter{.sag = 1, .young_modulus_pa = 1e5}});
  return pack;
}

// In the bind pose, in which no bone is turned.
Vector bound(uint32_t joint) {
  const Matrix34 bind = scenes::with_rods(scenes::bind_pose()).joints[joint];
  return {bind.m[0][3], bind.m[1][3], bind.m[2][3]};
}

struct Pair {
  World world;
  AssetId tailed, plain;
  InstanceId above, below;
  SurfaceContacts skins, looked_at;
  SurfaceId skin, looked_at_skin;
  std::vector<float> places;
  double time_s = 0;

  explicit Pair(bool touches) {
    REQUIRE(World::create({.max_assets = 2, .max_instances = 2}, &world).ok());
    REQUIRE(world.load_asset(tailed_pack().bytes(), &tailed).ok());
    REQUIRE(world.load_asset(block_pack().bytes(), &plain).ok());
    REQUIRE(SurfaceContacts::create({}, &skins).ok());
    REQUIRE(SurfaceContacts::create({}, &looked_at).ok());
    InstanceDef def = {.asset = tailed};
    if (touches) def.contacts.surface = &skins;
    REQUIRE(world.create_instance(def, &above).ok());
    REQUIRE(world.create_instance({.asset = plain}, &below).ok());
    step();
    add_skin();
  }
  void add_skin() {
    pack::PackView view;
    REQUIRE(pack::open_pack(block_pack().bytes(), &view).ok());
    places = skin_of_below(Space::kWorld);
    const SurfaceDef def = {.triangles = view.triangles, .rest_m = places};
    REQUIRE(skins.add_surface(def, &skin).ok());
    REQUIRE(looked_at.add_surface(def, &looked_at_skin).ok());
  }
  std::vector<float> skin_of_below(Space space) const {
    AssetInfo info;
    REQUIRE(world.asset_info(plain, &info).ok());
    std::vector<float> out(size_t{3} * info.vertex_count);
    REQUIRE(
        world.read_positions(below, {.space = space, .out = out.data(), .capacity = info.vertex_count}).ok());
    return out;
  }
  void step() {
    time_s += static_cast<double>(kFrame_s);
    REQUIRE(world.set_pose(above, scenes::with_rods(scenes::bind_pose()).pose()).ok());
    scenes::BlockPose shaken = scenes::shake(time_s, 0.2);
    for (size_t k = 0; k < 3; ++k) shaken.root.position_m[k] += kBelow[k];
    shaken.root.position_m[1] += 0.02 * std::sin(2 * M_PI * time_s);
    REQUIRE(world.set_pose(below, shaken.pose()).ok());
    world.step(kFrame_s);
  }
  void frame() {
    step();
    places = skin_of_below(Space::kWorld);
    REQUIRE(skins.move_surface(skin, {.places_m = places, .dt_s = kFrame_s, .time = SurfaceTime::kTickStart})
                .ok());
    REQUIRE(looked_at.move_surface(looked_at_skin, {.places_m = places}).ok());
  }
  // Of the tail in the skin as both are shown, shares of its radius; below zero: apart.
  double deepest() {
    std::vector<Matrix34> joints(scenes::kTailedJoints);
    REQUIRE(world.read_joint_matrices(above, joints).ok());
    const auto origin = [&](uint32_t joint) {
      return Vector{joints[joint].m[0][3], joints[joint].m[1][3], joints[joint].m[2][3]};
    };
    // The last bone is as long as those before it, and lies along its own axis.
    const uint32_t last = kTail + 3;
    const Vector axis = rods::difference(bound(last), bound(last - 1));
    Vector tip = origin(last);
    for (size_t k = 0; k < 3; ++k)
      for (size_t i = 0; i < 3; ++i) tip[k] += static_cast<double>(joints[last].m[k][i]) * axis[i];
    double most = -1;
    for (uint32_t bone = kTail; bone <= last; ++bone) {
      const Vector end = bone < last ? origin(bone + 1) : tip;
      for (const ContactHit& hit : found(looked_at, probe(origin(bone), end, kTailRadius_m)))
        most = std::max(most, -static_cast<double>(hit.gap_m) / kTailRadius_m);
    }
    return most;
  }
};

struct Watched {
  double deepest = -1;
  uint32_t touching = 0;
  double farthest_m = 0;    // that the flesh beneath is displaced
  double unforeseen_m = 0;  // that a vertex of the skin is from where its last two frames have it go
};

Watched watch(bool touches) {
  Pair pair(touches);
  Watched out;
  std::vector<float> foreseen;
  for (int f = 0; f < kSettling + kWatched; ++f) {
    const std::vector<float> before = pair.places;
    pair.frame();
    if (f >= kSettling)
      out.unforeseen_m = std::max(out.unforeseen_m, largest_distance(pair.places, foreseen));
    foreseen = pair.places;
    for (size_t i = 0; i < before.size(); ++i) foreseen[i] += pair.places[i] - before[i];
    if (f < kSettling) continue;
    out.deepest = std::max(out.deepest, pair.deepest());
    InstanceReport report;
    REQUIRE(pair.world.report(pair.above, &report).ok());
    out.touching += report.rod_contacts > 0;
    REQUIRE(report.rod_recoveries == 0);
    const std::vector<float> displaced = pair.skin_of_below(Space::kBind);
    out.farthest_m =
        std::max(out.farthest_m, largest_distance(displaced, std::vector<float>(displaced.size())));
  }
  return out;
}

}  // namespace

TEST_CASE("a_tail_lies_on_the_skin_of_another_character_as_it_is_simulated") {
  const Watched touching = watch(true), alone = watch(false);
  CHECK(touching.farthest_m > 0.01);
  CHECK(touching.touching == kWatched);
  // As wanted of rods. A skin is known as it was shown, and goes on as it came: what else it does in a tick,
  // up to an eighth of the radius here, is missing, and let out by 2 % of the height a second.
  CHECK(touching.unforeseen_m < 0.13 * kTailRadius_m);
  CHECK(touching.deepest < 0.2);
  CHECK(alone.deepest > 1);
}
