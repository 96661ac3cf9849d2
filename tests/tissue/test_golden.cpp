// test_golden.cpp  The paper's wiring over whole roll-outs, against float64 PyTorch.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include "baker/common/files/safetensors.hpp"
#include "baker/pack/network/graph.hpp"
#include "baker/pack/network/network_pack.hpp"
#include "pack/reader.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"
#include "tissue/network/narrow_layer.hpp"
#include "tissue/network/network.hpp"

using namespace sinew;

namespace {

constexpr double kGolden = 1e-5;  // the vectors' README: float32 PyTorch stays within 1.5e-6

const std::filesystem::path kFolder = std::filesystem::path(SINEW_SHARED_DIR) / "golden/alt_conv_lstm";

// Weights packed and read back as the runtime does, and the vectors beside them.
struct Golden {
  explicit Golden(const std::string& name)
      : vectors(baker::read_safetensors(kFolder / (name + ".vectors.safetensors"))),
        x(vectors.need("x", {-1, -1, 3}).as_f32()),
        y(vectors.need("y", {-1, -1, 3}).as_f32()),
        y0(vectors.need("y0", {-1, 3}).as_f32()),
        nodes(static_cast<uint32_t>(y0.size() / 3)),
        graph(baker::normalized_adjacency(nodes, edges(), name)) {
    baker::PackWriter writer(pack::FileKind::kModel);
    baker::add_network(baker::read_safetensors(kFolder / (name + ".weights.safetensors")), writer);
    const std::vector<std::byte> bytes = writer.finish();
    file = std::make_unique<test::Floats>((bytes.size() + 3) / 4);
    std::memcpy(file->data(), bytes.data(), bytes.size());
    pack::PackView view;
    const Status status =
        pack::open_pack(std::as_bytes(std::span(file->data(), file->size())).first(bytes.size()), &view);
    INFO(status.message);
    REQUIRE(status.ok());
    network = {view.network, view.layers, view.inputs, view.weights.data()};
    narrow = std::make_unique<test::Floats>(tissue::narrow_floats(network));
    tissue::pack_narrow(network, narrow->data());
    network.narrow = narrow->data();
  }
  std::vector<std::pair<int, int>> edges() const {
    const std::vector<int32_t> flat = vectors.need("edges", {-1, 2}).as_i32();
    std::vector<std::pair<int, int>> out;
    for (size_t e = 0; e < flat.size(); e += 2) out.emplace_back(flat[e], flat[e + 1]);
    return out;
  }
  // P x, x [nodes][width].
  std::vector<double> aggregated(const std::vector<float>& x, size_t width) const {
    std::vector<double> out(x.size());
    for (size_t i = 0; i < nodes; ++i) {
      for (uint32_t e = graph.rows[i]; e < graph.rows[i + 1]; ++e) {
        for (size_t j = 0; j < width; ++j)
          out[i * width + j] += double{graph.values[e]} * x[graph.columns[e] * width + j];
      }
    }
    return out;
  }
  tissue::Graph graph_view() const {
    return {nodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
  }

  baker::Safetensors vectors;
  std::vector<float> x, y, y0;
  uint32_t nodes;
  baker::GraphRows graph;
  std::unique_ptr<test::Floats> file, narrow;
  tissue::Network network;
};

// Inputs of the paper: X_t, X_t - X_{t-1}, Y_0 - X_0.
struct RollOut {
  explicit RollOut(const Golden& golden)
      : golden(golden),
        state(tissue::state_floats(golden.network, golden.nodes)),
        scratch(tissue::scratch_floats(golden.network, golden.nodes)),
        z(golden.nodes * size_t{16}),
        carry(golden.nodes * 3) {
    const auto last = static_cast<uint32_t>(golden.network.layers.size() - 1);
    y = tissue::layer_state(golden.network, golden.nodes, last, state.data()).y;
    for (size_t i = 0; i < golden.y0.size(); ++i) y[i / 3 * 16 + i % 3] = golden.y0[i];
  }
  void step(size_t t) {
    const size_t frame = golden.y0.size();
    for (size_t i = 0; i < frame; ++i) {
      const float now = golden.x[t * frame + i];
      carry[i] = now - golden.x[(t - 1) * frame + i];
      float* row = &z[i / 3 * 16];
      row[i % 3] = now;
      row[3 + i % 3] = carry[i];
      row[6 + i % 3] = golden.y0[i] - golden.x[i];
    }
    tissue::network_step(golden.network, golden.graph_view(), z.data(), carry.data(), state.data(),
                         scratch.data());
  }
  double output_error(size_t t) const {
    double worst = 0;
    for (size_t i = 0; i < golden.y0.size(); ++i) {
      const double off = std::fabs(y[i / 3 * 16 + i % 3] - golden.y[(t - 1) * golden.y0.size() + i]);
      worst = test::larger(worst, off);
    }
    return worst;
  }
  double final_state_error(uint32_t layer, const char* plane) {
    const tissue::LayerState have = tissue::layer_state(golden.network, golden.nodes, layer, state.data());
    const float* values = *plane == 'h' ? have.h : *plane == 'c' ? have.c : have.y;
    const size_t f = golden.network.layers[layer].channels, padded = golden.network.layers[layer].padded;
    const std::vector<float> stored =
        golden.vectors
            .need("final." + std::to_string(layer) + "." + plane, {golden.nodes, static_cast<long>(f)})
            .as_f32();
    const bool heard = *plane == 'y' && layer + 1 < golden.network.layers.size();
    const std::vector<double> want =
        heard ? golden.aggregated(stored, f) : std::vector<double>(stored.begin(), stored.end());
    double worst = 0;
    for (size_t i = 0; i < want.size(); ++i) {
      const double off = std::fabs(values[i / f * padded + i % f] - want[i]);
      worst = test::larger(worst, off);
    }
    return worst;
  }

  const Golden& golden;
  test::Floats state, scratch, z;
  std::vector<float> carry;
  float* y = nullptr;
};

// Its first most_steps; the final states where these are all.
void check_roll_out(const Golden& golden, size_t most_steps) {
  const size_t all = golden.y.size() / golden.y0.size(), steps = std::min(all, most_steps);
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    RollOut roll_out(golden);
    double worst = 0;
    for (size_t t = 1; t <= steps; ++t) {
      roll_out.step(t);
      const double off = roll_out.output_error(t);
      worst = test::larger(worst, off);
    }
    CHECK(worst <= kGolden);
    for (uint32_t l = 0; steps == all && l < golden.network.layers.size(); ++l) {
      for (const char* plane : {"h", "c", "y"}) CHECK(roll_out.final_state_error(l, plane) <= kGolden);
    }
  });
}

// check(golden) for each network with vectors.
template <class Check>
void for_every_golden(const Check& check) {
  if (!std::filesystem::exists(kFolder)) {
    WARN("skipped: no golden vectors in " << kFolder << "; set SINEW_SHARED_DIR");
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    const std::string file = entry.path().filename().string();
    const size_t end = file.find(".weights.safetensors");
    if (end == std::string::npos) continue;
    INFO(file);
    check(Golden(file.substr(0, end)));
  }
}

}  // namespace

TEST_CASE("network_step_reproduces_the_golden_roll_outs_and_final_states") {
  for_every_golden([](const Golden& golden) { check_roll_out(golden, SIZE_MAX); });
}

// What is looked at in QEMU: two thousand nodes' steps are the small networks' all, and the first few of the
// paper's.
TEST_CASE("network_step_begins_the_golden_roll_outs") {
  for_every_golden(
      [](const Golden& golden) { check_roll_out(golden, std::max<size_t>(1, 2000 / golden.nodes)); });
}
