// status.cpp  Making a Status: one formatted line, no allocation.
#include "core/status.hpp"

#include <cstdarg>
#include <cstdio>

namespace sinew::core {

Status make_status(StatusCode code, const char* format, ...) noexcept {
  Status status;
  status.code = code;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(status.message, sizeof status.message, format, arguments);
  va_end(arguments);
  return status;
}

}  // namespace sinew::core
