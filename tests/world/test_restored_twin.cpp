// test_restored_twin.cpp  Whatever calls made of an instance, what is restored of it goes on as it does.
#include <numeric>
#include <random>
#include <set>

#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

struct Kind {
  const char* name;
  scenes::BlockOptions options;
  ContactDef contacts = {};
  double arms_way_m = 0;  // of the third bone and those after it, to and fro
};

// Hides some places from some others, always the same ones.
struct Fence final : OcclusionSource {
  bool is_blocked(const double (&from_m)[3], const double (&to_m)[3]) noexcept override {
    return std::sin(37 * to_m[0] + 23 * to_m[1] + 11 * to_m[2] + from_m[2]) > -0.5;
  }
};
Fence fence;

// The creature of a test: the original in one world, its twin in another.
struct Side {
  World world;
  AssetId asset;
  AssetInfo info;
  InstanceId blocks[2];

  Side(const scenes::PackBytes& pack, const ContactDef& contacts) {
    REQUIRE(
        World::create({.budget_mode = BudgetMode::kWorkUnits, .occlusion = &fence, .sight_rays_per_step = 8},
                      &world)
            .ok());
    const Status loaded = world.load_asset(pack.bytes(), &asset);
    INFO(loaded.message);
    REQUIRE(loaded.ok());
    REQUIRE(world.asset_info(asset, &info).ok());
    for (InstanceId& block : blocks)
      REQUIRE(world.create_instance({.asset = asset, .contacts = contacts}, &block).ok());
  }

  std::vector<std::byte> save() const {
    const size_t bytes = world.state_bytes(blocks[0]);
    std::vector<std::byte> out(2 * bytes);
    for (size_t i = 0; i < 2; ++i)
      REQUIRE(world.save_state(blocks[i], std::span(out).subspan(i * bytes, bytes)).ok());
    return out;
  }
  void restore(const std::vector<std::byte>& saved) {
    const size_t bytes = saved.size() / 2;
    for (size_t i = 0; i < 2; ++i)
      REQUIRE(world.restore_state(blocks[i], std::span(saved).subspan(i * bytes, bytes)).ok());
  }

  // All that can be read, in bits.
  struct Read {
    std::vector<float> places, normals;
    std::vector<Matrix34> joints;
    InstanceReport report;
  };
  InstanceReport report(size_t index) const {
    InstanceReport out;
    REQUIRE(world.report(blocks[index], &out).ok());
    return out;
  }
  Read read(size_t index) const {
    const InstanceId block = blocks[index];
    Read out;
    const uint32_t vertices = info.vertex_count;
    out.places.resize(size_t{9} * vertices);
    out.normals.resize(size_t{3} * vertices);
    out.joints.resize(info.joint_count);
    float* to = out.places.data();
    for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
      REQUIRE(world.read_positions(block, {.space = space, .out = to, .capacity = vertices}).ok());
      to += size_t{3} * vertices;
    }
    REQUIRE(world.read_normals(block, {.out = out.normals.data(), .capacity = vertices}).ok());
    REQUIRE(world.read_joint_matrices(block, out.joints).ok());
    out.report = report(index);
    return out;
  }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// What is not the same, or nothing.
std::string difference(const Side::Read& a, const Side::Read& b, bool stepped) {
  if (!same_bits(a.joints, b.joints)) {
    float most = 0;
    for (size_t j = 0; j < a.joints.size(); ++j)
      for (int k = 0; k < 3; ++k) most = std::max(most, std::fabs(a.joints[j].m[k][3] - b.joints[j].m[k][3]));
    return "joints, by " + std::to_string(most) + " m";
  }
  if (!same_bits(a.places, b.places))
    return "positions, by " + std::to_string(largest_distance(a.places, b.places)) + " m";
  if (!same_bits(a.normals, b.normals)) return "normals";
  const InstanceReport &x = a.report, &y = b.report;
  if (x.tier != y.tier) return "tier";
  if (x.graph_level != y.graph_level) return "graph_level";
  if (x.blend != y.blend) return "blend";
  if (x.hidden != y.hidden || x.dormant != y.dormant) return "hidden or dormant";
  if (x.regions_asleep != y.regions_asleep || x.rods_asleep != y.rods_asleep) return "sleep";
  if (stepped && x.planned_us != y.planned_us) return "planned_us";
  return {};
}

// One call, drawn at random and then made of as many worlds as one likes.
using Call = std::function<void(Side&, InstanceId)>;
struct Named {
  std::string name;
  Call call;
  bool of_world = false;
};

class Draw {
 public:
  Draw(uint64_t seed, const Side& side, const scenes::PackBytes& pack, double arms_way_m)
      : random_(seed), bind_(side.info.joint_count), arms_way_m_(static_cast<float>(arms_way_m)) {
    REQUIRE(side.world.bind_pose(side.asset, bind_).ok());
    regions_ = side.info.region_count;
    rods_ = side.info.rod_count;
    pack::PackView view;
    REQUIRE(pack::open_pack(pack.bytes(), &view).ok());
    for (const pack::TierRecord& record : view.tiers) budgets_us_.push_back(1.05f * record.cost_us);
    budgets_us_.insert(budgets_us_.end(), {0.0f, 1e9f, 1e9f, 1e9f});
  }

  size_t below(size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(random_); }
  float number(float from, float to) { return std::uniform_real_distribution<float>(from, to)(random_); }
  bool one_in(size_t count) { return below(count) == 0; }

  Named call() {
    const size_t which = below(100);
    if (which < 40) return step();
    if (which < 65) return pose();
    if (which < 69) return {"reset", [](Side& s, InstanceId id) { REQUIRE(s.world.reset(id).ok()); }};
    if (which < 73) return skip_pose();
    if (which < 76) return hide();
    if (which < 80) return tier_limit();
    if (which < 84) return parameters();
    if (which < 87) return environment();
    if (which < 89) return time_scale();
    if (which < 91) return felt_root();
    if (which < 93) return importance();
    if (which < 96) return views();
    return budget();
  }

  Named step() {
    constexpr float kSteps[] = {0,         1.0f / 60,  1.0f / 60, 1.0f / 60, 1.0f / 120, 1.0f / 45,
                                1.0f / 30, 1.0f / 300, 0.1f,      0.45f,     1e-5f};
    const float dt_s = kSteps[below(std::size(kSteps))];
    const size_t times = one_in(12) ? 40 : one_in(3) ? 3 : 1;
    time_s_ += static_cast<double>(dt_s);
    return {"step " + std::to_string(dt_s) + " x" + std::to_string(times),
            [=](Side& s, InstanceId) {
              for (size_t i = 0; i < times; ++i) s.world.step(dt_s);
            },
            true};
  }

  Named pose() {
    std::vector<Matrix34> joints = bind_;
    const auto t = static_cast<float>(time_s_);
    const float bend = one_in(4) ? 0 : 0.4f * std::sin(9 * t), way = one_in(4) ? 0 : 0.05f * std::sin(11 * t);
    for (size_t j = 1; j < joints.size(); ++j) {
      if (j > 1) joints[j].m[0][3] += arms_way_m_ * (std::cos(3 * t) - 1);
      joints[j].m[0][3] += way + 0.02f * std::sin(7 * t + static_cast<float>(j));
      const Matrix34 was = joints[j];
      for (int k = 0; k < 4; ++k) {
        joints[j].m[0][k] = std::cos(bend) * was.m[0][k] - std::sin(bend) * was.m[1][k];
        joints[j].m[1][k] = std::sin(bend) * was.m[0][k] + std::cos(bend) * was.m[1][k];
      }
    }
    if (one_in(3)) joints = last_.empty() ? bind_ : last_;
    last_ = joints;
    if (one_in(10)) place_ = {10.0 * static_cast<double>(below(100)), 0, 5};
    if (one_in(3)) place_[0] += 0.03;
    if (one_in(15)) scale_ = std::array{1.0, 1.0, 0.5, 2.0, 1.1}[below(5)];
    const float turn = one_in(3) ? 0.3f * t : 0;
    Pose pose;
    pose.root.position_m[0] = place_[0];
    pose.root.position_m[1] = place_[1];
    pose.root.position_m[2] = place_[2];
    pose.root.rotation_xyzw[1] = std::sin(turn / 2);
    pose.root.rotation_xyzw[3] = std::cos(turn / 2);
    pose.root.scale = scale_;
    pose.teleport = one_in(12);
    if (one_in(12)) space_ = static_cast<uint32_t>(below(3));
    pose.space.id = space_;
    pose.space.root.position_m[0] = 0.5 * time_s_;
    const float spin = 0.2f * t;
    pose.space.root.rotation_xyzw[1] = std::sin(spin / 2);
    pose.space.root.rotation_xyzw[3] = std::cos(spin / 2);
    return {std::string("pose") + (pose.teleport ? " teleport" : "") + " space " + std::to_string(space_) +
                " scale " + std::to_string(scale_),
            [joints, pose](Side& s, InstanceId id) {
              Pose given = pose;
              given.joints = joints;
              REQUIRE(s.world.set_pose(id, given).ok());
            }};
  }

  Named skip_pose() {
    return {"skip_pose", [](Side& s, InstanceId id) { REQUIRE(s.world.skip_pose(id).ok()); }};
  }
  Named hide() {
    const bool hidden = one_in(2);
    return {hidden ? "hide" : "show",
            [=](Side& s, InstanceId id) { REQUIRE(s.world.set_hidden(id, hidden).ok()); }};
  }
  Named tier_limit() {
    const Tier best = std::array{Tier::kSkinning, Tier::kModal, Tier::kNetwork, Tier::kNetwork}[below(4)];
    return {"tier_limit " + std::to_string(int(best)),
            [=](Side& s, InstanceId id) { REQUIRE(s.world.set_tier_limit(id, best).ok()); }};
  }
  Named parameters() {
    PartParameters part;
    if (!one_in(3)) {
      part = {number(0, 2), number(0.3f, 3), number(0.3f, 3), number(0.2f, 2), !one_in(3)};
    }
    const size_t of = below(1 + regions_ + rods_);
    return {"parameters of " + std::to_string(of), [=, this](Side& s, InstanceId id) {
              const Status status =
                  of == 0 ? s.world.set_parameters(id, part)
                  : of <= regions_
                      ? s.world.set_region_parameters(id, static_cast<uint32_t>(of - 1), part)
                      : s.world.set_rod_parameters(id, static_cast<uint32_t>(of - 1 - regions_), part);
              INFO(status.message);
              REQUIRE(status.ok());
            }};
  }
  Named environment() {
    const Vec3 pull{number(-5, 5), 0, number(-5, 5)};
    if (one_in(2)) {
      const bool none = one_in(2);
      return {"added_environment", [=](Side& s, InstanceId id) {
                AddedEnvironment added;
                if (!none) {
                  added.acceleration_m_s2[0] = pull.x;
                  added.acceleration_m_s2[2] = pull.z;
                }
                REQUIRE(s.world.set_added_environment(id, added).ok());
              }};
    }
    const bool none = one_in(2);
    return {"environment",
            [=](Side& s, InstanceId) {
              Environment environment;
              if (!none) {
                environment.wind.velocity_m_s[0] = pull.x;
                environment.wind.gust = 0.5f;
              }
              REQUIRE(s.world.set_environment(environment).ok());
            },
            true};
  }
  Named time_scale() {
    const float scale = std::array{0.0f, 0.25f, 1.0f, 1.0f, 2.5f}[below(5)];
    return {"time_scale " + std::to_string(scale),
            [=](Side& s, InstanceId id) { REQUIRE(s.world.set_time_scale(id, scale).ok()); }};
  }
  Named felt_root() {
    const float share = number(0, 1);
    return {"felt_root",
            [=](Side& s, InstanceId id) { REQUIRE(s.world.set_felt_root_motion(id, share).ok()); }};
  }
  Named importance() {
    const float importance = number(0, 3);
    return {"importance",
            [=](Side& s, InstanceId id) { REQUIRE(s.world.set_importance(id, importance).ok()); }};
  }
  Named views() {
    const size_t which = below(3);
    return {"views " + std::to_string(which),
            [=](Side& s, InstanceId) {
              View view;
              view.position_m[2] = which == 1 ? 4 : -1e4;
              REQUIRE(s.world.set_views({&view, which == 0 ? size_t{0} : size_t{1}}).ok());
            },
            true};
  }
  Named budget() {
    const float us = budgets_us_[below(budgets_us_.size())];
    return {"budget " + std::to_string(us),
            [=](Side& s, InstanceId) { REQUIRE(s.world.set_budget_us(us).ok()); }, true};
  }

 private:
  struct Vec3 {
    float x, y, z;
  };
  std::mt19937_64 random_;
  std::vector<Matrix34> bind_, last_;
  std::vector<float> budgets_us_;
  float arms_way_m_;
  std::array<double, 3> place_{};
  double scale_ = 1, time_s_ = 0;
  uint32_t space_ = 0;
  size_t regions_ = 0, rods_ = 0;
};

struct Played {
  size_t calls = 0, restores = 0, touched = 0;
  std::set<Tier> tiers;
  std::string wrong;
};

// What of all that is read or saved is not the same, or nothing.
std::string difference(const Side& original, const Side& twin, bool after_step) {
  for (size_t i = 0; i < 2; ++i) {
    const std::string differs = difference(original.read(i), twin.read(i), after_step);
    if (!differs.empty()) return differs;
  }
  const std::vector<std::byte> a = original.save(), b = twin.save();
  if (a == b) return {};
  const auto at = std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin();
  return "state, at byte " + std::to_string(at % static_cast<std::ptrdiff_t>(a.size() / 2));
}

// Each call is made of the original and of its twin, which is then sometimes disturbed by calls of its own
// and taken to where the original is. Both are sometimes taken back to where the original was.
void play(const Kind& kind, const scenes::PackBytes& pack, uint64_t seed, Played& played) {
  constexpr size_t kCalls = 300;
  Side original(pack, kind.contacts), twin(pack, kind.contacts);
  Draw draw(seed, original, pack, kind.arms_way_m);
  std::string history;
  std::vector<std::byte> kept = original.save();
  const auto is_same = [&](bool after_step) {
    const std::string differs = difference(original, twin, after_step);
    if (!differs.empty())
      played.wrong =
          std::string(kind.name) + ", seed " + std::to_string(seed) + ": " + differs + " after" + history;
    return differs.empty();
  };
  for (size_t c = 0; c < kCalls; ++c) {
    const Named call = draw.call();
    const size_t of = draw.below(2);
    history += "\n  " + std::to_string(of) + " " + call.name;
    call.call(original, original.blocks[of]);
    call.call(twin, twin.blocks[of]);
    ++played.calls;
    const InstanceReport report = original.report(of);
    played.touched += report.vertices_touched + report.rod_contacts;
    played.tiers.insert(report.tier);
    if (!is_same(call.name.starts_with("step"))) return;
    if (draw.one_in(15)) kept = original.save();
    if (draw.one_in(30)) {
      history += "\n  both taken back";
      original.restore(kept);
      twin.restore(kept);
      if (!is_same(false)) return;
    }
    if (!draw.one_in(2)) continue;
    history += "\n  twin restored";
    for (size_t d = draw.one_in(2) ? draw.below(6) : 0; d > 0; --d) {
      const Named other = draw.call();
      if (!other.of_world || other.name.starts_with("step")) other.call(twin, twin.blocks[draw.below(2)]);
    }
    twin.restore(original.save());
    ++played.restores;
    if (!is_same(false)) return;
  }
}

const ContactDef& under_a_ceiling() {
  static scenes::HalfSpaces source;
  source.walls = {{{0, 0.55, 0}, {0, -1, 0}}};
  static const ContactDef contacts{.source = &source};
  return contacts;
}

const ContactDef& on_a_skin() {
  static scenes::HalfSpaces skin;
  skin.walls = {{{0, 0.39, 0}, {0, 1, 0}}};
  static const ContactDef contacts{.own_body = true, .surface = &skin};
  return contacts;
}

std::vector<Kind> kinds() {
  return {{"network", {}},
          {"network and walls", {}, under_a_ceiling()},
          {"levels", {.nodes = 40, .coarser_nodes = {20, 10}, .leaves_out = true}},
          {"rods", {.network = false, .rods = scenes::RodMatter{}}},
          {"sewn rods and walls", {.rods = scenes::RodMatter{.sag = 1, .sewn = true}}, under_a_ceiling()},
          {"rods of levels",
           {.nodes = 40, .rods = scenes::RodMatter{.bar = true}, .coarser_nodes = {20, 10}},
           on_a_skin()},
          {"arms", {.arms = scenes::ArmMatter{}}, {.own_body = true}, 0.07}};
}

void play_all(const std::vector<uint64_t>& seeds) {
  for (const Kind& kind : kinds()) {
    const scenes::PackBytes pack = scenes::soft_block(kind.options);
    Played played;
    for (const uint64_t seed : seeds) {
      play(kind, pack, seed, played);
      INFO(played.wrong);
      REQUIRE(played.wrong.empty());
    }
    INFO(kind.name << ": " << played.calls << " calls, " << played.restores << " restores");
    CHECK(played.tiers.size() >= 3);
    CHECK((played.touched > 0) == (kind.contacts.source || kind.contacts.own_body));
  }
}

}  // namespace

TEST_CASE("whatever_calls_made_of_it_what_is_restored_goes_on_as_the_original") { play_all({0, 3, 17}); }

TEST_CASE("whatever_thousands_of_calls_made_of_it_what_is_restored_goes_on_as_the_original") {
  std::vector<uint64_t> seeds(40);
  std::iota(seeds.begin(), seeds.end(), 20);
  play_all(seeds);
}
