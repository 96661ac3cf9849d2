// refusal.hpp  Why a call was refused, kept for sinew_message.
#pragma once
#include "sinew/sinew.h"
#include "sinew/status.hpp"

namespace sinew::c {

// The status' code; where it is not ok its message is kept for this thread.
sinew_status told(const Status& status) noexcept;
sinew_status refused(StatusCode code, const char* line) noexcept;
inline sinew_status invalid(const char* line) noexcept { return refused(StatusCode::kInvalidArgument, line); }

// Of a struct that its default function made.
inline constexpr uint32_t kMadeByDefault = 0x53494e31;
sinew_status not_made(const char* function) noexcept;

}  // namespace sinew::c
