// test_allocation.cpp  What runs inside a tick takes no memory.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/simd/chain.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"
#include "tissue/frames/node_bend.hpp"
#include "tissue/frames/node_drive.hpp"
#include "tissue/modes/correction_budget.hpp"
#include "tissue/modes/guard.hpp"
#include "tissue/modes/modal_base.hpp"
#include "tissue/network/deep_emulator.hpp"
#include "tissue/network/inputs.hpp"

using namespace sinew;

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t bytes) {
  ++allocations;
  return std::malloc(bytes ? bytes : 1);
}

void* counted_or_throw(std::size_t bytes) {
  if (void* memory = counted(bytes)) return memory;
  throw std::bad_alloc();
}

template <class Work>
long allocations_in(const Work& work) {
  const long before = allocations;
  work();
  return allocations - before;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted_or_throw(bytes); }
void* operator new[](std::size_t bytes) { return counted_or_throw(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return counted(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return counted(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("a_tick_of_drive_base_inputs_network_and_guard_allocates_nothing") {
  constexpr uint32_t kNodes = 11, kPadded = 48;
  std::mt19937 random(2);
  const test::TestGraph graph = test::ring_with_chords(kNodes);
  test::PackedNetwork packed(test::plain_record(), {test::random_layer(random, 3, 20, true),
                                                    test::random_layer(random, 20, 3, true)});
  packed.inputs = {{pack::InputKind::kFeltStep, 0.1f, 1, 0}};
  const tissue::Network network = packed.view();
  const tissue::Graph graph_view{kNodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
  pack::RegionRecord region{};
  region.node_count = kNodes;
  region.radius_m = 1;
  region.displacement_limit_m = 0.01f;
  std::vector<pack::NodeRecord> nodes(kNodes);
  for (pack::NodeRecord& node : nodes) node.skin.weight[0] = 1;
  const float skin[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}, upright[4] = {0, 0, 0, 1};
  std::vector<tissue::NodePose> poses(kNodes);
  const tissue::NodeMotion motion{{}, {poses.data(), poses.data(), poses.data()}};
  const tissue::NodePose* const history[3] = {poses.data(), poses.data(), poses.data()};
  const pack::ModeRecord modes[2] = {{20, 0, 1.8f, -0.9f, 1e-3f, {}}, {30, 0, 1.7f, -0.9f, 1e-3f, {}}};
  constexpr uint32_t kPaddedModes = 16;
  test::Floats matrix = test::random_rows(random, 2, 33, kPadded, 1), l(kPadded);
  test::Floats response = test::random_rows(random, 33, 50, kPadded + kPaddedModes, 1e-4f);
  test::Floats project = test::random_rows(random, 33, 2, kPaddedModes, 1), room(kPadded + kPaddedModes);
  const tissue::ModalBase base{
      modes, kNodes, kPadded, kPaddedModes, matrix.data(), matrix.data(), response.data(), project.data(),
      0,     0,      1};
  test::Floats state(tissue::state_floats(network, kNodes)), z(kNodes * tissue::input_stride(network));
  test::Floats scratch(tissue::scratch_floats(network, kNodes));
  std::vector<float> u(kNodes * 3), u_before(u), theta(u), felt(u), r(u), r_hat(u), q(2), q_before(2),
      q_hat(2);
  std::vector<float> drive(kNodes * tissue::kNodeDriveWidth);
  const auto tick = [&] {
    tissue::pose_nodes(nodes, skin, upright, poses.data());
    tissue::share_bend(0, kNodes, poses.data());
    tissue::along_flesh(poses.data(), u.data(), kNodes, u.data());
    tissue::compute_node_drive(motion, 1.0f / 60, kNodes, drive.data());
    tissue::frame_term(history, u.data(), u_before.data(), 1.0f / 60, kNodes, felt.data());
    tissue::modal_hear(base, felt.data(), theta.data(), felt.data(), room.data());
    tissue::modal_answer(base, room.data(), {q.data(), q_before.data(), r.data(), r.data()},
                         {q_hat.data(), r_hat.data(), l.data()});
    tissue::assemble_inputs(network,
                            {&region, nodes.data(), drive.data(), felt.data(), u.data(), u_before.data(),
                             l.data(), theta.data(), 20, 1.0f / 60},
                            z.data());
    tissue::network_step(network, graph_view, z.data(), u.data(), state.data(), scratch.data());
    tissue::read_output(network, {&region, 1}, kNodes, state.data(), u.data());
    float swing = tissue::limit_share(tissue::largest_displacement_m(u.data(), kNodes), 1);
    tissue::bounded_share({modes, q_hat.data(), q.data(), q_before.data(), q_hat.data()}, &swing);
    tissue::modal_project(base, l.data(), q.data());
    tissue::modal_turn(base, q.data(), room.data(), theta.data());
    tissue::warp(theta.data(), l.data(), kNodes, u.data());
    tissue::rebase_state(network, {&region, 1}, kNodes, u.data(), state.data());
  };
  tick();
  // The counter sees what there is to see; a new-expression could be optimised away.
  REQUIRE(allocations_in([] { ::operator delete(::operator new(8)); }) == 1);
  REQUIRE(allocations_in(tick) == 0);
}

TEST_CASE("a_step_of_deep_emulator_allocates_nothing") {
  constexpr uint32_t kNodes = 60;
  std::mt19937 random(3);
  const test::PlainChain alpha = test::random_chain(random, {18, 64, 64, 64, 64, 64}),
                         beta = test::random_chain(random, {37, 128, 128, 128, 128, 128}),
                         gamma = test::random_chain(random, {192, 192, 192, 192, 192, 3});
  test::PackedChains packed({alpha, beta, gamma});
  const test::TestGraph graph = test::ring_with_chords(kNodes);
  std::vector<float> positions(3 * kNodes, 0.1f), next(positions);
  const std::vector<uint8_t> constrained(kNodes);
  test::Floats scratch(tissue::deep_emulator_scratch_floats());
  const float* same = positions.data();
  const tissue::DeepFrame frame = {same, same, same, same, same, same, same, constrained.data()};
  const auto step = [&] {
    tissue::deep_emulator_step({packed.layers(), packed.weights()}, {graph.rows.data(), graph.columns.data()},
                               frame, 0, kNodes, next.data(), scratch.data());
  };
  step();
  REQUIRE(allocations_in(step) == 0);
}
