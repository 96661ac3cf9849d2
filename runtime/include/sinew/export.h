/* export.h  What a shared library of Sinew shows. */
#ifndef SINEW_EXPORT_H
#define SINEW_EXPORT_H
#define SINEW_API __attribute__((visibility("default")))
#endif
