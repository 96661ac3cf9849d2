/* version.h  Of these headers; sinew_version() tells the library's. */
#ifndef SINEW_VERSION_H
#define SINEW_VERSION_H
#define SINEW_VERSION_MAJOR 0
#define SINEW_VERSION_MINOR 1
#define SINEW_VERSION_PATCH 0
#define SINEW_VERSION (SINEW_VERSION_MAJOR * 10000 + SINEW_VERSION_MINOR * 100 + SINEW_VERSION_PATCH)
#endif
