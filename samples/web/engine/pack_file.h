/* pack_file.h  A pack out of a file, for programs that play the page's scene without a page. */
#ifndef SINEW_WEB_PACK_FILE_H
#define SINEW_WEB_PACK_FILE_H

#include <stdio.h>

#include "scene.h"

/* For scene_open, which comes next. 0: the file cannot be read, or is empty. */
static inline int read_pack_file(const char* path) {
  FILE* file = fopen(path, "rb");
  if (!file) return 0;
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  rewind(file);
  void* bytes = size > 0 && size < INT32_MAX ? scene_pack_bytes((uint32_t)size) : NULL;
  const int is_read = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size;
  fclose(file);
  return is_read;
}

#endif
