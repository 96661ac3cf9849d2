// progress.cpp  Nothing in a pipe.
#include "baker/common/progress.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

using sinew::baker::Progress;

namespace {

// What `work` writes to stderr when stderr is `descriptor`, read from the other end.
template <class Work>
std::string captured(int descriptor, int other_end, Work work) {
  const int before = ::dup(STDERR_FILENO);
  ::dup2(descriptor, STDERR_FILENO);
  work();
  ::dup2(before, STDERR_FILENO);
  ::close(before);
  // A terminal hands bytes over a little later than a pipe: read until nothing has come for a while.
  constexpr int kQuiet_ms = 200;
  std::string text;
  char bytes[256];
  for (pollfd wait{other_end, POLLIN, 0}; ::poll(&wait, 1, kQuiet_ms) > 0 && (wait.revents & POLLIN);) {
    const ssize_t got = ::read(other_end, bytes, sizeof bytes);
    if (got <= 0) break;
    text.append(bytes, static_cast<size_t>(got));
  }
  return text;
}

void make_progress() {
  Progress progress("baking", 4);
  for (size_t done = 0; done <= 4; ++done) progress.update(done);
}

}  // namespace

TEST_CASE("progress_is_silent_in_a_pipe") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  CHECK(captured(ends[1], ends[0], make_progress).empty());
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_CASE("progress_draws_on_a_terminal_and_clears_its_line") {
  const int controller = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (controller < 0 || ::grantpt(controller) != 0 || ::unlockpt(controller) != 0) {
    WARN("skipped: this system gives no pseudo terminal");
    return;
  }
  const int terminal = ::open(::ptsname(controller), O_RDWR | O_NOCTTY);
  REQUIRE(terminal >= 0);
  const std::string text = captured(terminal, controller, make_progress);
  CHECK(text.find("baking  50 %") != std::string::npos);
  CHECK(text.ends_with("\r\x1b[K"));
  ::close(terminal);
  ::close(controller);
}
