// refusal.cpp  see refusal.hpp.
#include "c/refusal.hpp"

#include "core/status.hpp"

namespace sinew::c {
namespace {

thread_local Status last;

}  // namespace

sinew_status told(const Status& status) noexcept {
  if (!status.ok()) last = status;
  return static_cast<sinew_status>(status.code);
}

sinew_status refused(StatusCode code, const char* line) noexcept {
  return told(core::make_status(code, "%s", line));
}

sinew_status not_made(const char* function) noexcept {
  return told(core::make_status(StatusCode::kInvalidArgument,
                                "the struct was not made by its default function; begin with %s()",
                                function));
}

}  // namespace sinew::c

const char* sinew_message(void) { return sinew::c::last.message; }
