// tracy_hook.hpp  A world's markers as Tracy's zones: the example of runtime/README.md.
#include <tracy/TracyC.h>
#include <cstring>

#include "sinew/sinew.hpp"

static constexpr ___tracy_source_location_data kSinew{"sinew", "World::step", __FILE__, __LINE__, 0};
static thread_local TracyCZoneCtx zones[8];  // markers nest two deep
static thread_local int zone_count = 0;

static const sinew::ProfilerHook kTracyHook{
    .begin =
        [](const char* name, uint32_t instance, void*) {
          const TracyCZoneCtx zone = zones[zone_count++] = ___tracy_emit_zone_begin(&kSinew, 1);
          ___tracy_emit_zone_name(zone, name, std::strlen(name));
          if (instance != sinew::kNoInstance) ___tracy_emit_zone_value(zone, instance);
        },
    .end = [](const char*, uint32_t, void*) { ___tracy_emit_zone_end(zones[--zone_count]); }};
