// with_memory.hpp  What std::vector and Embree throw, there being no memory, goes no further than the public
// functions.
#pragma once
#include <new>
#include <stdexcept>

#include "core/status.hpp"

namespace sinew::embree {

// What work() answers, or kOutOfCapacity.
template <class Work>
Status with_memory(const char* for_what, const Work& work) noexcept {
  try {
    return work();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return core::make_status(StatusCode::kOutOfCapacity, "no memory for %s", for_what);
}

}  // namespace sinew::embree
