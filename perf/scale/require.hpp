// require.hpp  What a measurement cannot go on without.
#pragma once
#include "baker/common/bad_input.hpp"
#include "sinew/status.hpp"

namespace sinew::perf {

// Throws baker::BadInput with the status' message.
inline void require(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

}  // namespace sinew::perf
