// scenes.cpp  see scenes.hpp.
#include "tests/extremes/scenes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>

namespace sinew::extremes {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

void turn_root(Act& act, const double (&axis)[3], double angle_rad) {
  for (int k = 0; k < 3; ++k)
    act.root.rotation_xyzw[k] = static_cast<float>(axis[k] * std::sin(angle_rad / 2));
  act.root.rotation_xyzw[3] = static_cast<float>(std::cos(angle_rad / 2));
}

void turning(const double (&axis)[3], double angle_rad, double (&out)[3][3]) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k) {
      const int other = 3 - r - k;
      const double cross = r == k ? 0 : ((k - r + 3) % 3 == 1 ? -axis[other] : axis[other]);
      out[r][k] = (r == k ? c : 0) + s * cross + (1 - c) * axis[r] * axis[k];
    }
}

struct Direction {
  double of[3];
  explicit Direction(Act& act) { act.draws.direction(of); }
};

// ---- motion of the root -----------------------------------------------------------------------------------

Frame accelerate(Act& act) {
  const Direction way(act);
  const double most_m_s2 = act.draws.of_any_size(10, 1e5), hz = act.draws.of_any_size(0.1, 30);
  const double rad_s = 2 * std::numbers::pi * hz;
  return [=](Act& now) {
    for (int k = 0; k < 3; ++k)
      now.root.position_m[k] = way.of[k] * most_m_s2 / (rad_s * rad_s) * std::sin(rad_s * now.time_s);
  };
}

Frame spin(Act& act) {
  const Direction axis(act);
  const double rad_s = act.draws.of_any_size(1, 1000);
  return [=](Act& now) { turn_root(now, axis.of, rad_s * now.time_s); };
}

Frame fly_away(Act& act) {
  const Direction way(act);
  const double jump_m = act.draws.of_any_size(0.1, 1e6), share = act.draws.between(0.05, 0.6);
  auto place_m = std::make_shared<double>(0);
  return [=](Act& now) {
    if (now.draws.chance(share)) *place_m += jump_m;
    for (int k = 0; k < 3; ++k) now.root.position_m[k] = way.of[k] * *place_m;
    now.teleport = now.draws.chance(0.1);
  };
}

Frame grow(Act& act) {
  const double scale = act.draws.of_any_size(1e-3, 1e3);
  const bool in_a_step = act.draws.chance(0.5);
  return [=](Act& now) {
    now.root.scale =
        std::clamp(in_a_step ? scale : std::pow(scale, std::min(1.0, now.frame / 20.0)), 1e-3, 1e3);
  };
}

// ---- poses ------------------------------------------------------------------------------------------------

Frame shake_joints(Act& act) {
  const Direction axis(act);
  const uint32_t joint = act.draws.below(act.subject.info.joint_count);
  const double most_rad = act.draws.of_any_size(0.1, 3), hz = act.draws.of_any_size(0.2, 30);
  return [=](Act& now) {
    double turn[3][3];
    turning(axis.of, most_rad * std::sin(2 * std::numbers::pi * hz * now.time_s), turn);
    now.move_joint(joint, turn, {0, 0, 0});
  };
}

// Scaled from a thousandth to a thousandfold, mirrored, flattened to nothing.
Frame deform_joints(Act& act) {
  const uint32_t joint = act.draws.below(act.subject.info.joint_count);
  std::array<double, 3> size;
  const double one = act.draws.of_any_size(1e-3, 1e3);
  for (double& along : size) {
    along = act.draws.chance(0.5) ? one : act.draws.of_any_size(1e-3, 1e3);
    if (act.draws.chance(0.2)) along = -along;
    if (act.draws.chance(0.1)) along = 0;
  }
  const int frames = static_cast<int>(act.draws.below(30));
  return [=](Act& now) {
    if (now.frame < 5 || now.frame > 5 + frames) return;
    now.move_joint(joint, {{size[0], 0, 0}, {0, size[1], 0}, {0, 0, size[2]}}, {0, 0, 0});
  };
}

Frame snap_joints(Act& act) {
  const double share = act.draws.between(0.02, 0.3), most_m = act.draws.of_any_size(0.01, 10);
  return [=](Act& now) {
    if (!now.draws.chance(share)) return;
    const Direction axis(now), way(now);
    double turn[3][3];
    turning(axis.of, now.draws.between(-3, 3), turn);
    now.move_joint(now.draws.below(now.subject.info.joint_count), turn,
                   {most_m * way.of[0], most_m * way.of[1], most_m * way.of[2]});
  };
}

Frame lose_a_joint(Act& act) {
  const uint32_t joint = act.draws.below(act.subject.info.joint_count);
  const int from = static_cast<int>(act.draws.below(10)), frames = 1 + static_cast<int>(act.draws.below(20));
  const float bad = act.draws.chance(0.5) ? kNaN : 1e30f;
  return [=](Act& now) {
    if (now.frame >= from && now.frame < from + frames) now.joints[joint].m[0][now.frame % 4] = bad;
  };
}

Frame any_matrices(Act& act) {
  const double size = act.draws.of_any_size(1e-3, 1e6), share = act.draws.between(0.01, 1);
  return [=](Act& now) {
    for (Matrix34& joint : now.joints)
      for (auto& row : joint.m)
        for (float& number : row)
          if (now.draws.chance(share)) number = static_cast<float>(now.draws.between(-size, size));
  };
}

// ---- what is touched --------------------------------------------------------------------------------------

Frame walls_through(Act& act) {
  const int count = 1 + static_cast<int>(act.draws.below(2));
  const double height_m = static_cast<double>(act.subject.info.height_m);
  for (int w = 0; w < count; ++w) {
    const Direction normal(act);
    const bool floor = act.draws.chance(0.4);
    scenes::Wall wall{};
    const double speed_m_s = height_m * act.draws.of_any_size(0.05, 1e4) / (act.draws.chance(0.5) ? 1 : 100);
    for (int k = 0; k < 3; ++k) {
      const double n = floor ? (k == 1) : normal.of[k];
      wall.normal[k] = static_cast<float>(n);
      wall.velocity_m_s[k] = static_cast<float>(speed_m_s * n);
      wall.point_m[k] = (k == 1 ? height_m / 2 : 0) - 0.6 * height_m * n;
    }
    act.walls.walls.push_back(wall);
  }
  return [=](Act& now) {
    for (scenes::Wall& wall : now.walls.walls)
      for (int k = 0; k < 3; ++k) wall.point_m[k] += now.dt_s * static_cast<double>(wall.velocity_m_s[k]);
  };
}

Frame any_hits(Act& act) {
  act.hits.depth_m = act.draws.of_any_size(1e-3, 100) * static_cast<double>(act.subject.info.height_m);
  act.hits.speed_m_s = act.draws.chance(0.5) ? 0 : act.draws.of_any_size(0.1, 1e5);
  act.hits.share = act.draws.of_any_size(0.01, 1);
  act.hits.bad_share = act.draws.chance(0.5) ? 0 : act.draws.between(0, 1);
  return [](Act&) {};
}

// ---- time, and what an engine calls -----------------------------------------------------------------------

Frame any_time(Act& act) {
  const bool mixed = act.draws.chance(0.5);
  const double dt_s = act.draws.of_any_size(1e-9, 1e6);
  return [=](Act& now) {
    now.dt_s = mixed ? now.draws.of_any_size(1e-9, 1e6) : dt_s;
    if (now.draws.chance(0.1)) now.dt_s = now.draws.chance(0.5) ? 0 : static_cast<double>(kNaN);
  };
}

Frame high_frame_rate(Act& act) {
  const double fps = act.draws.of_any_size(15, 1000);
  return [=](Act& now) { now.dt_s = 1 / fps; };
}

PartParameters any_parameters(Draws& draws) {
  PartParameters out;
  out.intensity = static_cast<float>(draws.between(0, 2));
  out.stiffness = static_cast<float>(draws.of_any_size(0.01, 100));
  out.damping = static_cast<float>(draws.chance(0.2) ? 0 : draws.of_any_size(0.01, 100));
  out.displacement = static_cast<float>(draws.between(0, 4));
  out.enabled = !draws.chance(0.1);
  return out;
}

Frame any_parameters(Act& act) {
  const double share = act.draws.of_any_size(0.02, 1);
  return [=](Act& now) {
    if (!now.draws.chance(share)) return;
    const Subject& of = now.subject;
    switch (now.draws.below(3)) {
      case 0:
        return void(now.world.set_parameters(now.instance, any_parameters(now.draws)));
      case 1:
        return void(now.world.set_region_parameters(now.instance, now.draws.below(of.info.region_count + 1),
                                                    any_parameters(now.draws)));
      default:
        return void(now.world.set_rod_parameters(now.instance, now.draws.below(of.info.rod_count + 1),
                                                 any_parameters(now.draws)));
    }
  };
}

Frame any_weather(Act& act) {
  const double share = act.draws.of_any_size(0.02, 1);
  return [=](Act& now) {
    if (!now.draws.chance(share)) return;
    Environment air;
    AddedEnvironment added;
    for (int k = 0; k < 3; ++k) {
      air.gravity_m_s2[k] = static_cast<float>(now.draws.between(-1000, 1000));
      air.acceleration_m_s2[k] = static_cast<float>(now.draws.between(-1e4, 1e4));
      air.wind.velocity_m_s[k] = static_cast<float>(now.draws.between(-200, 200));
      added.acceleration_m_s2[k] = static_cast<float>(now.draws.between(-1e4, 1e4));
      added.wind_m_s[k] = static_cast<float>(now.draws.between(-200, 200));
    }
    air.wind.gust = static_cast<float>(now.draws.between(0, 1));
    air.wind.gust_hz = static_cast<float>(now.draws.of_any_size(0.1, 10));
    (void)now.world.set_environment(air);
    (void)now.world.set_added_environment(now.instance, added);
  };
}

Frame any_calls(Act& act) {
  const double share = act.draws.between(0.05, 0.6);
  auto saved = std::make_shared<std::vector<std::byte>>();
  return [=](Act& now) {
    if (!now.draws.chance(share)) return;
    constexpr Tier kLimits[] = {Tier::kNetwork, Tier::kModal, Tier::kSkinning};
    switch (now.draws.below(10)) {
      case 0:
        return void(now.world.reset(now.instance));
      case 1:
        return void(now.world.set_hidden(now.instance, now.draws.chance(0.5)));
      case 2:
        return void(now.world.set_tier_limit(now.instance, kLimits[now.draws.below(3)]));
      case 3:
        return void(now.world.set_time_scale(now.instance, static_cast<float>(now.draws.between(0, 4))));
      case 4:
        return void(
            now.world.set_felt_root_motion(now.instance, static_cast<float>(now.draws.between(0, 1))));
      case 5:
        return void(now.world.set_budget_us(static_cast<float>(now.draws.of_any_size(0.1, 300))));
      case 6:
        return void(now.poses = false);
      case 7:
        return void(now.world.skip_pose(now.instance));
      case 8:
        saved->resize(now.world.state_bytes(now.instance));
        return void(now.world.save_state(now.instance, *saved));
      default:
        if (!saved->empty()) (void)now.world.restore_state(now.instance, *saved);
    }
  };
}

constexpr Scene kSingle[] = {{"root accelerates", accelerate},
                             {"root spins", spin},
                             {"root flies away", fly_away},
                             {"root's scale", grow},
                             {"joints shake", shake_joints},
                             {"joints are deformed", deform_joints, true},
                             {"joints snap", snap_joints, true},
                             {"a joint is lost", lose_a_joint},
                             {"any matrices", any_matrices, true},
                             {"walls come through", walls_through},
                             {"any hits", any_hits},
                             {"any time", any_time},
                             {"any frame rate", high_frame_rate},
                             {"any parameters", any_parameters, false, true},
                             {"any weather", any_weather},
                             {"any calls", any_calls, false, true}};

// Several at once.
Frame together(Act& act) {
  std::vector<Frame> parts;
  const uint32_t count = 2 + act.draws.below(4);
  for (uint32_t i = 0; i < count; ++i)
    parts.push_back(kSingle[act.draws.below(std::size(kSingle))].begin(act));
  return [=](Act& now) {
    for (const Frame& part : parts) part(now);
  };
}

constexpr auto kScenes = [] {
  std::array<Scene, std::size(kSingle) + 1> all{};
  std::copy(std::begin(kSingle), std::end(kSingle), all.begin());
  all.back() = {"several at once", together, true, true};
  return all;
}();

bool make_instance(Act& act, bool* own_body) {
  ContactDef contacts;
  if (!act.walls.walls.empty()) contacts.source = &act.walls;
  if (act.hits.share > 0 && (!contacts.source || act.draws.chance(0.5))) contacts.source = &act.hits;
  *own_body = contacts.own_body = act.draws.chance(0.3);
  return act.world.create_instance({.asset = act.asset, .contacts = contacts}, &act.instance).ok();
}

// ln 10 / (zeta omega) of the slowest part.
double slowest_s(const Subject& subject) {
  double most_s = 0.1;
  const auto take = [&](float frequency_hz, float damping_ratio) {
    const double rate = 2 * std::numbers::pi * static_cast<double>(frequency_hz * damping_ratio);
    if (rate > 0) most_s = std::max(most_s, std::log(10.0) / rate);
  };
  for (const RegionInfo& region : subject.regions) take(region.frequency_hz, region.damping_ratio);
  for (const RodInfo& rod : subject.rods) take(rod.frequency_hz, rod.damping_ratio);
  return most_s;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float most = 0;
  for (size_t i = 0; i + 2 < a.size(); i += 3)
    most = std::max(most, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return most;
}

void begin_frame_at_clip(Act& act) {
  act.time_s = act.frame / 60.0;
  act.begin_frame();
}

// The frames of a step whose end is a tick's, from wherever between two ticks the act's world has come to:
// a tick that comes later sees another pose of the clip.
void step_to_tick(Act& act) {
  constexpr int kParts = 100;
  const int frame = act.frame;
  bool ticked = false;
  for (int part = 0; part < kParts && !ticked; ++part) {
    act.frame = frame;
    begin_frame_at_clip(act);
    act.dt_s = 1.0 / (60 * kParts);
    ticked = act.step().ticks > 0;
  }
}

// Both at the clip's time of the frame, whatever time their worlds count.
void frame_of_both(Act& act, Act& twin, const Frame* change) {
  for (Act* each : {&act, &twin}) begin_frame_at_clip(*each);
  if (change) (*change)(act);
  act.step();
  twin.step();
}

}  // namespace

std::span<const Scene> all_scenes() { return kScenes; }

Outcome play(Subject& subject, const Scene& scene, uint64_t seed, uint32_t frames) {
  Act act(subject, seed % 3 == 0, seed);
  const Frame change = scene.begin(act);
  Outcome out;
  bool own_body = false;
  if (!make_instance(act, &own_body)) return out;
  for (; out.frames < frames; ++out.frames) {
    act.begin_frame();
    change(act);
    act.step();
    const Reading now = read(act, out.frames % 16 == 15);
    out.worst.displacement = std::max(out.worst.displacement, now.displacement);
    out.worst.outside = std::max(out.worst.outside, now.outside);
    out.worst.finite = out.worst.finite && now.finite;
  }
  return out;
}

Recovery recover(Subject& subject, const Scene& scene, uint64_t seed, uint32_t frames) {
  Act act(subject, 0, seed), twin(subject, 2, seed);
  const Frame change = scene.begin(act);
  Recovery out;
  bool own_body = false;
  if (!make_instance(act, &own_body) ||
      !twin.world.create_instance({.asset = twin.asset, .contacts = {.own_body = own_body}}, &twin.instance)
           .ok())
    return out;
  const auto compare = [&] {
    out.left = largest_difference(shown(act), shown(twin)) / subject.info.height_m;
    out.largest = std::max(out.largest, out.left);
  };
  for (uint32_t f = 0; f < frames; ++f) {
    frame_of_both(act, twin, &change);
    compare();
  }
  act.undo();
  frame_of_both(act, twin, nullptr);
  step_to_tick(act);
  begin_frame_at_clip(twin);
  twin.step();
  constexpr int kGlideTicks = 30, kMoreTicks = 10;
  const int ticks = kMoreTicks + (scene.calls_world ? kGlideTicks : 0);
  out.wait_s = static_cast<float>(slowest_s(subject) + ticks / 60.0);
  for (int f = 0; f < 60 * static_cast<double>(out.wait_s); ++f) {
    frame_of_both(act, twin, nullptr);
    compare();
  }
  return out;
}

}  // namespace sinew::extremes
