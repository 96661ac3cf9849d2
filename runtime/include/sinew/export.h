/* export.h  SINEW_API: what the shared library shows; all else is hidden. For C and C++. Stand-alone. */
#pragma once

#if defined(_WIN32)
#if defined(SINEW_BUILDING) /* the library itself */
#define SINEW_API __declspec(dllexport)
#elif defined(SINEW_SHARED) /* set by sinew::shared for who links it */
#define SINEW_API __declspec(dllimport)
#else
#define SINEW_API
#endif
#else
#define SINEW_API __attribute__((visibility("default")))
#endif
