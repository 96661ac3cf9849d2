// main.cpp  How smooth packs' secondary motion is between ticks, as a table.
//
//   perf_between C.sinew [...]
//   perf_between --moves OUT.csv C.sinew    the largest move of each frame of the bob, for perf/between.py
//
// A displacement is how far a vertex is from where skinning alone has it, in the character's axes; its move
// is from one frame to the next. Played are a bob of the root (5 % of the height at 2 Hz) and the liveliest
// clip, on the best tier.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/audit/motions.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "perf/help.hpp"
#include "perf/shown_pack.hpp"

namespace sinew::perf {
namespace {

constexpr double kPlayed_s = 4, kSettled_s = 0.5;

// Through samples at 60 Hz as a uniform cubic B-spline: keys leave kinks in a pose's path, which its flesh
// shows.
baker::AuditMotion rounded(const baker::AuditMotion& motion) {
  baker::AuditMotion out = motion;
  out.pose_at = [motion](double t_s, std::span<Matrix34> joints, RootTransform* root) {
    const double at = t_s * 60, x = at - std::floor(at), y = 1 - x;
    const double weights[] = {y * y * y / 6, (4 - 6 * x * x + 3 * x * x * x) / 6,
                              (4 - 6 * y * y + 3 * y * y * y) / 6, x * x * x / 6};
    std::vector<Matrix34> sample(joints.size());
    std::ranges::fill(joints, Matrix34{});
    for (Matrix34& joint : joints)
      for (auto& row : joint.m) std::ranges::fill(row, 0.0f);
    for (int k = 0; k < 4; ++k) {
      motion.pose_at(std::max(0.0, (std::floor(at) + k - 1) / 60), sample, root);
      for (size_t j = 0; j < joints.size(); ++j)
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 4; ++c) joints[j].m[r][c] += static_cast<float>(weights[k]) * sample[j].m[r][c];
    }
    motion.pose_at(t_s, sample, root);
  };
  return out;
}

struct Frame {
  double t_s;
  float dt_s;
};

// [frames][vertices][3]; a pose every so many frames.
using Shown = std::vector<std::vector<float>>;

Shown displacements(const baker::LoadedPack& pack, const baker::AuditMotion& motion,
                    std::span<const Frame> frames, int every = 1) {
  ShownPack moved(pack), skinned(pack, 0);
  std::vector<Matrix34> joints(pack.view().joints.size());
  Shown out;
  for (size_t f = 0; f < frames.size(); ++f) {
    Pose pose{.joints = joints};
    motion.pose_at(frames[f].t_s, joints, &pose.root);
    std::span<const float> a, b;
    if (f % static_cast<size_t>(every) == 0) {
      a = moved.step(pose, frames[f].dt_s), b = skinned.step(pose, frames[f].dt_s);
    } else {
      for (ShownPack* each : {&moved, &skinned}) each->skip(frames[f].dt_s);
      a = moved.read(), b = skinned.read();
    }
    std::vector<float>& d = out.emplace_back(a.size());
    for (size_t i = 0; i < d.size(); ++i) d[i] = a[i] - b[i];
  }
  return out;
}

// The first is a step of no time, so that frames of all rates that divide one another coincide.
std::vector<Frame> frames_at(double fps, double seconds) {
  std::vector<Frame> out;
  for (int f = 0; f <= std::lround(seconds * fps); ++f)
    out.push_back({f / fps, f == 0 ? 0 : static_cast<float>(1 / fps)});
  return out;
}

float length(const float* v) { return std::hypot(v[0], v[1], v[2]); }

float largest(std::span<const float> d) {
  float most = 0;
  for (size_t i = 0; i < d.size(); i += 3) most = std::max(most, length(&d[i]));
  return most;
}

float largest_move(std::span<const float> a, std::span<const float> b) {
  float most = 0;
  for (size_t i = 0; i < a.size(); i += 3)
    most = std::max(most, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return most;
}

// The largest move of a frame over those of the frames beside it, where a tenth of the usual move is made.
float judder(const Shown& shown, size_t first) {
  std::vector<float> moves;
  for (size_t f = first; f < shown.size(); ++f) moves.push_back(largest_move(shown[f], shown[f - 1]));
  std::vector<float> sorted = moves;
  std::ranges::sort(sorted);
  const float least = 0.1f * sorted[sorted.size() / 2];
  float most = 1;
  for (size_t f = 1; f + 1 < moves.size(); ++f) {
    const float beside = std::max(moves[f - 1], moves[f + 1]);
    if (beside > least) most = std::max(most, moves[f] / beside);
  }
  return most;
}

float judder_at(const baker::LoadedPack& pack, const baker::AuditMotion& motion, double fps, double seconds) {
  const Shown shown = displacements(pack, motion, frames_at(fps, kSettled_s + seconds));
  return judder(shown, static_cast<size_t>(kSettled_s * fps) + 1);
}

// As it would be shown with the last tick's velocity carried on, at 240 frames a second.
Shown carried_on(const Shown& shown) {
  constexpr size_t kFrames = 4;
  Shown out(shown.begin(), shown.begin() + kFrames);
  for (size_t f = kFrames; f < shown.size(); ++f) {
    const size_t tick = f - f % kFrames;
    const float x = static_cast<float>(f % kFrames) / kFrames;
    std::vector<float>& d = out.emplace_back(shown[tick]);
    for (size_t i = 0; i < d.size(); ++i) d[i] += x * (shown[tick][i] - shown[tick - kFrames][i]);
  }
  return out;
}

float judder_carried_on(const baker::LoadedPack& pack, const baker::AuditMotion& motion) {
  constexpr double kFps = 240, kLooked_s = 1.5;
  const Shown shown = displacements(pack, motion, frames_at(kFps, kSettled_s + kLooked_s));
  return judder(carried_on(shown), static_cast<size_t>(kSettled_s * kFps) + 1);
}

// At a fiftieth of the speed, once it moves.
float judder_slow(const baker::LoadedPack& pack, const baker::AuditMotion& motion) {
  constexpr double kBegins_s = 1, kFps = 60 * 50;
  std::vector<Frame> frames = frames_at(60, kBegins_s);
  const size_t first = frames.size() + 100;
  for (int f = 1; f <= 1000; ++f) frames.push_back({kBegins_s + f / kFps, static_cast<float>(1 / kFps)});
  return judder(displacements(pack, motion, frames), first);
}

double apart(const Shown& a, size_t every_a, const Shown& b, size_t every_b) {
  double squares = 0;
  for (size_t f = 0; f * every_a < a.size() && f * every_b < b.size(); ++f)
    for (size_t i = 0; i < a[0].size(); ++i)
      squares += std::pow(double{a[f * every_a][i]} - double{b[f * every_b][i]}, 2);
  return std::sqrt(squares);
}

// The difference to 60 frames a second at frames that both have, a share of the displacement there.
float off_60(const baker::LoadedPack& pack, const baker::AuditMotion& motion, int fps) {
  constexpr int kShared = 6;  // a second: of all rates
  const double seconds = std::min(kPlayed_s, motion.moving_s);
  const Shown at_60 = displacements(pack, motion, frames_at(60, seconds)),
              other = displacements(pack, motion, frames_at(fps, seconds));
  const Shown none(at_60.size(), std::vector<float>(at_60[0].size()));
  return static_cast<float>(apart(other, static_cast<size_t>(fps / kShared), at_60, 60 / kShared) /
                            std::max(1e-12, apart(none, 60 / kShared, at_60, 60 / kShared)));
}

float peak(const Shown& shown) {
  float most = 0;
  for (const auto& each : shown) most = std::max(most, largest(each));
  return most;
}

float sparse_peak(const baker::LoadedPack& pack, const baker::AuditMotion& motion, int every) {
  const std::vector<Frame> frames = frames_at(60, std::min(kPlayed_s, motion.moving_s));
  return peak(displacements(pack, motion, frames, every)) /
         std::max(1e-9f, peak(displacements(pack, motion, frames)));
}

// The root to and fro by half a metre every sixtieth of a second, at 144 frames a second; and at 60, where
// all frames are ticks. Shares of the height.
std::array<float, 2> shaken(const baker::LoadedPack& pack) {
  const baker::AuditMotion bind = baker::bob_motion(pack.view(), 1, 1);
  const baker::AuditMotion shake{
      "shake", 2, 0, [&](double t_s, std::span<Matrix34> joints, RootTransform* root) {
        bind.pose_at(0, joints, root);
        root->position_m[0] = std::lround(std::floor(t_s * 60 + 1e-6)) % 2 == 0 ? 0 : 0.5;
      }};
  std::array<float, 2> out{};
  for (const int k : {0, 1})
    out[static_cast<size_t>(k)] =
        peak(displacements(pack, shake, frames_at(k == 0 ? 144 : 60, 2))) / pack.view().character->height_m;
  return out;
}

// Of a step between ticks over that of one on a tick, at 240 frames a second; medians. The first in us.
std::array<float, 2> costs(const baker::LoadedPack& pack, const baker::AuditMotion& motion) {
  ShownPack shown(pack);
  std::vector<Matrix34> joints(pack.view().joints.size());
  std::vector<float> on, between;
  const std::vector<Frame> frames = frames_at(240, 8);
  for (const Frame& frame : frames) {
    Pose pose{.joints = joints};
    motion.pose_at(std::fmod(frame.t_s, motion.moving_s), joints, &pose.root);
    must(shown.world().set_pose(shown.instance(), pose));
    const auto begin = std::chrono::steady_clock::now();
    const FrameReport report = shown.world().step(frame.dt_s);
    const std::chrono::duration<float, std::micro> took = std::chrono::steady_clock::now() - begin;
    (report.ticks > 0 ? on : between).push_back(took.count());
  }
  std::ranges::sort(on);
  std::ranges::sort(between);
  return {on[on.size() / 2], between[between.size() / 2]};
}

// ---- the table ----

using Measure = std::function<float(const baker::LoadedPack&, const baker::AuditMotion&)>;
struct Row {
  std::string name;
  Measure measure;
  bool clip = true;     // of the liveliest clip as well
  bool rounds = false;  // with its kinks rounded
};

std::vector<Row> all_rows() {
  std::vector<Row> rows = {
      {"judder at 240 frames a second", [](auto& pack, auto& m) { return judder_at(pack, m, 240, 1.5); },
       true, true},
      {"judder at 240 with the last velocity extrapolated", judder_carried_on, true, true},
      {"judder at 144 frames a second", [](auto& pack, auto& m) { return judder_at(pack, m, 144, 1.5); },
       true, true},
      {"judder at a fiftieth of the speed", [](auto& pack, auto& m) { return judder_slow(pack, m); }, true,
       true}};
  for (const int fps : {30, 120, 144, 240})
    rows.push_back({std::to_string(fps) + " frames a second, off 60",
                    [=](auto& pack, auto& m) { return off_60(pack, m, fps); }});
  for (const int every : {2, 4})
    rows.push_back({"peak with a pose every " + std::to_string(every) + " frames over that with every pose",
                    [=](auto& pack, auto& m) { return sparse_peak(pack, m, every); }});
  rows.push_back({"frame on a tick, us", [](auto& pack, auto& m) { return costs(pack, m)[0]; }, false});
  rows.push_back({"frame between ticks over that",
                  [](auto& pack, auto& m) {
                    const auto [on, between] = costs(pack, m);
                    return between / on;
                  },
                  false});
  rows.push_back({"shaken by 0.5 m at 144 frames a second, of the height",
                  [](auto& pack, auto&) { return shaken(pack)[0]; }, false});
  rows.push_back({"the same at 60", [](auto& pack, auto&) { return shaken(pack)[1]; }, false});
  return rows;
}

void print_row(const std::string& name, std::vector<float> values, const std::vector<std::string>& cells) {
  std::printf("| %s |", name.c_str());
  for (const std::string& cell : cells) std::printf(" %s |", cell.c_str());
  std::ranges::sort(values);
  std::printf(" %.3g | %.3g |\n", static_cast<double>(values[values.size() / 2]),
              static_cast<double>(values.back()));
  std::fflush(stdout);
}

void measure_row(const Row& row, bool clip, const std::vector<baker::LoadedPack>& packs) {
  std::vector<float> values;
  std::vector<std::string> cells;
  for (const baker::LoadedPack& pack : packs) {
    const pack::PackView& view = pack.view();
    if (clip && view.clips.empty()) {
      cells.emplace_back();
      continue;
    }
    const baker::AuditMotion motion =
        clip ? baker::clip_motion(view, baker::liveliest_clip(view)) : baker::bob_motion(view, 8, 0);
    values.push_back(row.measure(pack, clip && row.rounds ? rounded(motion) : motion));
    char cell[32];
    std::snprintf(cell, sizeof cell, "%.3g", static_cast<double>(values.back()));
    cells.emplace_back(cell);
  }
  if (!values.empty()) print_row((clip ? "liveliest clip, " : "bob, ") + row.name, values, cells);
}

// ---- moves for a picture ----

void write_moves(const char* name, const Shown& shown, std::span<const Frame> frames, float height_m,
                 std::FILE* out) {
  constexpr double kFrom_s = 1;
  for (size_t f = 1; f < shown.size(); ++f)
    if (frames[f].t_s >= kFrom_s && frames[f].dt_s > 0)
      std::fprintf(out, "%s,%.6f,%.6g\n", name, frames[f].t_s - static_cast<double>(frames[f].dt_s) / 2,
                   static_cast<double>(largest_move(shown[f], shown[f - 1]) / frames[f].dt_s / height_m));
}

void write_all_moves(const baker::LoadedPack& pack, std::FILE* out) {
  constexpr double kBegins_s = 1, kSlow_fps = 60 * 50;
  const baker::AuditMotion bob = baker::bob_motion(pack.view(), 8, 0);
  const float height_m = pack.view().character->height_m;
  std::fputs("frames,t_s,heights_per_s\n", out);
  for (const int fps : {24, 30, 60, 144, 240}) {
    const std::vector<Frame> frames = frames_at(fps, 2);
    const Shown shown = displacements(pack, bob, frames);
    write_moves(std::to_string(fps).c_str(), shown, frames, height_m, out);
    if (fps == 240) write_moves("240 before", carried_on(shown), frames, height_m, out);
  }
  std::vector<Frame> frames = frames_at(60, kBegins_s);
  for (int f = 1; f <= 900; ++f)
    frames.push_back({kBegins_s + f / kSlow_fps, static_cast<float>(1 / kSlow_fps)});
  write_moves("slow", displacements(pack, bob, frames), frames, height_m, out);
}

int run(int count, char** arguments) {
  constexpr const char* kHelp =
      "perf_between C.sinew [...]   how smooth what is shown between ticks is\n"
      "perf_between --moves OUT.csv C.sinew   each frame's largest move, for perf/between.py";
  if (gives_help(count, arguments, kHelp)) return 0;
  try {
    if (count < 2) throw baker::BadInput("give packs; see --help");
    if (std::string(arguments[1]) == "--moves") {
      if (count != 4) throw baker::BadInput("--moves takes a file to write and a pack; see --help");
      const baker::LoadedPack pack = baker::LoadedPack::from_file(arguments[3]);
      const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(arguments[2], "w"), std::fclose);
      if (!out) throw baker::BadInput(std::string(arguments[2]) + " cannot be written");
      write_all_moves(pack, out.get());
      return 0;
    }
    std::vector<baker::LoadedPack> packs;
    std::string head = "| |", rule = "|---|";
    for (int i = 1; i < count; ++i) {
      packs.push_back(baker::LoadedPack::from_file(arguments[i]));
      head += " " + std::filesystem::path(arguments[i]).stem().string() + " |";
      rule += "---|";
    }
    std::printf("%s median | worst |\n%s---|---|\n", head.c_str(), rule.c_str());
    for (const Row& row : all_rows())
      for (const bool clip : {false, true})
        if (!clip || row.clip) measure_row(row, clip, packs);
    return 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_between: %s\n", problem.what());
    return 2;
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) { return sinew::perf::run(count, arguments); }
