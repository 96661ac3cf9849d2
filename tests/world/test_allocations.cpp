// test_allocations.cpp  Nothing on the frame's path allocates. In an executable of its own: it replaces the
// allocator.
#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>

#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SINEW_OWN_MALLOC 0  // the sanitizer's own is in its place; operator new is still counted
#else
#define SINEW_OWN_MALLOC 1
#endif

namespace {

std::atomic<size_t> allocations{0};

}  // namespace

#if SINEW_OWN_MALLOC
// malloc and its kin, for code that does not go through operator new.
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void* malloc(size_t bytes) {
  ++allocations;
  return __libc_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
  ++allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
  ++allocations;
  return __libc_realloc(old, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  ++allocations;
  return __libc_memalign(alignment, bytes);
}
}
#endif

namespace {

// Not inlined: the compiler would see free() meet operator new and warn.
[[gnu::noinline]] void* counted(size_t bytes, size_t alignment) {
#if !SINEW_OWN_MALLOC
  ++allocations;
#endif
  return std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
}

[[gnu::noinline]] void release(void* old) { std::free(old); }

void* counted_or_throw(size_t bytes, size_t alignment) {
  if (void* made = counted(bytes, alignment)) return made;
  throw std::bad_alloc();
}

constexpr size_t kUsual = alignof(std::max_align_t);

}  // namespace

void* operator new(size_t bytes) { return counted_or_throw(bytes, kUsual); }
void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return counted(bytes, kUsual); }
void* operator new(size_t bytes, std::align_val_t alignment) {
  return counted_or_throw(bytes, static_cast<size_t>(alignment));
}
void* operator new(size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return counted(bytes, static_cast<size_t>(alignment));
}
void operator delete(void* old) noexcept { release(old); }
void operator delete(void* old, size_t) noexcept { release(old); }
void operator delete(void* old, std::align_val_t) noexcept { release(old); }
void operator delete(void* old, size_t, std::align_val_t) noexcept { release(old); }

namespace {

template <class Work>
size_t allocations_of(Work work) {
  const size_t before = allocations;
  work();
  return allocations - before;
}

// Everything an engine calls in a frame, into memory that is already there.
struct Frame {
  Stage& stage;
  std::vector<float> out = std::vector<float>(size_t{3} * stage.info.vertex_count);
  std::vector<Matrix34> joints = std::vector<Matrix34>(stage.info.joint_count);
  std::vector<std::byte> saved = stage.save();
  bool ok = true;

  void expect(const Status& status) { ok = ok && status.ok(); }

  void run(double time_s, float budget_us, double dt_s) {
    World& world = stage.world;
    expect(world.set_budget_us(budget_us));
    for (const InstanceId block : stage.blocks) {
      const scenes::TailedPose pose = scenes::with_rods(scenes::walk(time_s));
      expect(world.set_pose(block, {std::span(pose.joints).first(stage.info.joint_count), pose.root}));
      ok = ok && !world.set_pose(block, {}).ok();
    }
    world.step(static_cast<float>(dt_s));
    for (const InstanceId block : stage.blocks) read(block);
    expect(world.save_state(stage.blocks[0], saved));
    expect(world.restore_state(stage.blocks[0], saved));
    expect(world.reset(stage.blocks[1]));
  }

  void read(InstanceId block) {
    const World& world = stage.world;
    InstanceReport report;
    for (const Space space : {Space::kCharacter, Space::kWorld, Space::kBind}) {
      expect(world.read_positions(block,
                                  {.space = space, .out = out.data(), .capacity = stage.info.vertex_count}));
    }
    expect(world.read_normals(block, {.out = out.data(), .capacity = stage.info.vertex_count}));
    expect(world.report(block, &report));
    expect(world.read_joint_matrices(block, joints));
  }
};

size_t allocations_of_frames(Stage& stage) {
  Frame frame{stage};
  frame.run(0, 1e9f, 1.0 / 60);  // what is made at first use is made now
  const size_t count = allocations_of([&] {
    for (int f = 1; f < 60; ++f)
      frame.run(f / 60.0, f % 7 == 0 ? 0 : f % 3 == 0 ? 2.0f : 1e9f, f % 5 == 0 ? 0.07 : 1.0 / 60);
  });
  CHECK(frame.ok);
  return count;
}

}  // namespace

TEST_CASE("the_counter_catches_an_allocation") {
  CHECK(allocations_of([] { ::operator delete(::operator new(4)); }) == 1);
  CHECK(allocations_of([] {
          ::operator delete (::operator new (64, std::align_val_t{64}), std::align_val_t{64});
        }) == 1);
#if SINEW_OWN_MALLOC
  CHECK(allocations_of([] {
          void* volatile made = std::malloc(10);
          std::free(made);
        }) == 1);
#endif
  CHECK(allocations_of([] {}) == 0);
}

TEST_CASE("creating_an_instance_takes_one_allocation") {
  Stage stage(1);
  InstanceId made;
  CHECK(allocations_of([&] { (void)stage.world.create_instance({.asset = stage.asset}, &made); }) == 1);
}

TEST_CASE("a_frame_allocates_nothing") {
  Stage stage(3);
  CHECK(allocations_of_frames(stage) == 0);
}

TEST_CASE("a_frame_of_rods_allocates_nothing") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{.sewn = true}});
  Stage stage(3, {}, pack);
  CHECK(allocations_of_frames(stage) == 0);
}

TEST_CASE("a_frame_in_contact_allocates_nothing") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  scenes::HalfSpaces wall;
  wall.walls = {{{0, 0.55, 0}, {0, -1, 0}}};  // a ceiling
  Stage stage(0, {}, pack);
  for (InstanceId& made : stage.blocks = std::vector<InstanceId>(2))
    CHECK(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &wall}}, &made).ok());
  CHECK(allocations_of_frames(stage) == 0);
  stage.world.step(1.0f / 60);  // the frames end with a restore, which forgets what was told
  CHECK(stage.report().vertices_touched > 0);
  CHECK(stage.report().rod_contacts > 0);
}

// The walk's first bone behind the waist is the arm's: at the block's back, in the flesh.
TEST_CASE("a_frame_against_the_own_body_allocates_nothing") {
  const scenes::PackBytes pack = scenes::soft_block({.arms = scenes::ArmMatter{}});
  Stage stage(0, {}, pack);
  for (InstanceId& made : stage.blocks = std::vector<InstanceId>(2))
    CHECK(stage.world.create_instance({.asset = stage.asset, .contacts = {.own_body = true}}, &made).ok());
  CHECK(allocations_of_frames(stage) == 0);
  stage.world.step(1.0f / 60);  // as above
  CHECK(stage.report().vertices_touched > 0);
}

namespace {

// Of what the first instance reports, as the budget is too small and large again; 0 where a frame allocates.
template <class Told>
uint32_t changes_without_allocation(Frame& frame, Told InstanceReport::*told) {
  InstanceReport report;
  frame.expect(frame.stage.world.report(frame.stage.blocks[0], &report));
  Told had = report.*told;
  uint32_t changes = 0;
  const size_t count = allocations_of([&] {
    for (int f = 1; f < 120; ++f) {
      frame.run(f / 60.0, f % 40 < 20 ? 1e9f : 45.0f, 1.0 / 60);
      frame.expect(frame.stage.world.report(frame.stage.blocks[0], &report));
      changes += std::exchange(had, report.*told) != report.*told;
    }
  });
  CHECK(frame.ok);
  CHECK(count == 0);
  return count == 0 ? changes : 0;
}

}  // namespace

TEST_CASE("a_frame_that_changes_what_rods_touch_allocates_nothing") {
  const scenes::PackBytes pack =
      scenes::soft_block({.nodes = 40, .rods = scenes::RodMatter{.bar = true}, .coarser_nodes = {20, 10}});
  scenes::HalfSpaces skin;
  skin.walls = {{{0, 0.39, 0}, {0, 1, 0}}};
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits}, pack);
  for (InstanceId& made : stage.blocks = std::vector<InstanceId>(2)) {
    const ContactDef contacts{.own_body = true, .surface = &skin};
    CHECK(stage.world.create_instance({.asset = stage.asset, .contacts = contacts}, &made).ok());
  }
  Frame frame{stage};
  frame.run(0, 1e9f, 1.0 / 60);
  CHECK(changes_without_allocation(frame, &InstanceReport::rods_touch_surface) > 2);
}

TEST_CASE("a_frame_that_changes_levels_allocates_nothing") {
  Stage stage(3, {.budget_mode = BudgetMode::kWorkUnits}, test::levels_pack());
  Frame frame{stage};
  frame.run(0, 1e9f, 1.0 / 60);
  CHECK(changes_without_allocation(frame, &InstanceReport::graph_level) >= 2);  // there and back
}

TEST_CASE("a_frame_that_changes_parameters_and_environment_allocates_nothing") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  Stage stage(3, {}, pack);
  Frame frame{stage};
  frame.run(0, 1e9f, 1.0 / 60);
  const auto change = [&](int f) {
    const float x = static_cast<float>(f % 20) / 20;
    const PartParameters part{2 * x, 0.1f + 3 * x, 4 * x, 4 * x, f % 40 < 30};
    for (const InstanceId block : stage.blocks) {
      frame.expect(stage.world.set_parameters(block, part));
      frame.expect(stage.world.set_region_parameters(block, 0, part));
      frame.expect(stage.world.set_rod_parameters(block, 1, part));
      frame.expect(stage.world.set_added_environment(block, {.acceleration_m_s2 = {x, 0, 0}}));
    }
    frame.expect(stage.world.set_environment(
        {.gravity_m_s2 = {0, -9 * x, 0}, .wind = {.velocity_m_s = {9 * x, 0, 0}, .gust = x}}));
  };
  const size_t count = allocations_of([&] {
    for (int f = 1; f < 90; ++f) {
      change(f);
      frame.run(f / 60.0, f % 7 == 0 ? 0 : 1e9f, f % 5 == 0 ? 0.07 : 0.011);
    }
  });
  CHECK(frame.ok);
  CHECK(count == 0);
}

TEST_CASE("a_frame_on_worker_threads_allocates_nothing") {
  scenes::ThreadPool pool(3);
  Stage stage(5, {.tasks = pool.hook()});
  CHECK(allocations_of_frames(stage) == 0);
}
