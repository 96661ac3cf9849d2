// progress.cpp  A progress line on a terminal, nothing in a pipe.
#include "baker/common/progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <utility>

namespace sinew::baker {

Progress::Progress(std::string what, size_t total)
    : what_(std::move(what)), total_(total), terminal_(::isatty(STDERR_FILENO) == 1) {
  update(0);
}

Progress::~Progress() {
  if (!terminal_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

void Progress::update(size_t done) {
  if (!terminal_) return;
  const size_t percent = total_ == 0 ? 100 : (done < total_ ? done * 100 / total_ : 100);
  if (percent == drawn_percent_) return;
  drawn_percent_ = percent;
  std::fprintf(stderr, "\r%s %3zu %%", what_.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace sinew::baker
