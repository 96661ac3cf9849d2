// test_deep_emulator.cpp  DeepEmulator's step against the equations in double and against float64 PyTorch.
#include "tissue/network/deep_emulator.hpp"

#include <algorithm>
#include <filesystem>

#include "baker/pack/network/graph.hpp"
#include "tests/pack/packed_model.hpp"
#include "tests/simd/chain.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using simd::Pointwise;

namespace {

constexpr double kGolden = 1e-5;  // the vectors' README: float32 PyTorch stays within 1.5e-6

// Three chains of five layers on sums of order one, beta's last layer behind the sum: measured 1.1e-6, room
// for another seed.
constexpr double kEquations = 1e-5;

using Floats3 = std::vector<float>;  // [nodes][3]

struct Scene {
  explicit Scene(uint32_t nodes, uint32_t seed = 3, uint32_t w = 64)
      : nodes(nodes),
        random(seed),
        alpha(test::random_chain(random, {18, w, w, w, w, w})),
        beta(test::random_chain(random, {37, 2 * w, 2 * w, 2 * w, 2 * w, 2 * w})),
        gamma(test::random_chain(random, {3 * w, 3 * w, 3 * w, 3 * w, 3 * w, 3})),
        packed({alpha, beta, gamma}),
        scratch(tissue::deep_emulator_scratch_floats(), kStale) {
    for (Floats3* positions : {&u[0], &u[1], &u[2], &x[0], &x[1], &x[2], &material})
      for (uint32_t k = 0; k < 3 * nodes; ++k) positions->push_back(test::uniform(random, -0.5f, 0.5f));
    for (uint32_t i = 0; i < nodes; ++i) constrained.push_back(i % 5 == 3);
    drop_self_loops(test::ring_with_chords(nodes));
  }
  void drop_self_loops(const test::TestGraph& graph) {
    for (uint32_t i = 0; i < nodes; ++i) {
      rows.push_back(static_cast<uint32_t>(columns.size()));
      for (uint32_t e = graph.rows[i]; e < graph.rows[i + 1]; ++e)
        if (graph.columns[e] != i) columns.push_back(graph.columns[e]);
    }
    rows.push_back(static_cast<uint32_t>(columns.size()));
  }
  void step(uint32_t first, uint32_t last, Floats3* out) {
    tissue::deep_emulator_step({packed.layers(), packed.weights()}, {rows.data(), columns.data()},
                               {u[0].data(), u[1].data(), u[2].data(), x[0].data(), x[1].data(), x[2].data(),
                                material.data(), constrained.data(), views.empty() ? nullptr : views.data()},
                               first, last, out->data(), scratch.data());
  }
  Floats3 stepped() {
    Floats3 out(3 * nodes, kStale);
    step(0, nodes, &out);
    return out;
  }
  // reference/deep_emulator.py, word for word.
  void put(const Floats3& positions, uint32_t node, uint32_t origin, std::vector<double>* out) const {
    for (uint32_t axis = 0; axis < 3; ++axis)
      out->push_back(double{positions[3 * node + axis]} - double{x[1][3 * origin + axis]});
  }
  std::vector<double> plain(uint32_t i) const {
    if (constrained[i]) return {x[0].begin() + 3 * i, x[0].begin() + 3 * i + 3};
    std::vector<double> centre;
    for (const Floats3* p : {&u[0], &u[1], &u[2], &x[0], &x[2]}) put(*p, i, i, &centre);
    std::vector<double> sum(beta.back().outputs);
    for (uint32_t e = rows[i]; e < rows[i + 1]; ++e) {
      const uint32_t j = columns[e];
      std::vector<double> z = centre;
      for (const Floats3* p : {&u[0], &u[1], &u[2], &x[0], &x[1], &x[2]}) put(*p, j, i, &z);
      z.insert(z.end(), &material[3 * j], &material[3 * j] + 3);
      z.push_back(constrained[j]);
      const std::vector<double> b = test::plain_mlp(beta, Pointwise::kTanh, Pointwise::kNone, z);
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += b[k];
    }
    centre.insert(centre.end(), &material[3 * i], &material[3 * i] + 3);
    std::vector<double> z = test::plain_mlp(alpha, Pointwise::kTanh, Pointwise::kNone, centre);
    z.insert(z.end(), sum.begin(), sum.end());
    std::vector<double> out = test::plain_mlp(gamma, Pointwise::kTanh, Pointwise::kNone, z);
    for (size_t axis = 0; axis < 3; ++axis) out[axis] += double{u[0][3 * i + axis]};
    return out;
  }

  static constexpr float kStale = 1e30f;
  uint32_t nodes;
  std::mt19937 random;
  test::PlainChain alpha, beta, gamma;
  test::PackedChains packed;
  Floats3 u[3], x[3], material;
  std::vector<tissue::PatchView> views;
  std::vector<uint8_t> constrained;
  std::vector<uint32_t> rows, columns;
  test::Floats scratch;
};

// Weights packed and read back, and the vectors beside them, as golden/README.md describes them.
struct Golden {
  explicit Golden(const std::string& stem)
      : packed(baker::read_safetensors(stem + ".weights.safetensors")),
        vectors(baker::read_safetensors(stem + ".vectors.safetensors")),
        x(vectors.need("x", {-1, -1, 3}).as_f32()),
        y(vectors.need("y", {-1, -1, 3}).as_f32()),
        material(vectors.need("material", {-1, 3}).as_f32()),
        nodes(static_cast<uint32_t>(material.size() / 3)) {
    for (const int32_t value : vectors.need("constrained", {nodes}).as_i32())
      constrained.push_back(static_cast<uint8_t>(value));
    const std::vector<int32_t> flat = vectors.need("edges", {-1, 2}).as_i32();
    std::vector<std::pair<int, int>> edges;
    for (size_t e = 0; e < flat.size(); e += 2) edges.emplace_back(flat[e], flat[e + 1]);
    graph = baker::neighbour_rows(nodes, edges, stem);
  }
  // Largest error over the roll-out's first most_steps, its own output fed back.
  double roll_out(size_t most_steps) const {
    const size_t frame = material.size();
    std::vector<Floats3> u = {vectors.need("u_1", {nodes, 3}).as_f32(),
                              vectors.need("u_0", {nodes, 3}).as_f32(),
                              vectors.need("u_m1", {nodes, 3}).as_f32()};
    test::Floats scratch(tissue::deep_emulator_scratch_floats());
    double worst = 0;
    for (size_t t = 1; t <= std::min(y.size() / frame, most_steps); ++t) {
      Floats3 next(frame);
      tissue::deep_emulator_step({packed.view().dense, packed.view().weights.data()},
                                 {graph.rows.data(), graph.columns.data()},
                                 {u[0].data(), u[1].data(), u[2].data(), &x[(t + 1) * frame], &x[t * frame],
                                  &x[(t - 1) * frame], material.data(), constrained.data()},
                                 0, nodes, next.data(), scratch.data());
      for (size_t k = 0; k < frame; ++k) {
        const double off = std::fabs(double{next[k]} - double{y[(t - 1) * frame + k]});
        worst = test::larger(worst, off);
      }
      u = {next, u[0], u[1]};
    }
    return worst;
  }
  test::PackedModel packed;
  baker::Safetensors vectors;
  std::vector<float> x, y, material;
  uint32_t nodes;
  std::vector<uint8_t> constrained;
  baker::GraphRows graph;
};

}  // namespace

TEST_CASE("deep_emulator_step_is_the_reference_for_any_number_of_nodes") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const uint32_t nodes : {2u, 7u, simd::kRangeNodes + 1, 2 * simd::kRangeNodes + 30}) {
      Scene scene(nodes);
      const Floats3 out = scene.stepped();
      double worst = 0;
      for (uint32_t i = 0; i < nodes; ++i) {
        const std::vector<double> want = scene.plain(i);
        for (size_t axis = 0; axis < 3; ++axis) {
          const double off = std::fabs(double{out[3 * i + axis]} - want[axis]);
          worst = test::larger(worst, off);
        }
      }
      CHECK(worst <= kEquations);
    }
  });
}

TEST_CASE("smaller_deep_emulators_are_the_reference_too") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const uint32_t latent : {16u, 32u, 48u}) {
      Scene scene(simd::kRangeNodes + 1, 3, latent);
      const Floats3 out = scene.stepped();
      double worst = 0;
      for (uint32_t i = 0; i < scene.nodes; ++i) {
        const std::vector<double> want = scene.plain(i);
        for (size_t axis = 0; axis < 3; ++axis)
          worst = test::larger(worst, std::fabs(double{out[3 * i + axis]} - want[axis]));
      }
      CHECK(worst <= kEquations);
    }
  });
}

TEST_CASE("a_patch_that_stands_still_looks_the_same_from_a_frame_that_goes_on") {
  Scene scene(20);
  scene.u[1] = scene.u[2] = scene.u[0];  // no velocity
  const Floats3 plain = scene.stepped();
  scene.views.assign(scene.nodes, {.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .length_m = 1, .fall_m = {}});
  scene.u[2].assign(scene.u[2].size(), std::numeric_limits<float>::quiet_NaN());  // is not read
  CHECK(scene.stepped() == plain);
}

// What the paper's wiring says of the same patch where going on leads: u_{t-2} = 2 u_{t-1} - u_t.
TEST_CASE("from_a_frame_that_goes_on_the_third_tick_is_where_going_on_leads_back_to") {
  constexpr uint32_t kNode = 0;
  constexpr float kSame = 1e-5f;  // rounding of sums of order one
  Scene scene(20), shifted(20);   // alike
  for (size_t k = 0; k < scene.u[0].size(); ++k) {
    const float goes_on = scene.u[0][3 * kNode + k % 3] - scene.u[1][3 * kNode + k % 3];
    shifted.u[1][k] += goes_on, shifted.x[2][k] += goes_on, shifted.x[0][k] -= goes_on;
    shifted.u[2][k] = 2 * shifted.u[1][k] - shifted.u[0][k];
  }
  scene.views.assign(scene.nodes, {.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .length_m = 1, .fall_m = {}});
  const Floats3 seen = scene.stepped(), plain = shifted.stepped();
  for (size_t k = 3 * kNode; k < 3 * kNode + 3; ++k) {
    const float goes_on = scene.u[0][k] - scene.u[1][k];
    CHECK(std::fabs(seen[k] - goes_on - plain[k]) < kSame);
  }
}

// Galileo and Newton: seen from frames of their own, patches that move on, turned, larger and in free fall
// are the same patches. Floats of order ten carry 1e-6; the chains pass on some tens of it.
TEST_CASE("a_moving_frame_sees_no_velocity_turn_size_or_fall") {
  constexpr float kSame = 2e-4f;
  Scene scene(20);
  scene.views.assign(scene.nodes, {.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .length_m = 1, .fall_m = {}});
  const Floats3 before = scene.stepped();
  const float turn[9] = {0, 0, 1, 1, 0, 0, 0, 1, 0}, speed[3] = {2, -1, 0.5f}, fall[3] = {0.3f, -0.6f, 0.1f};
  constexpr float kSize = 1.5f;
  const auto moved = [&](const Floats3& p, float ahead) {
    Floats3 out(p.size());
    for (size_t i = 0; i < p.size(); i += 3)
      for (size_t axis = 0; axis < 3; ++axis) {
        const float turned =
            turn[3 * axis] * p[i] + turn[3 * axis + 1] * p[i + 1] + turn[3 * axis + 2] * p[i + 2];
        out[i + axis] = kSize * turned + ahead * speed[axis] + ahead * ahead / 2 * fall[axis];
      }
    return out;
  };
  const Floats3 want = moved(before, 1);
  scene.u[0] = moved(scene.u[0], 0), scene.u[1] = moved(scene.u[1], -1), scene.u[2] = moved(scene.u[2], -2);
  scene.x[0] = moved(scene.x[0], 1), scene.x[1] = moved(scene.x[1], 0), scene.x[2] = moved(scene.x[2], -1);
  for (tissue::PatchView& view : scene.views) {
    view.length_m = kSize;
    std::copy_n(fall, 3, view.fall_m);
    for (size_t row = 0; row < 3; ++row)
      for (size_t column = 0; column < 3; ++column) view.axes[3 * row + column] = turn[3 * column + row];
  }
  const Floats3 out = scene.stepped();
  for (size_t k = 0; k < out.size(); ++k) CHECK(std::fabs(out[k] - want[k]) < kSame);
}

TEST_CASE("a_node_that_is_listed_as_its_own_neighbour_is_passed_over") {
  Scene scene(12);
  const Floats3 without = scene.stepped();
  std::vector<uint32_t> rows, columns;
  for (uint32_t i = 0; i < scene.nodes; ++i) {
    rows.push_back(static_cast<uint32_t>(columns.size()));
    columns.push_back(i);
    columns.insert(columns.end(), scene.columns.begin() + scene.rows[i],
                   scene.columns.begin() + scene.rows[i + 1]);
  }
  rows.push_back(static_cast<uint32_t>(columns.size()));
  scene.rows = rows, scene.columns = columns;
  CHECK(scene.stepped() == without);
}

TEST_CASE("deep_emulator_step_gives_the_same_bits_wherever_its_nodes_are_cut") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    Scene scene(simd::kRangeNodes + 20);
    const Floats3 whole = scene.stepped();
    for (uint32_t cut = 0; cut <= scene.nodes; cut += 7) {
      Floats3 out(3 * scene.nodes);
      scene.step(cut, scene.nodes, &out);
      scene.step(0, cut, &out);
      REQUIRE(out == whole);
    }
  });
}

TEST_CASE("deep_emulator_leaves_nodes_outside_its_range_alone_and_constrained_ones_at_their_skinned_place") {
  Scene scene(30);
  Floats3 out(90, 55.0f);
  scene.step(10, 20, &out);
  for (uint32_t i = 0; i < 30; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const bool inside = i >= 10 && i < 20;
      if (!inside) REQUIRE(out[3 * i + axis] == 55.0f);
      if (inside) REQUIRE((out[3 * i + axis] == scene.x[0][3 * i + axis]) == (scene.constrained[i] != 0));
    }
  }
}

TEST_CASE("nan_in_a_node_reaches_itself_and_its_neighbours_and_nobody_else") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    Scene scene(30);
    scene.u[1][3 * 12 + 1] = NAN;
    const Floats3 out = scene.stepped();
    for (uint32_t i = 0; i < 30; ++i) {
      const auto first = scene.columns.begin() + scene.rows[i],
                 last = scene.columns.begin() + scene.rows[i + 1];
      const bool hears = i == 12 || std::find(first, last, 12u) != last;
      REQUIRE(std::isnan(out[3 * i]) == (hears && !scene.constrained[i]));
    }
  });
}

TEST_CASE("deep_emulator_step_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0x49328989dd7b8f32,
                                      [&](const simd::Kernels&) { return Scene(60).stepped(); });
}

namespace {

void check_golden(size_t most_steps) {
  const std::string folder = SINEW_SHARED_DIR "/golden/deep_emulator/";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no golden vectors in " << folder << "; set SINEW_SHARED_DIR");
    return;
  }
  for (const char* name : {"small", "medium"}) {
    const Golden golden(folder + name);
    test::for_every_isa(
        [&](const char*, const simd::Kernels&) { CHECK(golden.roll_out(most_steps) <= kGolden); });
  }
}

}  // namespace

TEST_CASE("deep_emulator_reproduces_the_golden_roll_outs") { check_golden(SIZE_MAX); }

// What is looked at in QEMU: the small one whole, and the medium one's first steps.
TEST_CASE("deep_emulator_begins_the_golden_roll_outs") { check_golden(6); }
