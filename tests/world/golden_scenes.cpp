// golden_scenes.cpp  What an instance can go through, a few seconds each.
#include "tests/world/golden_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/poison.hpp"

namespace sinew::test {
namespace {

using scenes::ArmMatter;
using scenes::BlockPose;
using scenes::HalfSpaces;
using scenes::PackBytes;
using scenes::RodMatter;

constexpr double kFrame_s = 1.0 / 60;
// The same inputs give the same tiers on every machine.
constexpr WorldDef kInUnits{.budget_mode = BudgetMode::kWorkUnits};

// ---- packs ------------------------------------------------------------------------------------------------

const PackBytes& rods_pack() {
  static const PackBytes pack =
      scenes::soft_block({.nodes = 40,
                          .rods = RodMatter{.sag = 1, .young_modulus_pa = 1e5, .bar = true},
                          .coarser_nodes = {10}});
  return pack;
}

const PackBytes& arms_pack() {
  static const PackBytes pack = scenes::soft_block({.arms = ArmMatter{}});
  return pack;
}

const PackBytes& left_out_pack() {
  static const PackBytes pack = scenes::soft_block({.nodes = 40, .coarser_nodes = {20}, .leaves_out = true});
  return pack;
}

const PackBytes& tight_pack() {
  static const PackBytes pack = scenes::soft_block({.displacement_limit = 0.2});
  return pack;
}

// A budget in work units that pays for this tier of one block, and for none above.
float cost_us(const PackBytes& pack, Tier tier, uint32_t level = 0) {
  pack::PackView view;
  REQUIRE(pack::open_pack(pack.bytes(), &view).ok());
  for (const pack::TierRecord& record : view.tiers)
    if (record.tier == static_cast<uint32_t>(tier) && record.level == level) return 1.01f * record.cost_us;
  FAIL("no such tier");
  return 0;
}

// ---- shorthands -------------------------------------------------------------------------------------------

struct Scene : Stage {
  GoldenRecorder& recorder;

  Scene(GoldenRecorder& to, uint32_t count = 1, const PackBytes& pack = block_pack(),
        const WorldDef& def = kInUnits)
      : Stage(count, def, pack), recorder(to) {}
  Scene(GoldenRecorder& to, const ContactDef& contacts, const PackBytes& pack)
      : Stage(0, kInUnits, pack), recorder(to) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .contacts = contacts}, &made).ok());
    blocks.push_back(made);
  }

  void frame(const Motion& motion, double dt_s = kFrame_s) { recorder.add_frame(*this, step(motion, dt_s)); }
  void frames(int count, const Motion& motion = scenes::walk, double dt_s = kFrame_s) {
    for (int f = 0; f < count; ++f) frame(motion, dt_s);
  }
  // Poses with more joints than the block's two.
  template <class Posed>
  void frames_of(int count, const Posed& posed) {
    for (int f = 0; f < count; ++f) {
      time_s += kFrame_s;
      for (const InstanceId id : blocks) REQUIRE(world.set_pose(id, posed(time_s).pose()).ok());
      recorder.add_frame(*this, world.step(static_cast<float>(kFrame_s)));
    }
  }
  void budget(float us) { REQUIRE(world.set_budget_us(us).ok()); }
};

void play_tier(GoldenRecorder& recorder, Tier tier) {
  Scene scene(recorder);
  scene.budget(cost_us(block_pack(), tier));
  scene.frames(150);
}

// Down to nothing for some ticks and back, four times.
void play_gaps(GoldenRecorder& recorder, int ticks) {
  Scene scene(recorder);
  scene.frames(60);
  for (int gap = 0; gap < 4; ++gap) {
    scene.budget(cost_us(block_pack(), Tier::kExtrapolate));
    scene.frames(ticks);
    scene.budget(INFINITY);
    scene.frames(25);
  }
}

void play_hidden(GoldenRecorder& recorder, int ticks) {
  Scene scene(recorder);
  scene.frames(60);
  for (int time = 0; time < 3; ++time) {
    REQUIRE(scene.world.set_hidden(scene.blocks[0], true).ok());
    scene.frames(ticks);
    REQUIRE(scene.world.set_hidden(scene.blocks[0], false).ok());
    scene.frames(30);
  }
}

void play_budgets(GoldenRecorder& recorder, const PackBytes& pack, std::initializer_list<float> budgets_us) {
  Scene scene(recorder, 1, pack);
  for (int round = 0; round < 2; ++round)
    for (const float us : budgets_us) {
      scene.budget(us);
      scene.frames(40);
    }
}

// Off in the middle of frames that are no ticks, and on from a snapshot.
template <class Posed>
void play_rollback(Scene& scene, const Posed& posed) {
  scene.frames_of(50, posed);
  const std::vector<std::byte> saved = scene.save();
  const double saved_s = scene.time_s;
  scene.frames_of(20, posed);
  REQUIRE(scene.world.restore_state(scene.blocks[0], saved).ok());
  scene.time_s = saved_s;
  scene.frames_of(50, posed);
}

scenes::TailedPose walk_with_rods(double time_s) {
  return scenes::with_rods(scenes::walk(time_s), 0.2 * std::sin(9 * time_s));
}

// The arm goes through the block's soft side and back.
auto press_with_arm() {
  return [](double time_s) {
    return scenes::with_arms(scenes::walk(time_s), {}, -0.07 + 0.07 * std::cos(3 * time_s));
  };
}

struct CurtainThatOpens final : OcclusionSource {
  int asked = 0;
  bool is_blocked(const double (&)[3], const double (&)[3]) noexcept override { return ++asked % 700 < 350; }
};

void play_crowd(GoldenRecorder& recorder, WorldDef def) {
  CurtainThatOpens curtain;
  def.budget_mode = BudgetMode::kWorkUnits;
  def.occlusion = &curtain;
  Scene scene(recorder, 9, levels_pack(), def);
  for (size_t i = 0; i < scene.blocks.size(); ++i)
    REQUIRE(scene.world.set_importance(scene.blocks[i], static_cast<float>(i % 4)).ok());
  const float network_us = cost_us(levels_pack(), Tier::kNetwork);
  for (int f = 0; f < 240; ++f) {
    scene.budget(network_us * (3 + 3 * std::sin(0.05f * static_cast<float>(f))));
    const View view{.position_m = {0.02 * f, 0.3, 3 + 0.05 * f}, .height_rad = 0.8f};
    if (f > 120) REQUIRE(scene.world.set_views({&view, 1}).ok());
    scene.frame(scenes::walk);
  }
}

// ---- scenes -----------------------------------------------------------------------------------------------

constexpr GoldenScene kScenes[] = {
    {"network", [](GoldenRecorder& to) { play_tier(to, Tier::kNetwork); }},
    {"modal", [](GoldenRecorder& to) { play_tier(to, Tier::kModal); }},
    {"extrapolate", [](GoldenRecorder& to) { play_tier(to, Tier::kExtrapolate); }},
    {"skinning",
     [](GoldenRecorder& to) {
       Scene scene(to);
       scene.budget(0);
       scene.frames(60);
     }},
    {"without_a_network", [](GoldenRecorder& to) { Scene(to, 1, weightless_pack()).frames(150); }},
    {"tiers_down_and_up",
     [](GoldenRecorder& to) {
       const PackBytes& pack = block_pack();
       play_budgets(to, pack, {INFINITY, cost_us(pack, Tier::kModal), 0.0f, cost_us(pack, Tier::kModal)});
     }},
    {"levels_down_and_up",
     [](GoldenRecorder& to) {
       const PackBytes& pack = levels_pack();
       play_budgets(to, pack,
                    {INFINITY, cost_us(pack, Tier::kNetwork, 1), cost_us(pack, Tier::kModal, 2),
                     cost_us(pack, Tier::kNetwork, 1)});
     }},
    {"region_left_out_and_in",
     [](GoldenRecorder& to) {
       const PackBytes& pack = left_out_pack();
       play_budgets(to, pack, {INFINITY, cost_us(pack, Tier::kModal, 2), cost_us(pack, Tier::kNetwork, 1)});
     }},
    {"gaps_of_1_tick", [](GoldenRecorder& to) { play_gaps(to, 1); }},
    {"gaps_of_2_ticks", [](GoldenRecorder& to) { play_gaps(to, 2); }},
    {"gaps_of_3_ticks", [](GoldenRecorder& to) { play_gaps(to, 3); }},
    {"gaps_of_9_ticks", [](GoldenRecorder& to) { play_gaps(to, 9); }},
    {"gaps_of_40_ticks", [](GoldenRecorder& to) { play_gaps(to, 40); }},
    {"hidden_for_2_ticks", [](GoldenRecorder& to) { play_hidden(to, 2); }},
    {"hidden_for_9_ticks", [](GoldenRecorder& to) { play_hidden(to, 9); }},
    {"hidden_for_30_ticks", [](GoldenRecorder& to) { play_hidden(to, 30); }},
    {"dormant_and_woken",
     [](GoldenRecorder& to) {
       Scene scene(to, 1, block_pack(), {.sleep_tolerance = 2e-3f, .budget_mode = BudgetMode::kWorkUnits});
       scene.frames(300, [](double t) { return scenes::walk(std::min(t, 1.0)); });
       REQUIRE(scene.report().dormant);
       scene.frames(60, [](double t) { return scenes::walk(t - 4); });
     }},
    {"displacement_at_its_limit",
     [](GoldenRecorder& to) {
       Scene scene(to, 1, tight_pack());
       scene.frames(120, [](double t) { return scenes::shake(t, 12); });
       REQUIRE(scene.report().displacement_clamps > 0);
     }},
    {"network_given_up",
     [](GoldenRecorder& to) {
       Scene scene(to);
       scene.frames(50);
       poison(scene, in_network(0));
       scene.frames(100);
       REQUIRE(scene.report().fallbacks == 1);
     }},
    {"all_state_given_up",
     [](GoldenRecorder& to) {
       Scene scene(to);
       scene.frames(50);
       poison(scene, [](const world::Instance& twin) { return twin.tissue.q[0] + 2; });
       scene.frames(100);
       REQUIRE(scene.report().restarts == 1);
     }},
    {"reset_and_teleport",
     [](GoldenRecorder& to) {
       Scene scene(to);
       scene.frames(60);
       REQUIRE(scene.world.reset(scene.blocks[0]).ok());
       scene.frames(30);
       scene.frames(60, [](double t) {
         BlockPose pose = scenes::walk(t);
         pose.root.position_m[2] += 1e6;
         return pose;
       });
     }},
    {"joints_that_scale_shear_and_mirror",
     [](GoldenRecorder& to) {
       Scene(to).frames(90, [](double t) {
         BlockPose pose = scenes::walk(t);
         for (Matrix34& joint : pose.joints)
           for (float(&row)[4] : joint.m) {
             row[0] *= -1 - static_cast<float>(0.2 * std::sin(t));
             row[1] += 0.1f * row[2];
           }
         return pose;
       });
     }},
    {"floor",
     [](GoldenRecorder& to) {
       HalfSpaces ceiling;
       ceiling.walls = {{{0, 0.57, 0}, {0, -1, 0}}, {{0, 0, 0.12}, {0, 0, -1}}};
       Scene scene(to, {.source = &ceiling}, block_pack());
       scene.frames(150);
       REQUIRE(scene.report().vertices_touched > 0);
     }},
    {"own_body",
     [](GoldenRecorder& to) {
       Scene scene(to, {.own_body = true}, arms_pack());
       scene.frames_of(150, press_with_arm());
       REQUIRE(scene.report().vertices_touched > 0);
     }},
    {"own_body_by_modes",
     [](GoldenRecorder& to) {
       Scene scene(to, {.own_body = true}, arms_pack());
       scene.budget(cost_us(arms_pack(), Tier::kModal));
       scene.frames_of(150, press_with_arm());
     }},
    {"rods", [](GoldenRecorder& to) { Scene(to, 1, rods_pack()).frames_of(150, walk_with_rods); }},
    {"rods_and_levels",
     [](GoldenRecorder& to) {
       Scene scene(to, 1, rods_pack());
       for (const float us : {cost_us(rods_pack(), Tier::kModal, 1), 0.0f, INFINITY}) {
         scene.budget(us);
         scene.frames_of(40, walk_with_rods);
       }
     }},
    {"rods_on_skin_and_capsules",
     [](GoldenRecorder& to) {
       HalfSpaces skin;
       skin.walls = {{{0, 0.37, 0}, {0, 1, 0}}};
       Scene scene(to, {.own_body = true, .surface = &skin}, rods_pack());
       for (const float us : {INFINITY, cost_us(rods_pack(), Tier::kNetwork, 1)}) {
         scene.budget(us);
         scene.frames_of(120,
                         [](double t) { return scenes::with_rods(scenes::bent_pose(0.1 * std::sin(t))); });
         REQUIRE(scene.report().rod_contacts > 0);
       }
     }},
    {"rods_hidden",
     [](GoldenRecorder& to) {
       Scene scene(to, 1, rods_pack());
       scene.frames_of(40, walk_with_rods);
       for (const bool hidden : {true, false}) {
         REQUIRE(scene.world.set_hidden(scene.blocks[0], hidden).ok());
         scene.frames_of(20, walk_with_rods);
       }
     }},
    {"frames_between_ticks", [](GoldenRecorder& to) { Scene(to).frames(200, scenes::walk, 1.0 / 144); }},
    {"frames_of_several_ticks", [](GoldenRecorder& to) { Scene(to).frames(40, scenes::walk, 1.0 / 17); }},
    {"time_beyond_the_most_ticks", [](GoldenRecorder& to) { Scene(to).frames(20, scenes::walk, 0.13); }},
    {"pauses",
     [](GoldenRecorder& to) {
       Scene scene(to);
       for (int pause = 0; pause < 3; ++pause) {
         scene.frames(30);
         scene.frames(5, scenes::walk, 0);
       }
     }},
    {"restored_in_the_midst",
     [](GoldenRecorder& to) {
       Scene scene(to);
       scene.frames(3, scenes::walk, 1.0 / 90);
       play_rollback(scene, scenes::walk);
     }},
    {"rods_restored_in_the_midst",
     [](GoldenRecorder& to) {
       Scene scene(to, 1, rods_pack());
       play_rollback(scene, walk_with_rods);
     }},
    {"crowd", [](GoldenRecorder& to) { play_crowd(to, {}); }},
    {"crowd_on_three_threads",
     [](GoldenRecorder& to) {
       scenes::ThreadPool pool(3);
       play_crowd(to, {.tasks = pool.hook()});
     }},
};

template <class T>
uint64_t hash_values(const std::vector<T>& values) {
  return core::hash64(std::as_bytes(std::span(values)));
}

}  // namespace

void GoldenRecorder::add_frame(const Stage& stage, const FrameReport& frame) {
  std::vector<float> vectors(size_t{3} * stage.info.vertex_count);
  std::vector<Matrix34> joints(stage.info.joint_count);
  decisions_.insert(
      decisions_.end(),
      {frame.frame, frame.ticks, frame.instances_network, frame.instances_modal, frame.instances_extrapolated,
       frame.instances_skinned, frame.instances_hidden, frame.instances_dormant, frame.regions_asleep});
  for (size_t i = 0; i < stage.blocks.size(); ++i) {
    const ReadDef read{.out = vectors.data(), .capacity = stage.info.vertex_count};
    REQUIRE(stage.world.read_positions(stage.blocks[i], read).ok());
    positions_.push_back(hash_values(vectors));
    REQUIRE(stage.world.read_normals(stage.blocks[i], read).ok());
    normals_.push_back(hash_values(vectors));
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[i], joints).ok());
    joints_.push_back(hash_values(joints));
    const InstanceReport report = stage.report(i);
    decisions_.insert(decisions_.end(),
                      {static_cast<uint32_t>(report.tier), static_cast<uint32_t>(report.why),
                       report.graph_level, report.input_clamps, report.displacement_clamps, report.fallbacks,
                       report.restarts, report.regions_asleep, report.regions_left_out, report.rod_recoveries,
                       report.rods_asleep, report.rod_contacts, uint32_t{report.rods_touch_surface},
                       report.vertices_touched, uint32_t{report.hidden}, uint32_t{report.dormant}});
  }
}

GoldenOutput GoldenRecorder::output() const {
  return {hash_values(positions_), hash_values(normals_), hash_values(joints_), hash_values(decisions_)};
}

std::span<const GoldenScene> golden_scenes() { return kScenes; }

}  // namespace sinew::test
