// test_learned_start.cpp  The network across lanes does what rods/start/coping_net.hpp does row by row.
#include "rods/start/learned_start.hpp"

#include "tests/rods/start_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using Catch::Contains;

namespace {

// Sums of at most 24 terms in the same order, without fused multiply-adds on some targets; norms of 1.
constexpr double kRounding = 2e-6;

// A fork: 2 and 3 hang on 1, 4 on 3.
const std::vector<uint32_t> kParents = {0, 0, 1, 1, 3};
constexpr uint32_t kNodes = 5, kEdges = 4;

struct Guess {
  std::vector<float> dp, dlambda;
};

Guess by_rows(const rods::CopingNet& network, const std::vector<float>& nodes,
              const std::vector<float>& edges) {
  std::vector<uint32_t> senders(kParents.begin() + 1, kParents.end()), receivers = {1, 2, 3, 4},
                                                                       rows(kNodes + 1), ends(2 * kEdges);
  std::vector<float> ones(2 * kEdges);
  REQUIRE(rods::link_rods(kNodes, senders, receivers, rows, ends, ones).ok());
  const rods::RodGraph graph = {kNodes,      kEdges,      senders.data(), receivers.data(),
                                rows.data(), ends.data(), ones.data()};
  test::Floats encodings(rods::rod_encoding_floats(network, kEdges), 0),
      planes(rods::coping_net_plane_floats(network, kNodes, kEdges), 0),
      scratch(rods::coping_net_scratch_floats(network), 0);
  Guess out{std::vector<float>(6 * kNodes), std::vector<float>(6 * kEdges)};
  rods::encode_rod_edges(network, edges.data(), kEdges, encodings.data(), scratch.data());
  rods::run_coping_net(network, graph, {0, kNodes, 0, kEdges}, nodes.data(), encodings.data(), out.dp.data(),
                       out.dlambda.data(), planes.data(), scratch.data());
  return out;
}

template <uint32_t kWidth>
void check_lanes(const simd::Kernels& kernels, const rods::CopingNet& network) {
  const simd::RodStartNet net = rods::start_net(network);
  test::StartLanes<kWidth> group(kParents, net.latent);
  std::mt19937 random(3);
  std::vector<std::vector<float>> nodes(kWidth), edges(kWidth);
  test::Floats joints(size_t{kNodes} * simd::kRodJointInputs * kWidth, 0);
  for (uint32_t lane = 0; lane < kWidth; ++lane) {
    for (uint32_t k = 0; k < kNodes * simd::kRodStartInputs; ++k) {
      nodes[lane].push_back(group.start.inputs[k * kWidth + lane] = test::uniform(random, -1, 1));
    }
    for (uint32_t k = 0; k < kEdges * simd::kRodJointInputs; ++k) {
      const float x = test::uniform(random, -1, 1);
      joints.data()[(simd::kRodJointInputs + k) * kWidth + lane] = x;
      edges[lane].push_back(x);
    }
  }
  group.calls(kernels).encode_joints(group.job, net, joints.data(), const_cast<float*>(group.start.encodings),
                                     group.start.planes);
  group.calls(kernels).add_network(group.job, group.start, net);
  for (uint32_t lane = 0; lane < kWidth; ++lane) {
    const Guess expected = by_rows(network, nodes[lane], edges[lane]);
    for (uint32_t i = 0; i < kNodes; ++i) {
      for (uint32_t k = 0; k < 6; ++k) {
        const float node = group.at(i, simd::kRodStartPush + k)[lane],
                    joint = group.at(i, simd::kRodStartForce + k)[lane];
        CHECK(node == Approx(expected.dp[6 * i + k]).margin(kRounding));
        CHECK(joint == Approx(i == 0 ? 0 : expected.dlambda[6 * (i - 1) + k]).margin(kRounding));
      }
    }
  }
}

}  // namespace

TEST_CASE("a_learned_start_without_a_network_that_fits_is_refused") {
  test::RodBatch batch;
  test::RodSettings settings;
  settings.start = rods::RodStart::kLearned;
  const auto message = [&] {
    const Status status = test::try_batch({test::helix(4)}, settings, &batch);
    CHECK((status.ok() || batch.strand_count() == 0));
    return std::string(status.ok() ? "" : status.message);
  };
  CHECK_THAT(message(), Contains("RodSettings::network is missing"));
  const rods::CopingNet empty;
  settings.network = &empty;
  CHECK_THAT(message(), Contains("RodSettings::network is missing"));
  const test::RandomCopingNet odd(12);
  settings.network = &odd.net();
  CHECK_THAT(message(), Contains("a latent width of 12"));
  const test::RandomCopingNet wide(128, 1);
  settings.network = &wide.net();
  CHECK_THAT(message(), Contains("a latent width of 128"));
  const test::RandomCopingNet good;
  settings.network = &good.net();
  CHECK(message().empty());
}

TEST_CASE("lanes_of_a_network_are_rows_of_coping_net") {
  const test::RandomCopingNet small(8, 1, 1), deep(16, 3, 2);
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    check_lanes<16>(kernels, small.net());
    check_lanes<4>(kernels, small.net());
    check_lanes<16>(kernels, deep.net());
  });
}

TEST_CASE("a_network_corrects_along_a_segments_own_axes_in_the_scales_measure") {
  const test::RandomCopingNet network;
  const simd::RodStartNet net = rods::start_net(network.net());
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    test::StartLanes<4> straight({0, 0}), turned({0, 0});
    // Own x to the world's y, y to z, z to x.
    for (uint32_t k = 0; k < 4; ++k) turned.fill(turned.at(1, simd::kRodTurn + k), 0.5f);
    for (uint32_t t = 0; t < simd::kRodStartTriples; ++t) turned.fill(turned.start.scales + 4 * t, 2);
    for (auto* group : {&straight, &turned}) group->calls(kernels).add_network(group->job, group->start, net);
    for (const uint32_t part : {simd::kRodStartPush, simd::kRodStartForce}) {
      for (uint32_t k = 0; k < 3; ++k) {
        CHECK(turned.at(1, part + (k + 1) % 3)[0] == Approx(2 * straight.at(1, part + k)[0]).margin(1e-6));
        CHECK(turned.at(1, part + 3 + k)[0] == Approx(2 * straight.at(1, part + 3 + k)[0]).margin(1e-6));
      }
    }
  });
}

TEST_CASE("a_network_that_was_told_nothing_yet_corrects_nothing") {
  const test::RandomCopingNet network;
  test::StartLanes<4> group({0, 0});
  group.know(simd::kRodStartKnown);
  group.fill(group.start.inputs, std::nanf(""));
  group.fill(group.start.scales, std::nanf(""));
  group.calls(simd::kernels()).add_network(group.job, group.start, rods::start_net(network.net()));
  for (uint32_t k = 0; k < simd::kRodStartNumbers; ++k) CHECK(group.at(1, simd::kRodStartPush + k)[0] == 0);
}
