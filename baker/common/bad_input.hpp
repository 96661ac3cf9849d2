// bad_input.hpp  The one exception of the baker: unusable input. Programs print its line and exit with 2.
#pragma once
#include <stdexcept>

namespace sinew::baker {

struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;  // one line: what, where, how to mend
};

}  // namespace sinew::baker
