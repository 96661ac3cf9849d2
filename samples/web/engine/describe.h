/* describe.h  What a pack holds, as JSON for the page. */
#ifndef SINEW_WEB_DESCRIBE_H
#define SINEW_WEB_DESCRIBE_H

#include <sinew/sinew.h>

/* Lives until it is freed; null: no memory. */
char* describe(sinew_world world, sinew_asset asset);

#endif
