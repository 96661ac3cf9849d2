// progress.hpp  A progress line on a terminal, nothing in a pipe.
#pragma once
#include <cstddef>
#include <string>

namespace sinew::baker {

class Progress {
 public:
  Progress(std::string what, size_t total);  // draws on stderr if it is a terminal
  ~Progress();                               // clears the line
  void update(size_t done);

 private:
  std::string what_;
  size_t total_ = 0, drawn_percent_ = 101;
  bool terminal_ = false;
};

}  // namespace sinew::baker
