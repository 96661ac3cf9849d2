// status.hpp  Making a Status: one formatted line, no allocation.
#pragma once
#include "sinew/export.h"
#include "sinew/status.hpp"

namespace sinew::core {

// printf's format; a line longer than Status::message is cut. SINEW_API: the adapters make them, too.
[[gnu::format(printf, 2, 3)]] SINEW_API Status make_status(StatusCode code, const char* format, ...) noexcept;

}  // namespace sinew::core
