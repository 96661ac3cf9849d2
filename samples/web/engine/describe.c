/* describe.c  see describe.h. */
#include "describe.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct text {
  char* characters;
  size_t length, capacity;
} text;

static int make_room(text* text, size_t more) {
  if (text->characters && text->length + more < text->capacity) return 1;
  const size_t capacity = 2 * (text->length + more) + 1024;
  char* grown = text->characters || !text->capacity ? realloc(text->characters, capacity) : NULL;
  if (!grown) free(text->characters);
  text->characters = grown;
  text->capacity = capacity;
  return grown != NULL;
}

static void add(text* text, const char* format, ...) {
  if (!make_room(text, 256)) return;
  va_list arguments;
  va_start(arguments, format);
  text->length += (size_t)vsnprintf(text->characters + text->length, 256, format, arguments);
  va_end(arguments);
}

/* Names come from files of others. */
static void add_name(text* text, const char* name) {
  if (!name) name = "";
  if (!make_room(text, 6 * strlen(name) + 3)) return;
  add(text, "\"");
  for (; *name; ++name) {
    const unsigned char c = (unsigned char)*name;
    if (c < 0x20 || c == '"' || c == '\\')
      add(text, "\\u%04x", c);
    else if (make_room(text, 2))
      text->characters[text->length++] = (char)c;
  }
  add(text, "\"");
}

static const char* comma(uint32_t index) { return index ? "," : ""; }
static size_t address(const void* of) { return (size_t)of; }

static void add_meshes(text* text, sinew_world world, sinew_asset asset, const sinew_asset_info* info) {
  add(text, ",\"meshes\":[");
  for (uint32_t i = 0; i < info->mesh_count; ++i) {
    sinew_mesh_info mesh;
    if (sinew_get_mesh_info(world, asset, i, &mesh) != SINEW_OK) continue;
    add(text, "%s{\"name\":", comma(i));
    add_name(text, mesh.name);
    add(text, "}");
  }
  add(text, "],\"primitives\":[");
  for (uint32_t i = 0; i < info->primitive_count; ++i) {
    sinew_primitive_info primitive;
    if (sinew_get_primitive_info(world, asset, i, &primitive) != SINEW_OK) continue;
    add(text, "%s{\"mesh\":%u,\"index\":%u,\"material\":", comma(i), primitive.mesh, primitive.index);
    add_name(text, primitive.material);
    add(text, ",\"firstVertex\":%u,\"vertexCount\":%u,\"firstTriangle\":%u,\"triangleCount\":%u}",
        primitive.first_vertex, primitive.vertex_count, primitive.first_triangle, primitive.triangle_count);
  }
  add(text, "]");
}

static void add_parts(text* text, sinew_world world, sinew_asset asset, const sinew_asset_info* info) {
  add(text, ",\"regions\":[");
  for (uint32_t i = 0; i < info->region_count; ++i) {
    sinew_region_info region;
    if (sinew_get_region_info(world, asset, i, &region) != SINEW_OK) continue;
    add(text, "%s{\"name\":", comma(i));
    add_name(text, region.name);
    add(text, ",\"vertices\":%zu,\"vertexCount\":%u}", address(region.vertices), region.vertex_count);
  }
  add(text, "],\"rods\":[");
  for (uint32_t i = 0; i < info->rod_count; ++i) {
    sinew_rod_info rod;
    if (sinew_get_rod_info(world, asset, i, &rod) != SINEW_OK) continue;
    add(text, "%s{\"name\":", comma(i));
    add_name(text, rod.name);
    add(text, "}");
  }
  add(text, "],\"clips\":[");
  for (uint32_t i = 0; i < info->clip_count; ++i) {
    sinew_clip_info clip;
    if (sinew_get_clip_info(world, asset, i, &clip) != SINEW_OK) continue;
    add(text, "%s{\"name\":", comma(i));
    add_name(text, clip.name);
    add(text, ",\"seconds\":%.6g}", (double)clip.duration_s);
  }
  add(text, "]");
}

char* describe(sinew_world world, sinew_asset asset) {
  sinew_asset_info info;
  sinew_asset_arrays arrays;
  if (sinew_get_asset_info(world, asset, &info) != SINEW_OK ||
      sinew_get_asset_arrays(world, asset, &arrays) != SINEW_OK)
    return NULL;
  text text = {NULL, 0, 0};
  add(&text, "{\"height\":%.9g,\"vertexCount\":%u,\"triangleCount\":%u,\"jointCount\":%u,\"movedCount\":%u",
      (double)info.height_m, info.vertex_count, info.triangle_count, info.joint_count,
      info.moved_vertex_count);
  add(&text, ",\"proxyCount\":%u,\"positions\":%zu,\"normals\":%zu,\"triangles\":%zu,\"moved\":%zu",
      info.proxy_count, address(arrays.positions_m), address(arrays.normals), address(arrays.triangles),
      address(arrays.moved_vertices));
  add(&text, ",\"skinJoints\":%zu,\"skinWeights\":%zu,\"skinStride\":%zu", address(arrays.skin_joints),
      address(arrays.skin_weights), arrays.skin_stride_bytes);
  add_meshes(&text, world, asset, &info);
  add_parts(&text, world, asset, &info);
  add(&text, "}");
  return text.characters;
}
