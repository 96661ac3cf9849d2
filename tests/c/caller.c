/* caller.c  caller PACK: a program in C11 that loads a character, tries to misuse the interface, plays a
 * second and prints what it reads. Ends with the line of the first check that failed, else 0. Every caller of
 * this folder plays the same and prints the same numbers. */
#include <math.h>
#include <sinew/sinew.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)               \
  do {                                 \
    if (!(condition)) return __LINE__; \
  } while (0)

static const float kTick_s = 1.0f / 60;

static int misuse(sinew_world world, sinew_asset asset) {
  sinew_world_def def = sinew_default_world_def();
  sinew_world other = {7, 7};
  const sinew_world none = {0, 0};
  CHECK(sinew_create_world(SINEW_LAYOUT + 1, &def, &other) == SINEW_UNSUPPORTED);
  CHECK(strstr(sinew_message(), "another version"));
  CHECK(sinew_create_world(SINEW_LAYOUT, NULL, &other) == SINEW_INVALID_ARGUMENT);
  memset(&def, 0, sizeof def);
  CHECK(sinew_create_world(SINEW_LAYOUT, &def, &other) == SINEW_INVALID_ARGUMENT);
  CHECK(strstr(sinew_message(), "sinew_default_world_def"));
  def = sinew_default_world_def();
  def.max_assets = 0;
  CHECK(sinew_create_world(SINEW_LAYOUT, &def, &other) == SINEW_INVALID_ARGUMENT);
  CHECK(other.index1 == 7 && other.generation == 7);

  sinew_instance_def instance_def = sinew_default_instance_def();
  sinew_instance instance = {7, 7};
  CHECK(sinew_create_instance(world, &instance_def, &instance) == SINEW_STALE_ID); /* no asset */
  instance_def.asset = asset;
  CHECK(sinew_create_instance(none, &instance_def, &instance) == SINEW_STALE_ID);
  instance_def.max_rod_iterations = 0;
  CHECK(sinew_create_instance(world, &instance_def, &instance) == SINEW_INVALID_ARGUMENT);
  CHECK(instance.index1 == 7);
  CHECK(sinew_load_asset_file(world, "no such file", &asset) == SINEW_UNREADABLE);
  CHECK(sinew_step(none, kTick_s, NULL) == SINEW_STALE_ID);
  return 0;
}

int main(int count, char** arguments) {
  CHECK(count == 2);
  CHECK(sinew_version() == SINEW_VERSION);
  sinew_world_def def = sinew_default_world_def();
  sinew_world world;
  CHECK(sinew_create_world(SINEW_LAYOUT, &def, &world) == SINEW_OK);
  sinew_asset asset;
  CHECK(sinew_load_asset_file(world, arguments[1], &asset) == SINEW_OK);
  const int line = misuse(world, asset);
  if (line) return line;

  sinew_asset_info info;
  CHECK(sinew_get_asset_info(world, asset, &info) == SINEW_OK);
  sinew_instance_def instance_def = sinew_default_instance_def();
  instance_def.asset = asset;
  sinew_instance instance;
  CHECK(sinew_create_instance(world, &instance_def, &instance) == SINEW_OK);
  sinew_matrix34* joints = malloc(info.joint_count * sizeof *joints);
  float* places = malloc(3 * info.vertex_count * sizeof *places);
  CHECK(joints && places);
  CHECK(sinew_bind_pose(world, asset, joints, info.joint_count) == SINEW_OK);
  for (int frame = 0; frame < 60; ++frame) {
    sinew_pose pose = sinew_default_pose();
    pose.joints = joints;
    pose.joint_count = info.joint_count;
    pose.root.position_m[1] = 0.01 * (frame % 20);
    CHECK(sinew_set_pose(world, instance, &pose) == SINEW_OK);
    sinew_frame_report report;
    CHECK(sinew_step(world, kTick_s, &report) == SINEW_OK);
    CHECK(report.instances_network + report.instances_modal == 1);
  }
  CHECK(sinew_read_positions(world, instance, SINEW_SPACE_CHARACTER, places, info.vertex_count - 1) ==
        SINEW_INVALID_ARGUMENT);
  CHECK(sinew_read_positions(world, instance, SINEW_SPACE_CHARACTER, places, info.vertex_count) == SINEW_OK);
  for (uint32_t i = 0; i < 3 * info.vertex_count; ++i) printf("%.9g\n", places[i]);

  CHECK(sinew_destroy_world(world) == SINEW_OK);
  CHECK(sinew_step(world, kTick_s, NULL) == SINEW_STALE_ID);
  CHECK(sinew_destroy_world(world) == SINEW_STALE_ID);
  free(places);
  free(joints);
  return 0;
}
