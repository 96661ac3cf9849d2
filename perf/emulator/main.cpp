// main.cpp  What an emulator of patches costs, and whether flesh on it stays, as tables.
//
//   perf_emulator W.safetensors...   a step of each beside the implicit solver's, on the paper's sphere
//   perf_emulator C.sinew...         10,000 ticks of each character's clips and audit motions
//
// Times are of the thread, medians, both in one process.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "baker/audit/motions.hpp"
#include "baker/common/bad_input.hpp"
#include "baker/common/lone_instance.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/network/reference_vectors.hpp"
#include "baker/pack/character/patches_pack.hpp"
#include "baker/pack/network/graph.hpp"
#include "baker/patches/voxel_body.hpp"
#include "baker/truth/fem/fem.hpp"
#include "perf/help.hpp"
#include "tissue/network/deep_emulator.hpp"

namespace sinew::perf {
namespace {

double thread_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

template <class Work>
double median_us(int times, Work work) {
  std::vector<double> took;
  for (int k = 0; k < times; ++k) {
    const double begin = thread_us();
    work(k);
    took.push_back(thread_us() - begin);
  }
  return median(std::move(took));
}

// ---- beside the solver ----

// The sphere of 1,468 vertices, as near as whole voxels come to it.
baker::VoxelBody paper_sphere() {
  baker::Random random(1);
  return baker::make_body(baker::BodyShape::kSphere, 5.8, random);
}

// Backward Euler at the paper's 24 ticks a second, lengths in cells and time in ticks, while what holds the
// body swings.
double solver_us(const baker::VoxelBody& body, double stiffness) {
  baker::FemMaterial material;
  material.young_pa.clear();
  for (const double fill : body.fill) material.young_pa.push_back(stiffness * fill);
  material.density_kg_m3 = 1;
  material.fill = body.fill;
  baker::Fem fem(body.nodes, body.tetrahedra, body.constrained, material);
  fem.backward_euler = true;
  const auto floats = 3 * static_cast<Eigen::Index>(body.nodes.size());
  const Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(body.nodes[0].data(), floats),
                        none = Eigen::VectorXd::Zero(floats);
  fem.reset(rest);
  return median_us(150, [&](int tick) {
    Eigen::VectorXd target = rest;
    for (Eigen::Index i = 0; i < floats; i += 3) target[i] += 1.5 * std::sin(0.3 * (tick + 1));
    fem.step(1, target, none, 1e-6);
  });
}

double network_us(const baker::VoxelBody& body, const baker::LoadedPack& model) {
  const size_t n = body.nodes.size();
  const baker::GraphRows graph = baker::neighbour_rows(n, baker::edges_of(body.tetrahedra), "sphere");
  std::vector<float> x, material(3 * n, 1.0f), next(3 * n);
  std::vector<uint8_t> held;
  for (size_t i = 0; i < n; ++i) {
    for (int axis = 0; axis < 3; ++axis) x.push_back(static_cast<float>(body.nodes[i][axis]));
    held.push_back(body.constrained[i]);
  }
  const std::vector<tissue::PatchView> views(
      n, {.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .length_m = 1, .fall_m = {}});
  baker::AlignedFloats scratch(tissue::deep_emulator_scratch_floats());
  const tissue::DeepFrame frame{x.data(), x.data(),        x.data(),    x.data(),    x.data(),
                                x.data(), material.data(), held.data(), views.data()};
  return median_us(15, [&](int) {
    tissue::deep_emulator_step(model.deep_emulator(), {graph.rows.data(), graph.columns.data()}, frame, 0,
                               static_cast<uint32_t>(n), next.data(), scratch.data());
  });
}

void compare_with_solver(const std::vector<std::string>& weights) {
  const baker::VoxelBody body = paper_sphere();
  const auto free = std::ranges::count(body.constrained, false);
  std::printf(
      "A sphere of %zu vertices, %ld free, one core. The solver: backward Euler, L-BFGS around a stored "
      "factor.\n\n",
      body.nodes.size(), static_cast<long>(free));
  std::printf("| what | us a step | solver's time over it |\n|---|---|---|\n");
  const double soft = solver_us(body, 8), stiff = solver_us(body, 64), solver = 0.5 * (soft + stiff);
  std::printf("| implicit solver, stiffness 8; 64 | %.0f; %.0f | |\n", soft, stiff);
  for (const std::string& path : weights) {
    const double us = network_us(body, baker::LoadedPack::from_weights(path, pack::Precision::kFloat32, ""));
    std::printf("| %s | %.0f | %.2f |\n", path.c_str(), us, solver / us);
  }
}

// ---- on characters ----

struct Played {
  double tick_us = 0, most_share = 0;  // of the limit, of control nodes
  uint32_t restarts = 0, fallbacks = 0;
  bool finite = true;
};

Played play(const baker::LoadedPack& pack, Tier tier, int ticks) {
  baker::LoneInstance lone(pack.bytes());
  const std::vector<baker::AuditMotion> motions = baker::audit_motions(pack.view());
  Played played;
  std::vector<double> took;
  for (int tick = 0; tick < ticks; ++tick) {
    // Each for ten seconds, then the next from where it begins: teleports are among them.
    const baker::AuditMotion& motion = motions[static_cast<size_t>(tick / 600) % motions.size()];
    motion.pose_at(std::fmod(tick % 600 * lone.tick_s(), std::max(motion.moving_s, lone.tick_s())),
                   lone.joints(), &lone.root());
    const double begin = thread_us();
    lone.step({.tier = tier});
    took.push_back(thread_us() - begin);
    const world::Instance& instance = lone.instance();
    for (const pack::RegionRecord& region : instance.level->pack.regions)
      for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
        const float* u = instance.tissue.u[0] + 3 * size_t{n};
        const double far = std::hypot(double{u[0]}, double{u[1]}, double{u[2]});
        played.finite &= std::isfinite(far);
        played.most_share = std::max(played.most_share, far / double{region.displacement_limit_m});
      }
  }
  played.tick_us = median(std::move(took));
  played.restarts = lone.instance().state->tissue.restarts;
  played.fallbacks = lone.instance().state->tissue.fallbacks;
  return played;
}

std::string error_of(const baker::LoadedPack& pack, Tier tier) {
  for (const pack::TierRecord& record : pack.view().tiers)
    if (record.tier == static_cast<uint32_t>(tier) && record.level == 0) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3f", double{record.error_ratio});
      return text;
    }
  return "-";
}

void judge_characters(const std::vector<std::string>& paths) {
  constexpr int kTicks = 10000;
  std::printf(
      "10,000 ticks each. Errors: the bake's, as fractions of skinning's. An explosion: a restart, a network "
      "given up, "
      "or a node that is not a number or beyond its limit.\n\n");
  std::printf(
      "| character | nodes | modes: error | us a tick | network: error | us a tick | most, of the limit | "
      "explosions |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const std::string& path : paths) {
    const baker::LoadedPack pack = baker::LoadedPack::from_file(path);
    const Played modes = play(pack, Tier::kModal, kTicks / 10), network = play(pack, Tier::kNetwork, kTicks);
    const bool beyond = !network.finite || network.most_share > 1 + 1e-4;
    std::printf("| %s | %u | %s | %.0f | %s | %.0f | %.2f | %u |\n", path.c_str(),
                pack.view().character->node_count, error_of(pack, Tier::kModal).c_str(), modes.tick_us,
                error_of(pack, Tier::kNetwork).c_str(), network.tick_us, network.most_share,
                network.restarts + network.fallbacks + beyond);
  }
}

int run(int count, char** arguments) {
  std::vector<std::string> weights, characters;
  for (int i = 1; i < count; ++i) {
    const std::string path = arguments[i];
    (path.ends_with(".safetensors") ? weights : characters).push_back(path);
  }
  if (weights.empty() && characters.empty())
    throw baker::BadInput("perf_emulator: give weights of a deep_emulator, or characters; --help says more");
  if (!weights.empty()) compare_with_solver(weights);
  if (!characters.empty()) judge_characters(characters);
  return 0;
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) {
  if (sinew::perf::gives_help(
          count, arguments,
          "perf_emulator W.safetensors... | C.sinew...\n"
          "  what DeepEmulators cost compared with the implicit solver; how characters on them fare"))
    return 0;
  try {
    return sinew::perf::run(count, arguments);
  } catch (const sinew::baker::BadInput& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
