// assert_hook.hpp  Programmer errors go to the caller's hook.
#pragma once
#include <source_location>

#include "sinew/types.hpp"

namespace sinew::core {

// Null hook: abort in debug builds, nothing in release.
void report_fault(const AssertHook& hook, const char* condition,
                  std::source_location where = std::source_location::current()) noexcept;

}  // namespace sinew::core
