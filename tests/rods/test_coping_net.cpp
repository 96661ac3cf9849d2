// test_coping_net.cpp  COPINGNet against the equations in double and against float64 PyTorch.
#include "rods/start/coping_net.hpp"

#include <filesystem>

#include "tests/pack/count_allocations.hpp"
#include "tests/pack/packed_model.hpp"
#include "tests/simd/chain.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using Catch::Contains;
using simd::Pointwise;

namespace {

constexpr double kGolden = 1e-5;  // the vectors' README: float32 PyTorch stays within 1.5e-6

// Sums of up to 192 terms over four blocks whose rows grow from one to the next, and norms of up to 5:
// measured 1.1e-5 without FMA, room for another seed.
constexpr double kEquations = 3e-5;

using Rows = std::vector<std::vector<double>>;

std::vector<double> joined(std::vector<double> a, const std::vector<double>& b,
                           const std::vector<double>& c = {}) {
  a.insert(a.end(), b.begin(), b.end());
  a.insert(a.end(), c.begin(), c.end());
  return a;
}

void add(const std::vector<double>& more, std::vector<double>* sum) {
  for (size_t k = 0; k < sum->size(); ++k) (*sum)[k] += more[k];
}

// Rods of the given segments, one after the other, and what link_rods makes of them.
struct Rods {
  explicit Rods(const std::vector<uint32_t>& lengths) {
    for (const uint32_t length : lengths) {
      for (uint32_t k = 0; k + 1 < length; ++k) {
        senders.push_back(nodes + k);
        receivers.push_back(nodes + k + 1);
      }
      runs.push_back({nodes, nodes + length, edge_count() - (length - 1), edge_count()});
      nodes += length;
    }
    rows.resize(nodes + 1);
    ends.resize(2 * senders.size());
    ones.resize(ends.size());
    REQUIRE(rods::link_rods(nodes, senders, receivers, rows, ends, ones).ok());
  }
  uint32_t edge_count() const { return static_cast<uint32_t>(senders.size()); }
  rods::RodGraph view() const {
    return {nodes, edge_count(), senders.data(), receivers.data(), rows.data(), ends.data(), ones.data()};
  }
  uint32_t nodes = 0;
  std::vector<uint32_t> senders, receivers, rows, ends;
  std::vector<float> ones;
  std::vector<rods::RodRun> runs;
};

struct Result {
  std::vector<float> dp, dlambda;
  bool operator==(const Result&) const = default;
};

Result evaluate(const rods::CopingNet& network, const Rods& rods, const std::vector<rods::RodRun>& runs,
                const std::vector<float>& nodes, const std::vector<float>& edges) {
  constexpr float kStale = 1e30f;
  const uint32_t m = rods.edge_count();
  test::Floats encodings(rods::rod_encoding_floats(network, m), kStale),
      planes(rods::coping_net_plane_floats(network, rods.nodes, m), kStale),
      scratch(rods::coping_net_scratch_floats(network), kStale);
  Result out{std::vector<float>(rods.nodes * 6, kStale), std::vector<float>(m * 6, kStale)};
  rods::encode_rod_edges(network, edges.data(), m, encodings.data(), scratch.data());
  const size_t before = test::allocation_count();
  for (const rods::RodRun& run : runs)
    rods::run_coping_net(network, rods.view(), run, nodes.data(), encodings.data(), out.dp.data(),
                         out.dlambda.data(), planes.data(), scratch.data());
  REQUIRE(test::allocation_count() == before);
  return out;
}

// A random network twice, and rods for it.
struct Scene {
  Scene(uint32_t latent, uint32_t blocks, uint32_t depth, const std::vector<uint32_t>& lengths)
      : random(latent), rods(lengths), packed((make_chains(latent, blocks, depth), chains)) {
    record.model = pack::ModelKind::kCopingNet;
    record.max_channels = latent;
    record.blocks = blocks;
    record.depth = depth;
    weights.assign(packed.weights(), packed.weights() + packed.weight_count());
    aligned = std::make_unique<test::Floats>(weights.size() + 32);
    std::copy(weights.begin(), weights.end(), aligned->data());
    for (size_t k = 0; k < 6; ++k) {
      (*aligned)[weights.size() + k] = kNormNode[k];
      (*aligned)[weights.size() + 16 + k] = kNormEdge[k];
    }
    for (uint32_t k = 0; k < rods.nodes * 14; ++k) nodes.push_back(test::uniform(random, -1, 1));
    for (uint32_t k = 0; k < rods.edge_count() * 5; ++k) edges.push_back(test::uniform(random, -1, 1));
  }
  void make_chains(uint32_t latent, uint32_t blocks, uint32_t depth) {
    const auto chain = [&](uint32_t inputs, uint32_t outputs) {
      std::vector<uint32_t> widths = {inputs};
      widths.insert(widths.end(), depth, latent);
      widths.push_back(outputs);
      chains.push_back(test::random_chain(random, widths));
    };
    chain(14, latent), chain(5, latent);
    for (uint32_t m = 0; m < blocks; ++m) chain(2 * latent, latent), chain(3 * latent, latent);
    chain(latent, 6), chain(latent, 6);
  }
  rods::CopingNet network() { return {&record, packed.layers(), aligned->data()}; }
  Result run(const std::vector<rods::RodRun>& runs) { return evaluate(network(), rods, runs, nodes, edges); }
  Result run() { return run({{0, rods.nodes, 0, rods.edge_count()}}); }

  // reference/coping_net.py, word for word.
  std::vector<double> mlp(size_t chain, const std::vector<double>& z) const {
    return test::plain_mlp(chains[chain], Pointwise::kRelu, Pointwise::kNone, z);
  }
  Rows encoded(size_t chain, const std::vector<float>& inputs, size_t width) const {
    Rows out;
    for (size_t at = 0; at < inputs.size(); at += width)
      out.push_back(mlp(chain, {&inputs[at], &inputs[at] + width}));
    return out;
  }
  void plain_block(size_t m, Rows* v, Rows* e) const {
    Rows sum(v->size(), std::vector<double>(record.max_channels));
    for (size_t k = 0; k < e->size(); ++k) {
      add(mlp(2 * m + 3, joined((*e)[k], (*v)[rods.senders[k]], (*v)[rods.receivers[k]])), &(*e)[k]);
      add((*e)[k], &sum[rods.senders[k]]);
      add((*e)[k], &sum[rods.receivers[k]]);
    }
    for (size_t i = 0; i < v->size(); ++i) add(mlp(2 * m + 2, joined((*v)[i], sum[i])), &(*v)[i]);
  }
  double decoded_difference(size_t decoder, const Rows& rows, const float* norm,
                            const std::vector<float>& have) {
    double worst = 0;
    for (size_t i = 0; i < rows.size(); ++i) {
      const std::vector<double> z = mlp(2 * (record.blocks + 1) + decoder, rows[i]);
      for (size_t k = 0; k < 6; ++k) {
        const double off = std::fabs(have[i * 6 + k] - std::tanh(z[k]) * norm[k]);
        worst = test::larger(worst, off);
      }
    }
    return worst;
  }
  double difference(const Result& have) {
    Rows v = encoded(0, nodes, 14), e = encoded(1, edges, 5);
    for (size_t m = 0; m < record.blocks; ++m) plain_block(m, &v, &e);
    return test::larger(decoded_difference(0, v, kNormNode, have.dp),
                        decoded_difference(1, e, kNormEdge, have.dlambda));
  }

  static constexpr float kNormNode[6] = {.01f, .02f, .03f, .1f, .2f, .3f}, kNormEdge[6] = {1, 2, 3, 4, 5, 0};
  std::mt19937 random;
  Rods rods;
  std::vector<test::PlainChain> chains;
  test::PackedChains packed;
  pack::NetworkRecord record{};
  std::vector<float> weights, nodes, edges;
  std::unique_ptr<test::Floats> aligned;
};

std::string refusal(uint32_t nodes, std::vector<uint32_t> senders, std::vector<uint32_t> receivers,
                    size_t rows_off = 0, size_t ends_off = 0, size_t ones_off = 0) {
  constexpr uint32_t kUntouched = 55;
  std::vector<uint32_t> rows(nodes + 1 + rows_off, kUntouched),
      ends(2 * senders.size() + ends_off, kUntouched);
  std::vector<float> ones(2 * senders.size() + ones_off, kUntouched);
  const Status status = rods::link_rods(nodes, senders, receivers, rows, ends, ones);
  for (const uint32_t value : rows) REQUIRE(value == kUntouched);
  for (const uint32_t value : ends) REQUIRE(value == kUntouched);
  for (const float value : ones) REQUIRE(value == kUntouched);
  REQUIRE(status.code == StatusCode::kInvalidArgument);
  return status.message;
}

}  // namespace

TEST_CASE("rods_that_join_what_is_not_there_are_refused_by_edge_and_nothing_is_written") {
  CHECK_THAT(refusal(3, {0, 3}, {1, 2}), Contains("edge 1: sender 3 of 3 nodes"));
  CHECK_THAT(refusal(3, {0, 1}, {1, 0xffffffffu}), Contains("edge 1: receiver 4294967295 of 3 nodes"));
  CHECK_THAT(refusal(3, {0, 1}, {1, 1}), Contains("edge 1: sender is its own receiver, 1"));
  CHECK_THAT(refusal(0, {0}, {1}), Contains("edge 0: sender 0 of 0 nodes"));
  CHECK_THAT(refusal(3, {0, 1}, {1}), Contains("2 senders, 1 receivers"));
  CHECK_THAT(refusal(3, {0}, {1}, 1), Contains("5 rows"));
  CHECK_THAT(refusal(3, {0}, {1}, 0, 1), Contains("3 and 2 ends"));
  CHECK_THAT(refusal(3, {0}, {1}, 0, 0, 1), Contains("2 and 3 ends"));
}

TEST_CASE("link_rods_lists_the_edges_of_each_node") {
  const Rods rods({3, 1, 2});
  CHECK(rods.rows == std::vector<uint32_t>{0, 1, 3, 4, 4, 5, 6});
  CHECK(rods.ends == std::vector<uint32_t>{0, 0, 1, 1, 2, 2});
  CHECK(rods.ones == std::vector<float>(6, 1.0f));
}

TEST_CASE("coping_net_is_the_reference_for_every_width_depth_and_length_of_rods") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const uint32_t latent : {1u, 8u, 16u, 23u, 32u, 64u}) {
      for (const uint32_t depth : {1u, 3u}) {
        Scene scene(latent, 4, depth, {10, 1, 2, 55});
        CHECK(scene.difference(scene.run()) <= kEquations);
      }
    }
  });
}

TEST_CASE("rods_without_any_edge_are_evaluated") {
  Scene scene(8, 2, 1, {1, 1});
  CHECK(scene.difference(scene.run()) <= kEquations);
}

TEST_CASE("coping_net_gives_the_same_bits_for_every_cut_into_runs") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    Scene scene(20, 3, 2, {30, 2, 60, 7, 1, 50});
    const Result whole = scene.run();
    REQUIRE(scene.run(scene.rods.runs) == whole);
    std::vector<rods::RodRun> backwards(scene.rods.runs.rbegin(), scene.rods.runs.rend());
    REQUIRE(scene.run(backwards) == whole);
  });
}

TEST_CASE("nan_in_a_node_reaches_a_segment_further_with_each_block_and_no_other_rod") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    Scene scene(20, 2, 1, {4, 9});
    scene.nodes[0] = NAN;
    const Result result = scene.run();
    for (size_t k = 0; k < result.dp.size(); ++k) {
      const bool hears = k / 6 <= 2;  // two blocks
      REQUIRE(std::isnan(result.dp[k]) == hears);
    }
  });
}

TEST_CASE("coping_net_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0x65ff5bedf13b266a, [&](const simd::Kernels&) {
    const Result result = Scene(20, 3, 2, {30, 2, 20}).run();
    std::vector<float> values = result.dp;
    values.insert(values.end(), result.dlambda.begin(), result.dlambda.end());
    return values;
  });
}

TEST_CASE("coping_net_reproduces_the_golden_vectors") {
  const std::string folder = SINEW_SHARED_DIR "/golden/coping_net/";
  if (!std::filesystem::exists(folder)) {
    WARN("skipped: no golden vectors in " << folder << "; set SINEW_SHARED_DIR");
    return;
  }
  for (const auto& [name, lengths] : {std::pair("one_rod", std::vector<uint32_t>{30}),
                                      std::pair("forest", std::vector<uint32_t>{10, 2, 55, 31})}) {
    const test::PackedModel model(baker::read_safetensors(folder + name + ".weights.safetensors"));
    const pack::PackView& view = model.view();
    const auto vectors = baker::read_safetensors(folder + name + ".vectors.safetensors");
    const Rods rods(lengths);
    const auto same = [](const std::vector<int32_t>& a, const std::vector<uint32_t>& b) {
      return std::vector<uint32_t>(a.begin(), a.end()) == b;
    };
    REQUIRE(same(vectors.tensors.at("senders").as_i32(), rods.senders));
    REQUIRE(same(vectors.tensors.at("receivers").as_i32(), rods.receivers));
    const auto numbers = [&](const char* tensor) { return vectors.tensors.at(tensor).as_f32(); };
    test::for_every_isa([&](const char*, const simd::Kernels&) {
      const Result result = evaluate({view.network, view.dense, view.weights.data()}, rods, rods.runs,
                                     numbers("nodes"), numbers("edges"));
      for (const auto& [have, want] :
           {std::pair(result.dp, numbers("dp")), std::pair(result.dlambda, numbers("dlambda"))}) {
        REQUIRE(have.size() == want.size());
        for (size_t k = 0; k < have.size(); ++k) {
          if (!(std::fabs(double{have[k]} - double{want[k]}) <= kGolden))
            FAIL("number " << k << " is " << have[k] << ", wanted " << want[k]);
        }
      }
    });
  }
}
