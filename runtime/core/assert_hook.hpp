// assert_hook.hpp  Programmer errors go to the caller's hook.
#pragma once
#include "sinew/types.hpp"

namespace sinew::core {

// file and line are the caller's. Null hook: abort in debug builds, nothing in release.
void report_fault(const AssertHook& hook, const char* condition, const char* file = __builtin_FILE(),
                  int line = __builtin_LINE()) noexcept;

}  // namespace sinew::core
