// characters.cpp  What a learned start is worth on characters' own rods, as a table.
//
//   perf_rod_characters C.sinew [...]
//
// Packs baked with --rods. Every pack plays its clips (the first five), a bob, a jump, a run and a spin,
// three seconds each, once in a world a start and a number of iterations; all worlds of a pack are stepped
// one after the other in each tick, so that what else runs on the machine meets them alike. Times are the
// thread's own, medians over ticks, of worlds that report no residual. After each motion the root is put ten
// metres aside: the tick after that has no past to continue from, and is told apart.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "baker/audit/motions.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "perf/help.hpp"
#include "sinew/world.hpp"

namespace sinew::perf {
namespace {

constexpr double kSeconds = 3;
constexpr size_t kClips = 5;
constexpr uint32_t kMost[] = {12, 4, 2, 1};
constexpr int kBlindTicks = 6;  // in which no start knows anything

uint64_t thread_ns(void*) {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<uint64_t>(now.tv_nsec);
}

void must(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

// One instance of a start, and what its ticks took.
class Rig {
 public:
  Rig(const baker::LoadedPack& pack, RodWarmStart start, uint32_t most, bool residual) {
    must(World::create(
        {.max_assets = 1, .max_instances = 1, .sleep_tolerance = 0, .clock = {.now_ns = thread_ns}},
        &world_));
    AssetId asset;
    must(world_.load_asset(pack.bytes(), &asset));
    must(world_.asset_info(asset, &info_));
    must(world_.create_instance({.asset = asset,
                                 .contacts = {.own_body = true},
                                 .rod_start = start,
                                 .max_rod_iterations = most,
                                 .report_rod_residual = residual},
                                &instance_));
  }

  // age: ticks since its past was lost.
  void step(const Pose& pose, int age) {
    must(world_.set_pose(instance_, pose));
    const FrameReport frame = world_.step(1 / info_.tick_hz);
    InstanceReport report;
    must(world_.report(instance_, &report));
    const bool touches_anew = report.rod_contacts > contacts_;
    contacts_ = report.rod_contacts;
    if (age == 0) first_.push_back(static_cast<double>(report.rod_residual));
    if (age < kBlindTicks) return;
    if (touches_anew) touching_.push_back(static_cast<double>(report.rod_iterations) / info_.rod_count);
    us_.push_back(static_cast<double>(frame.rods_us));
    iterations_.push_back(static_cast<double>(report.rod_iterations) / info_.rod_count);
    residuals_.push_back(static_cast<double>(report.rod_residual));
  }

  double us() const { return quantile(us_, 0.5); }
  double iterations() const { return mean(iterations_); }
  // Of ticks in which more comes near than was near before.
  double iterations_touching() const { return mean(touching_); }
  double residual() const { return quantile(residuals_, 0.5); }
  double residual_p95() const { return quantile(residuals_, 0.95); }
  double first_residual() const { return quantile(first_, 0.5); }

 private:
  World world_;
  InstanceId instance_;
  AssetInfo info_;
  uint32_t contacts_ = 0;
  std::vector<double> us_, iterations_, touching_, residuals_, first_;
};

std::vector<baker::AuditMotion> motions_of(const pack::PackView& view) {
  std::vector<baker::AuditMotion> motions = baker::root_motions(view);
  motions.push_back(baker::bob_motion(view, kSeconds, 0));
  for (size_t clip = 0; clip < std::min(kClips, view.clips.size()); ++clip)
    motions.push_back(baker::clip_motion(view, clip));
  return motions;
}

struct Contender {
  RodWarmStart start;
  uint32_t most;
  std::unique_ptr<Rig> timed, judged;
};

std::vector<Contender> contenders_of(const baker::LoadedPack& pack) {
  std::vector<Contender> out;
  for (const uint32_t most : kMost)
    for (const RodWarmStart start : {RodWarmStart::kContinued, RodWarmStart::kLearned})
      out.push_back({start, most, std::make_unique<Rig>(pack, start, most, false),
                     std::make_unique<Rig>(pack, start, most, true)});
  return out;
}

void play(const baker::AuditMotion& motion, double tick_s, double aside_m, std::span<Matrix34> joints,
          std::vector<Contender>& contenders) {
  for (int tick = 0; tick * tick_s < kSeconds; ++tick) {
    Pose pose{.joints = joints};
    motion.pose_at(tick * tick_s, joints, &pose.root);
    pose.root.position_m[0] += aside_m;
    for (Contender& who : contenders) {
      who.timed->step(pose, tick);
      who.judged->step(pose, tick);
    }
  }
}

void measure(const std::string& path) {
  const baker::LoadedPack pack = baker::LoadedPack::from_file(path);
  const pack::PackView& view = pack.view();
  if (view.rods.empty() || !view.rod_network.record)
    throw baker::BadInput(path +
                          ": no rods, or no network for them; bake it with sinew-bake character --rods");
  std::vector<Contender> contenders = contenders_of(pack);
  std::vector<Matrix34> joints(view.joints.size());
  double aside_m = 0;
  for (const baker::AuditMotion& motion : motions_of(view))
    play(motion, 1 / static_cast<double>(view.network->rate_hz), aside_m += 10, joints, contenders);
  const std::string name = std::filesystem::path(path).stem().string();
  for (const Contender& who : contenders)
    std::printf("| %s, %zu rods | %u | %s | %.2f, %.2f | %.2f | %.1e, %.1e | %.1e |\n", name.c_str(),
                view.rods.size(), who.most, who.start == RodWarmStart::kLearned ? "learned" : "continued",
                who.timed->iterations(), who.timed->iterations_touching(),
                who.timed->us() / static_cast<double>(view.rods.size()), who.judged->residual(),
                who.judged->residual_p95(), who.judged->first_residual());
}

int run(int count, char** arguments) {
  constexpr const char* kHelp =
      "perf_rod_characters C.sinew [...]   what a learned start is worth on packs' rods (baked with --rods)";
  if (gives_help(count, arguments, kHelp)) return 0;
  try {
    if (count < 2) throw baker::BadInput("give packs; see --help");
    std::puts(
        "| character | iterations at most | start | iterations a rod and tick, where contacts begin | us a "
        "rod and tick | "
        "residual, median, "
        "95th percentile | of the first tick |\n|---|---|---|---|---|---|---|");
    for (int i = 1; i < count; ++i) measure(arguments[i]);
    return 0;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "perf_rod_characters: %s\n", problem.what());
    return 2;
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) { return sinew::perf::run(count, arguments); }
