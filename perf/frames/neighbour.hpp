// neighbour.hpp  Another process that wants the core this thread runs on: the system gives each half.
#pragma once
#include <sched.h>
#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

#include "baker/common/bad_input.hpp"

namespace sinew::perf {

class Neighbour {
 public:
  Neighbour() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(sched_getcpu(), &here);
    if (sched_setaffinity(0, sizeof here, &here) != 0)
      throw baker::BadInput("neighbour: a thread cannot be kept on a core here");
    child_ = fork();
    if (child_ == 0) work_for_ever();
    if (child_ < 0) throw baker::BadInput("neighbour: no second process can be started here");
  }
  ~Neighbour() {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    sched_setaffinity(0, sizeof before_, &before_);
  }
  Neighbour(const Neighbour&) = delete;
  Neighbour& operator=(const Neighbour&) = delete;

 private:
  [[noreturn]] static void work_for_ever() {
    for (std::atomic<uint64_t> done{0};; ++done) {
    }
  }

  cpu_set_t before_;
  pid_t child_ = 0;
};

}  // namespace sinew::perf
