// main.cpp  What a character's secondary motion makes of discontinuities, as a table.
//
//   perf_events C.sinew [...]
//
// Each pack stands in its bind pose for a second; then comes an event, and two seconds in which it stands, or
// goes on as it went. A figure is the largest distance of a vertex from where skinning alone has it, as a
// fraction of the height, at 60 frames a second on the best tier; beside it the time until it stays within
// 1.5 times of what a bob of 5 % of the height at 2 Hz moves (ordinary motion). Events that are to be carried
// come first; those that are to be felt last.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "baker/audit/motions.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "perf/help.hpp"
#include "perf/shown_pack.hpp"

namespace sinew::perf {
namespace {

using Affine = Eigen::Transform<float, 3, Eigen::AffineCompact, Eigen::RowMajor>;
using Eigen::Vector3f;

constexpr double kBefore_s = 1, kAfter_s = 2;
constexpr float kPlay = 1.5f;  // of ordinary motion

struct Stage {  // what an event moves
  std::span<const Matrix34> bind;
  uint32_t joint = 0;  // that soft flesh or a rod hangs on
  float height_m = 1;
};

struct Act {
  std::span<Matrix34> joints;
  RootTransform* root;
};

struct Event {
  const char* name;
  bool is_felt;
  // At so many seconds after the event, negative before it.
  std::function<void(double t_s, const Stage&, const Act&)> act;
};

void turn(const Act& act, double radians) {
  act.root->rotation_xyzw[1] = static_cast<float>(std::sin(radians / 2));
  act.root->rotation_xyzw[3] = static_cast<float>(std::cos(radians / 2));
}

Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> matrix(Matrix34& joint) {
  return Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&joint.m[0][0]);
}

// The left side does what the right one did.
void mirror(const Act& act) {
  for (Matrix34& joint : act.joints) {
    auto m = matrix(joint);
    m.row(0) *= -1;
    m.col(0) *= -1;
  }
}

void scale(const Act& act, float by) {
  for (Matrix34& joint : act.joints) matrix(joint) *= by;
}

void shift(const Act& act, const Vector3f& by_m) {
  for (Matrix34& joint : act.joints) matrix(joint).col(3) += by_m;
}

std::vector<Event> all_events() {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto snap = [](double angle) {
    return [=](double t_s, const Stage&, const Act& act) {
      if (t_s >= 0) turn(act, angle);
    };
  };
  const auto runs_until = [](double t_s, double speed_m_s) { return speed_m_s * std::min(t_s, 0.0); };
  return {
      {"snap turn of 45 degrees", false, snap(45 * kDegree)},
      {"snap turn of 180 degrees", false, snap(180 * kDegree)},
      {"step up of 0.5 m", false,
       [](double t_s, const Stage&, const Act& act) { act.root->position_m[1] = t_s < 0 ? 0 : 0.5; }},
      {"all joints mirrored", false,
       [](double t_s, const Stage&, const Act& act) {
         if (t_s >= 0) mirror(act);
       }},
      {"all joints scaled by 2", false,
       [](double t_s, const Stage&, const Act& act) {
         if (t_s >= 0) scale(act, 2);
       }},
      {"hips that walked 1.5 m jump back", false,
       [](double t_s, const Stage&, const Act& act) {
         shift(act, {0, 0, static_cast<float>(1.5 * (t_s < 0 ? 1 + std::fmax(t_s, -1) : t_s))});
       }},
      {"the root was moved 0.3 m meanwhile", false,
       [](double t_s, const Stage&, const Act& act) { act.root->position_m[0] = t_s < 0 ? 0 : 0.3; }},
      {"one joint jumps by 0.3 heights", false,
       [](double t_s, const Stage& stage, const Act& act) {
         if (t_s >= 0) matrix(act.joints[stage.joint])(1, 3) += 0.3f * stage.height_m;
       }},
      {"dead stop from 5 m/s in a frame", true,
       [=](double t_s, const Stage&, const Act& act) { act.root->position_m[2] = runs_until(t_s, 5); }},
      {"dash from 0 to 6 m/s in 0.2 s", true,
       [](double t_s, const Stage&, const Act& act) {
         const double t = std::clamp(t_s, 0.0, 0.2);
         act.root->position_m[2] = 6 * (t * t / 0.4 + std::fmax(0.0, t_s - 0.2));
       }},
      {"landing from 1 m, stopped in 0.1 s", true,
       [](double t_s, const Stage&, const Act& act) {
         const double speed = std::sqrt(2 * 9.80665), t = std::clamp(t_s, 0.0, 0.1);
         const double fall_s = std::clamp(t_s, -speed / 9.80665, 0.0) + speed / 9.80665;
         act.root->position_m[1] = 1 - 9.80665 * fall_s * fall_s / 2 - speed * (t - t * t / 0.2);
       }},
  };
}

constexpr float kDt_s = 1.0f / 60;

// Frame by frame, the largest distance from skinning over the height.
std::vector<float> played(const baker::LoadedPack& pack, double from_s, double to_s,
                          const std::function<void(double, const Act&)>& pose_at) {
  ShownPack moved(pack), skinned(pack, 0);
  std::vector<Matrix34> joints(pack.view().joints.size());
  std::vector<float> out;
  const auto frames = static_cast<int>(std::lround((to_s - from_s) / static_cast<double>(kDt_s)));
  for (int frame = 0; frame <= frames; ++frame) {
    Pose pose{.joints = joints};
    pose_at(from_s + frame * static_cast<double>(kDt_s), {joints, &pose.root});
    const std::span<const float> a = moved.step(pose, kDt_s), b = skinned.step(pose, kDt_s);
    float most = 0;
    for (size_t v = 0; v < a.size(); v += 3)
      most = std::max(most, std::hypot(a[v] - b[v], a[v + 1] - b[v + 1], a[v + 2] - b[v + 2]));
    out.push_back(most / moved.info().height_m);
  }
  return out;
}

// Of the first soft part, else the first rod.
uint32_t joint_of(const pack::PackView& view) {
  if (!view.rods.empty() && view.regions.empty()) return view.rods[0].attach;
  const baker::AuditMotion none = baker::bob_motion(view, 1, 0);
  return view.regions.empty() ? 0 : view.nodes[view.regions[0].anchor_node].skin.joint[0];
}

struct Row {
  float most = 0, seconds = 0;
};

Row measure(const baker::LoadedPack& pack, const Event& event, const Stage& stage, float ordinary) {
  const std::vector<float> moved = played(pack, -kBefore_s, kAfter_s, [&](double t_s, const Act& act) {
    std::ranges::copy(stage.bind, act.joints.begin());
    event.act(t_s + 1e-6, stage, act);
  });
  const auto first = static_cast<size_t>(std::lround(kBefore_s / static_cast<double>(kDt_s)));
  Row row;
  for (size_t frame = first; frame < moved.size(); ++frame) {
    row.most = std::max(row.most, moved[frame]);
    if (moved[frame] > kPlay * ordinary) row.seconds = static_cast<float>(frame - first + 1) * kDt_s;
  }
  return row;
}

// ---- frame rates ----

constexpr double kShared_s = 0.2, kPlayed_s = 5;  // a frame of every rate ends at each of the former
constexpr int kReference = 240, kRates[] = {60, 30, 15, 10};

// What is shown at the shared times: where budget_us is 0, skinning.
std::vector<float> sampled(const baker::LoadedPack& pack, const baker::AuditMotion& motion, int fps,
                           float budget_us) {
  ShownPack shown(pack, budget_us);
  std::vector<Matrix34> joints(pack.view().joints.size());
  std::vector<float> out;
  const auto every = static_cast<int>(std::lround(kShared_s * fps));
  for (int frame = 0; frame <= std::floor(std::min(kPlayed_s, motion.moving_s) * fps); ++frame) {
    Pose pose{.joints = joints};
    motion.pose_at(static_cast<double>(frame) / fps, joints, &pose.root);
    const std::span<const float> positions =
        shown.step(pose, frame == 0 ? 0 : 1.0f / static_cast<float>(fps));
    if (frame % every == 0) out.insert(out.end(), positions.begin(), positions.end());
  }
  return out;
}

double apart(std::span<const float> a, std::span<const float> b) {
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += std::pow(double{a[i]} - double{b[i]}, 2);
  return std::sqrt(squares);
}

// The difference to 240 frames a second, a share of what these move; root mean squares.
double off_at(const baker::LoadedPack& pack, const baker::AuditMotion& motion, int fps) {
  constexpr float kAll_us = std::numeric_limits<float>::infinity();
  const std::vector<float> reference = sampled(pack, motion, kReference, kAll_us);
  return apart(sampled(pack, motion, fps, kAll_us), reference) /
         std::max(1e-9, apart(sampled(pack, motion, kReference, 0), reference));
}

// Of all clips, played through once at 60 frames a second: those in which something teleports.
std::string cuts_in_clips(const baker::LoadedPack& pack) {
  std::string out;
  std::vector<Matrix34> joints(pack.view().joints.size());
  for (size_t clip = 0; clip < pack.view().clips.size(); ++clip) {
    const baker::AuditMotion motion = baker::clip_motion(pack.view(), clip);
    ShownPack shown(pack);
    for (int frame = 0; frame < std::lround(60 * motion.moving_s); ++frame) {
      Pose pose{.joints = joints};
      motion.pose_at(frame / 60.0, joints, &pose.root);
      (void)shown.step(pose, kDt_s);
    }
    const InstanceReport report = shown.report();
    if (report.teleports + report.part_teleports > 0)
      out += " " + motion.name + " (" + std::to_string(report.teleports) + ", " +
             std::to_string(report.part_teleports) + ")";
  }
  return out.empty() ? " none" : out;
}

float median(std::vector<float> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

int run(int count, char** arguments) {
  constexpr const char* kHelp =
      "perf_events C.sinew [...]   how much vertices overshoot in snap turns, jumps of joints and stops";
  if (gives_help(count, arguments, kHelp)) return 0;
  try {
    if (count < 2) throw baker::BadInput("give packs; see --help");
    std::vector<baker::LoadedPack> packs;
    for (int i = 1; i < count; ++i) packs.push_back(baker::LoadedPack::from_file(arguments[i]));
    std::string head = "| event |", rule = "|---|";
    std::vector<float> ordinary;
    std::vector<std::vector<Matrix34>> binds;
    for (int i = 1; i < count; ++i) {
      const pack::PackView& view = packs[i - 1].view();
      const baker::AuditMotion bob = baker::bob_motion(view, 3, 0);
      ordinary.push_back(std::ranges::max(played(
          packs[i - 1], 0, 3, [&](double t_s, const Act& act) { bob.pose_at(t_s, act.joints, act.root); })));
      RootTransform root;
      bob.pose_at(0, binds.emplace_back(view.joints.size()), &root);
      head += " " + std::filesystem::path(arguments[i]).stem().string() + " |";
      rule += "---|";
    }
    const std::string rate_head =
        "| off 240 frames a second, fraction of the motion" + head.substr(std::string("| event").size());
    std::printf("%s median | worst | longest, s |\n%s---|---|---|\n| bob |", head.c_str(), rule.c_str());
    for (const float most : ordinary) std::printf(" %.3f |", static_cast<double>(most));
    std::printf(" %.3f | %.3f | |\n", static_cast<double>(median(ordinary)),
                static_cast<double>(std::ranges::max(ordinary)));
    for (const Event& event : all_events()) {
      std::printf("| %s |", event.name);
      std::vector<float> most;
      float longest = 0;
      for (size_t i = 0; i < packs.size(); ++i) {
        const pack::PackView& view = packs[i].view();
        const Row row =
            measure(packs[i], event, {binds[i], joint_of(view), view.character->height_m}, ordinary[i]);
        most.push_back(row.most);
        longest = std::max(longest, row.seconds);
        std::printf(" %.3f, %.2f s |", static_cast<double>(row.most), static_cast<double>(row.seconds));
        std::fflush(stdout);
      }
      std::printf(" %.3f | %.3f | %.2f |\n", static_cast<double>(median(most)),
                  static_cast<double>(std::ranges::max(most)), static_cast<double>(longest));
    }
    std::printf("\n%s median | worst |\n%s---|---|\n", rate_head.c_str(), rule.c_str());
    for (const bool clip : {false, true}) {
      for (const int fps : kRates) {
        std::printf("| %s, %d frames a second |", clip ? "liveliest clip" : "bob", fps);
        std::vector<float> off;
        for (const baker::LoadedPack& pack : packs) {
          const pack::PackView& view = pack.view();
          if (clip && view.clips.empty()) {
            std::printf(" |");
            continue;
          }
          off.push_back(static_cast<float>(off_at(pack,
                                                  clip ? baker::clip_motion(view, baker::liveliest_clip(view))
                                                       : baker::bob_motion(view, kPlayed_s, 0),
                                                  fps)));
          std::printf(" %.2f |", static_cast<double>(off.back()));
          std::fflush(stdout);
        }
        std::printf(" %.2f | %.2f |\n", static_cast<double>(median(off)),
                    static_cast<double>(std::ranges::max(off)));
      }
    }
    std::puts("\nClips in which the root or a part teleports (how often):");
    for (int i = 1; i < count; ++i)
      std::printf("- %s:%s\n", std::filesystem::path(arguments[i]).stem().c_str(),
                  cuts_in_clips(packs[i - 1]).c_str());
    return 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_events: %s\n", problem.what());
    return 2;
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) { return sinew::perf::run(count, arguments); }
