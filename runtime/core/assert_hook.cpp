// assert_hook.cpp  Programmer errors go to the caller's hook.
#include "core/assert_hook.hpp"

#include <cstdlib>

namespace sinew::core {

void report_fault(const AssertHook& hook, const char* condition, const char* file, int line) noexcept {
  if (hook.fail) {
    hook.fail(condition, file, line, hook.context);
    return;
  }
#ifndef NDEBUG
  std::abort();
#endif
}

}  // namespace sinew::core
