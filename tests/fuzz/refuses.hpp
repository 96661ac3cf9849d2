// refuses.hpp  What is refused is refused with one line.
#pragma once
#include <cstdlib>
#include <cstring>

#include "baker/common/bad_input.hpp"

namespace sinew::fuzz {

template <class Call>
void refuses_or_does(const Call& call) {
  try {
    call();
  } catch (const baker::BadInput& refusal) {
    if (std::strlen(refusal.what()) == 0 || std::strchr(refusal.what(), '\n') != nullptr) std::abort();
  }
}

}  // namespace sinew::fuzz
