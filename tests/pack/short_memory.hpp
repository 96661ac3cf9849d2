// short_memory.hpp  Memory that runs out when a test says so. Whoever links it has its allocator replaced.
#pragma once
#include <cstddef>
#include <string>

#include "sinew/types.hpp"

namespace sinew::test {

// Of this thread: from now on, the n-th allocation is refused, and all after it where so told. 0: none is.
void refuse_allocation(size_t nth, bool and_all_after = false);
// Ends that, and says how many were asked for meanwhile.
size_t allocations_asked_for();
// Of all threads: taken and not given back.
size_t live_blocks();

struct RefuseHow {
  bool and_all_after = false;
  bool may_keep = false;  // what an asset keeps for its next instance, once it is made
};
struct Refusals {
  size_t count = 0;
  std::string wrong;
};

// Calls `work`, which answers a Status, with its first allocation refused, then with its second, and so on
// until it succeeds. Each time before, it has to be out of memory, and to have let go of all that it took;
// then `goes_on` is called, which says whether all is as it was. Says how many were refused, or what was
// wrong.
template <class Work, class GoesOn>
Refusals refuse_each(const Work& work, const GoesOn& goes_on, const RefuseHow& how = {}) {
  constexpr size_t kMost = 100000;
  Refusals out;
  for (size_t nth = 1; nth < kMost; ++nth) {
    const size_t live = live_blocks();
    refuse_allocation(nth, how.and_all_after);
    const Status status = work();
    const size_t asked = allocations_asked_for();
    const size_t left = live_blocks() - live;
    if (status.ok() && asked < nth) return out;
    ++out.count;
    if (status.code != StatusCode::kOutOfCapacity)
      out.wrong = std::string("not told to be out of memory: ") + status.message;
    else if (status.message[0] == '\0')
      out.wrong = "refused without a word";
    else if (left != 0 && !how.may_keep)
      out.wrong = std::to_string(left) + " blocks are not given back: " + status.message;
    else if (!goes_on())
      out.wrong = std::string("something changed: ") + status.message;
    if (!out.wrong.empty()) {
      out.wrong = "allocation " + std::to_string(nth) + ": " + out.wrong;
      return out;
    }
  }
  out.wrong = "never succeeds";
  return out;
}

}  // namespace sinew::test
