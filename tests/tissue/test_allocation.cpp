// test_allocation.cpp  What runs inside a tick takes no memory.
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/simd/every_isa.hpp"
#include "tests/tissue/reference_network.hpp"
#include "tissue/drive.hpp"
#include "tissue/guard.hpp"
#include "tissue/inputs.hpp"

using namespace sinew;

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
  throw std::bad_alloc();
}

template <class Work>
long allocations_in(const Work& work) {
  const long before = allocations;
  work();
  return allocations - before;
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes); }
void* operator new[](std::size_t bytes) { return counted(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("a_tick_of_drive_inputs_network_and_guard_allocates_nothing") {
  constexpr uint32_t kNodes = 11;
  std::mt19937 random(2);
  const test::TestGraph graph = test::ring_with_chords(kNodes);
  test::PackedNetwork packed(test::plain_record(), {test::random_layer(random, 3, 20, true),
                                                    test::random_layer(random, 20, 3, true)});
  packed.inputs = {{pack::InputKind::kLinearAcceleration, 0.1f, 1, 0}};
  const tissue::Network network = packed.view();
  const tissue::Graph graph_view{kNodes, graph.rows.data(), graph.columns.data(), graph.values.data()};
  pack::RegionRecord region{};
  region.node_count = kNodes;
  region.displacement_limit_m = 0.01f;
  const std::vector<pack::NodeRecord> nodes(kNodes);
  const tissue::RegionFrame frame{{0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const tissue::RegionMotion motion{{frame, frame, frame}};
  test::Floats state(tissue::state_floats(network, kNodes)), z(kNodes * tissue::input_stride(network));
  test::Floats scratch(tissue::scratch_floats(network, kNodes));
  std::vector<float> r(kNodes * 3), u(kNodes * 3), u_before(kNodes * 3), drive(kNodes * tissue::kDriveWidth);
  const auto tick = [&] {
    tissue::compute_drive(motion, 1.0f / 60, r.data(), r.data(), r.data(), kNodes, drive.data());
    tissue::assemble_inputs(network, {&region, nodes.data(), drive.data(), u.data(), u_before.data()},
                            z.data());
    tissue::network_step(network, graph_view, z.data(), nullptr, state.data(), scratch.data());
    tissue::guard_step(network, {&region, 1}, kNodes, state.data(), u.data());
    tissue::rebase_state(network, kNodes, u.data(), state.data());
  };
  tick();
  // The counter sees what there is to see; a new-expression could be optimised away.
  REQUIRE(allocations_in([] { ::operator delete(::operator new(8)); }) == 1);
  REQUIRE(allocations_in(tick) == 0);
}
