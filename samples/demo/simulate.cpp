// simulate.cpp  see simulate.hpp.
#include "samples/demo/simulate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/preview/pack_mesh.hpp"
#include "samples/demo/thread_pool.hpp"
#include "samples/demo/trace.hpp"
#include "samples/demo/turning_camera.hpp"

namespace sinew::demo {
namespace {

constexpr size_t kLargestCrowd = 100;  // in the picture
constexpr double kPhase_s = 0.37;      // between neighbours, so that no two move alike
constexpr size_t kKept = 24;           // snapshots of a run that is not filmed

using Positions = std::vector<Eigen::Vector3f>;
using Clock = std::chrono::steady_clock;

float microseconds_since(Clock::time_point start) {
  return std::chrono::duration<float, std::micro>(Clock::now() - start).count();
}

void require(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

ReadDef read_into(Positions& positions, Space space) {
  return {.space = space,
          .out = positions.data()->data(),
          .stride_bytes = sizeof(Eigen::Vector3f),
          .capacity = positions.size()};
}

// A world, its asset and its instances, moved together.
class Stage {
 public:
  // instance: what all are made from.
  Stage(const CharacterFile& character, const WorldDef& def, double budget_us, const InstanceDef& instance)
      : def_(instance), joints_(character.view.joints.size()) {
    def_.contacts.own_body &= !character.view.proxies.empty();
    require(World::create(def, &world_));
    require(world_.load_asset_file(character.path.c_str(), &asset_));
    require(world_.asset_info(asset_, &info_));
    if (def_.rod_start == RodWarmStart::kLearned && !info_.rod_network)
      throw baker::BadInput(character.path + ": --start learned: " +
                            (info_.rod_count == 0
                                 ? "no rods in it"
                                 : "no network for its rods in it; bake it with --rods W.safetensors"));
    require(world_.set_budget_us(static_cast<float>(budget_us)));
  }

  // Nearer instances (those added first) matter more.
  void add(const RootTransform& place, float importance) {
    InstanceDef def = def_;
    def.asset = asset_;
    def.importance = importance;
    def.root = place;
    InstanceId id;
    require(world_.create_instance(def, &id));
    instances_.push_back(id);
    places_.push_back(place);
  }

  // The motion happens at the instance's place on the floor.
  void pose(size_t instance, const Motion& motion, double t_s) {
    RootTransform root;
    motion.pose_at(t_s, joints_, &root);
    for (int i = 0; i < 3; ++i) root.position_m[i] += places_[instance].position_m[i];
    require(world_.set_pose(instances_[instance], {.joints = joints_, .root = root}));
  }

  void read(size_t instance, Space space, Positions& out) const {
    require(world_.read_positions(instances_[instance], read_into(out, space)));
  }

  InstanceReport report(size_t instance) const {
    InstanceReport out;
    require(world_.report(instances_[instance], &out));
    return out;
  }

  void look(const View& view) { require(world_.set_views({&view, 1})); }
  FrameReport step(double dt_s) { return world_.step(static_cast<float>(dt_s)); }
  size_t size() const { return instances_.size(); }
  bool contacts() const { return def_.contacts.own_body; }
  const AssetInfo& info() const { return info_; }

 private:
  World world_;
  AssetId asset_;
  AssetInfo info_;
  InstanceDef def_;
  std::vector<InstanceId> instances_;
  std::vector<RootTransform> places_;
  std::vector<Matrix34> joints_;
};

// A square grid, first row in front (+Z towards the viewer), the first instance at the origin.
RootTransform place_on_floor(int index, int count, double spacing_m) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const int row = index / columns, column = index % columns;
  const double side = (column + 1) / 2 * (column % 2 == 0 ? 1.0 : -1.0);
  return {.position_m = {side * spacing_m, 0, -row * spacing_m}};
}

double spacing_of(const CharacterFile& character) {
  const render::Mesh mesh = baker::bind_mesh(character.view);
  const Eigen::Vector3f size = render::bounding_box(mesh.positions).sizes();
  return 1.25 * static_cast<double>(std::max({size.x(), size.z(), 0.3f * size.y()}));
}

InstanceDef instance_of(const Options& options) {
  InstanceDef def;
  def.contacts.own_body = options.contacts;
  def.report_rod_residual = !options.start.empty();
  if (options.start == "continued") def.rod_start = RodWarmStart::kContinued;
  if (options.start == "learned") def.rod_start = RodWarmStart::kLearned;
  return def;
}

void fill_stage(Stage& stage, int count, double spacing_m) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (int i = 0; i < count; ++i)
    stage.add(place_on_floor(i, count, spacing_m), 1.0f / static_cast<float>(1 + i / columns));
}

float mean_distance_mm(const Positions& a, const Positions& b, std::span<const uint32_t> vertices) {
  double sum = 0;
  for (const uint32_t v : vertices) sum += static_cast<double>((a[v] - b[v]).norm());
  return vertices.empty() ? 0 : static_cast<float>(1000 * sum / static_cast<double>(vertices.size()));
}

// The second world: the same character under a budget of nothing, which is skinning alone.
class Witness {
 public:
  Witness(const CharacterFile& character, const Motion& motion)
      : stage_(character, {.max_assets = 1, .max_instances = 1}, 0, {}),
        motion_(motion),
        parts_(baker::parts_of(character.view)),
        skinned_(stage_.info().vertex_count) {
    stage_.add({}, 1);
    for (const baker::Part& part : parts_)
      motions_.push_back({.name = part.name, .is_rod = part.is_rod, .frequency_hz = part.frequency_hz});
  }

  // Every frame, in its order.
  void watch(double t_s, double dt_s, const Positions& sinew) {
    follow(t_s, dt_s);
    for (size_t p = 0; p < parts_.size(); ++p)
      motions_[p].largest_mm = std::max(motions_[p].largest_mm, largest_mm(parts_[p], skinned_, sinew));
  }
  void watch_still(double t_s, double dt_s, const Positions& sinew) {
    follow(t_s, dt_s);
    for (size_t p = 0; p < parts_.size(); ++p) motions_[p].still_mm = largest_mm(parts_[p], skinned_, sinew);
  }

  const Positions& skinned() const { return skinned_; }  // as last watched
  Snapshot snapshot(double t_s, const Positions& sinew) const {
    Snapshot out{.time_s = t_s, .motion = motion_.name_at(t_s), .skinned = skinned_, .sinew = sinew};
    std::vector<Matrix34> joints(stage_.info().joint_count);
    motion_.pose_at(t_s, joints, &out.root);
    return out;
  }
  const std::vector<PartMotion>& motions() const { return motions_; }

 private:
  void follow(double t_s, double dt_s) {
    stage_.pose(0, motion_, t_s);
    stage_.step(dt_s);
    stage_.read(0, Space::kCharacter, skinned_);
  }

  Stage stage_;
  const Motion& motion_;
  std::vector<baker::Part> parts_;
  Positions skinned_;
  std::vector<PartMotion> motions_;
};

// The first instance's surface against ground truth.
class Judge {
 public:
  Judge(const CharacterFile& character, const Trajectory& truth)
      : truth_(truth), soft_(soft_vertices(character)), positions_(character.view.character->vertex_count) {}

  Error error(double t_s, const Positions& skinned, const Positions& sinew) {
    truth_.positions_at(t_s, positions_);
    return {mean_distance_mm(skinned, positions_, soft_), mean_distance_mm(sinew, positions_, soft_)};
  }
  const Positions& positions() const { return positions_; }

 private:
  const Trajectory& truth_;
  std::vector<uint32_t> soft_;
  Positions positions_;
};

FrameRecord run_frame(Stage& stage, const Motion& first, const Motion& others, double t_s, double dt_s,
                      Positions& positions) {
  FrameRecord record{.time_s = t_s};
  const Clock::time_point before_poses = Clock::now();
  for (size_t i = 0; i < stage.size(); ++i)
    stage.pose(i, i == 0 ? first : others, t_s + kPhase_s * static_cast<double>(i));
  record.poses_us = microseconds_since(before_poses);
  record.step = stage.step(dt_s);
  record.first = stage.report(0);
  const Clock::time_point before_reads = Clock::now();
  for (size_t i = stage.size(); i-- > 0;) stage.read(i, Space::kCharacter, positions);  // ends with the first
  record.read_us = microseconds_since(before_reads);
  return record;
}

// The frames of which pictures may be made: as many as a film takes, else a few, evenly spread.
bool is_kept(size_t frame, size_t frames, const Options& options) {
  if (options.frames.empty()) return false;
  if (options.picture_fps > 0)
    return frame % static_cast<size_t>(std::max(1.0, std::round(options.fps / options.picture_fps))) == 0;
  return (frame + 1) * kKept / frames != frame * kKept / frames;
}

// All poses stay as they are, and what moves comes to rest.
void hold_still(Stage& stage, Witness& witness, double t_s, const Options& options, Positions& positions) {
  const auto frames = static_cast<size_t>(std::llround(kStill_s * options.fps));
  for (size_t frame = 0; frame < frames; ++frame) {
    stage.step(1 / options.fps);
    stage.read(0, Space::kCharacter, positions);
    witness.watch_still(t_s, 1 / options.fps, positions);
  }
}

void count_guards(const Stage& stage, Run& run) {
  for (size_t i = 0; i < stage.size(); ++i) {
    const InstanceReport report = stage.report(i);
    run.input_clamps += report.input_clamps;
    run.displacement_clamps += report.displacement_clamps;
    run.restarts += report.restarts;
  }
}

void count_reasons(const Stage& stage, Run& run) {
  for (size_t i = 0; i < stage.size(); ++i) ++run.reasons[static_cast<size_t>(stage.report(i).why)];
}

std::vector<CrowdMember> look_at_crowd(const Stage& stage) {
  std::vector<CrowdMember> crowd(std::min(stage.size(), kLargestCrowd));
  for (size_t i = 0; i < crowd.size(); ++i) {
    const InstanceReport report = stage.report(i);
    crowd[i] = {report.tier, report.why == TierReason::kHidden, Positions(stage.info().vertex_count)};
    stage.read(i, Space::kWorld, crowd[i].positions);
  }
  return crowd;
}

}  // namespace

Run simulate(const CharacterFile& character, const Motion& motion, const Trajectory* truth,
             const Options& options) {
  ThreadPool pool(options.threads);
  const auto count = static_cast<uint32_t>(options.instances);
  Trace trace(!options.trace.empty());
  Stage stage(character,
              {.max_assets = 1, .max_instances = count, .tasks = pool.hook(), .profiler = trace.hook()},
              options.budget_us, instance_of(options));
  const double spacing_m = spacing_of(character), height_m = static_cast<double>(stage.info().height_m);
  fill_stage(stage, options.instances, spacing_m);
  const Motion& first = truth != nullptr ? *truth : motion;
  Witness witness(character, first);
  std::optional<Judge> judge;
  if (truth != nullptr) judge.emplace(character, *truth);
  const auto frames = static_cast<size_t>(std::llround(options.seconds * options.fps)) + 1;

  Run run{.asset = stage.info(),
          .instances = options.instances,
          .contacts = stage.contacts(),
          .fps = options.fps};
  run.frames.reserve(frames);
  Positions positions(stage.info().vertex_count);
  baker::Progress progress("simulating", frames);
  const double dt_s = 1 / options.fps;
  for (size_t frame = 0; frame < frames; ++frame) {
    const double t_s = static_cast<double>(frame) / options.fps;
    trace.begin_frame();
    if (options.camera) stage.look(turning_camera(t_s, height_m, spacing_m));
    run.frames.push_back(run_frame(stage, first, motion, t_s, dt_s, positions));
    count_reasons(stage, run);
    witness.watch(t_s, dt_s, positions);
    if (judge) run.frames.back().error = judge->error(t_s, witness.skinned(), positions);
    if (is_kept(frame, frames, options)) {
      run.snapshots.push_back(witness.snapshot(t_s, positions));
      run.snapshots.back().error = run.frames.back().error;
      if (judge) run.snapshots.back().truth = judge->positions();
    }
    progress.update(frame + 1);
  }
  count_guards(stage, run);
  if (!options.trace.empty()) trace.write(options.trace);
  if (!options.frames.empty() && stage.size() > 1) run.crowd = look_at_crowd(stage);
  hold_still(stage, witness, static_cast<double>(frames - 1) / options.fps, options, positions);
  run.parts = witness.motions();
  return run;
}

}  // namespace sinew::demo
