// TracyC.h  Of Tracy's C API what tracy_hook.hpp calls, as Tracy declares it: here test_tracy_hook.cpp
// defines it.
#pragma once
#include <stddef.h>
#include <stdint.h>

struct ___tracy_source_location_data {
  const char* name;
  const char* function;
  const char* file;
  uint32_t line;
  uint32_t color;
};

struct ___tracy_c_zone_context {
  uint32_t id;
  int32_t active;
};
typedef struct ___tracy_c_zone_context TracyCZoneCtx;

extern "C" {
TracyCZoneCtx ___tracy_emit_zone_begin(const struct ___tracy_source_location_data* location, int32_t active);
void ___tracy_emit_zone_end(TracyCZoneCtx zone);
void ___tracy_emit_zone_name(TracyCZoneCtx zone, const char* text, size_t size);
void ___tracy_emit_zone_value(TracyCZoneCtx zone, uint64_t value);
}
