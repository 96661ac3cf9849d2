// assert_hook.cpp  Programmer errors go to the caller's hook.
#include "core/assert_hook.hpp"

#include <cstdlib>

namespace sinew::core {

void report_fault(const AssertHook& hook, const char* condition, std::source_location where) noexcept {
  if (hook.fail) {
    hook.fail(condition, where.file_name(), static_cast<int>(where.line()), hook.context);
    return;
  }
#ifndef NDEBUG
  std::abort();
#endif
}

}  // namespace sinew::core
