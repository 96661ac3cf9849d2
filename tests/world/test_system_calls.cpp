// test_system_calls.cpp  A frame asks the kernel for nothing: it runs where all but read, write and exit
// kill.
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr int kNoSeccomp = 77;

// How a child ends that does `work` in strict mode: 0, or killed by the first system call.
template <class Work>
int status_in_strict_mode(Work work) {
  const pid_t child = fork();
  if (child == 0) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    _exit(kNoSeccomp);  // sanitizers ask for much
#endif
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) _exit(kNoSeccomp);
    work();
    syscall(SYS_exit, 0);  // _exit would call exit_group, which is not allowed
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

bool ended_well(int status) { return WIFEXITED(status) && WEXITSTATUS(status) == 0; }

uint64_t counted_ns(void* context) { return *static_cast<uint64_t*>(context) += 1000; }

}  // namespace

TEST_CASE("a_step_of_tissue_rods_and_contacts_makes_no_system_call") {
  uint64_t now_ns = 0;
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  scenes::HalfSpaces ceiling;
  ceiling.walls = {{{0, 0.55, 0}, {0, -1, 0}}};
  Stage stage(0, {.clock = {counted_ns, &now_ns}}, pack);
  InstanceId made;
  REQUIRE(stage.world.create_instance({.asset = stage.asset, .contacts = {.source = &ceiling}}, &made).ok());
  std::vector<float> out(size_t{3} * stage.info.vertex_count);
  const auto frames = [&] {
    for (int f = 0; f < 60; ++f) {
      const scenes::TailedPose pose = scenes::with_rods(scenes::walk(f / 60.0));
      (void)stage.world.set_pose(made, pose.pose());
      stage.world.step(1.0f / 60);
      (void)stage.world.read_positions(made, {.out = out.data(), .capacity = stage.info.vertex_count});
    }
  };
  const int status = status_in_strict_mode(frames);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNoSeccomp) {
    WARN("skipped: strict mode is not to be had here");
    return;
  }
  CHECK(ended_well(status));
  CHECK_FALSE(ended_well(status_in_strict_mode([] { (void)getppid(); })));
}
