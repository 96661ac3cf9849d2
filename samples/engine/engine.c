/* engine.c  An engine's loop with one character, as docs/in-your-engine.md shows it. */
#include <math.h>
#include <sinew/sinew.h>
#include <stdio.h>
#include <stdlib.h>

#define TRY(call) \
  if ((call) != SINEW_OK) return fprintf(stderr, "%s\n", sinew_message()), 2

/* What the GPU is given: a vertex shader adds `delta` to the bind position, takes `normal` for the file's,
 * and skins both by the joints of the engine. */
typedef struct {
  float delta[3];
  uint16_t normal[4]; /* halves */
} soft_vertex;

int main(int count, char** arguments) {
  sinew_world_def world_def = sinew_default_world_def();
  sinew_world world;
  sinew_asset asset;
  sinew_asset_info info;
  sinew_instance_def instance_def = sinew_default_instance_def();
  sinew_instance creature;
  TRY(sinew_create_world(SINEW_LAYOUT, &world_def, &world));
  TRY(sinew_load_asset_file(world, count > 1 ? arguments[1] : "out/creature.sinew", &asset));
  TRY(sinew_get_asset_info(world, asset, &info));
  instance_def.asset = asset;
  TRY(sinew_create_instance(world, &instance_def, &creature));

  /* Map: joint j of Sinew is the engine's joint of this path. Here the engine plays the baked clip, in its
   * order. */
  char path[256];
  for (uint32_t j = 0; j < info.joint_count && j < 4; ++j)
    if (sinew_joint_path(world, asset, j, path, sizeof path)) printf("joint %u is %s\n", j, path);
  sinew_matrix34* joints = malloc(info.joint_count * sizeof *joints); /* as animation has them */
  sinew_matrix34* shown = malloc(info.joint_count * sizeof *shown);   /* and with bones that are rods */
  soft_vertex* buffer = malloc((info.moved_vertex_count + 1) * sizeof *buffer);
  TRY(sinew_bind_pose(world, asset, joints, info.joint_count));

  sinew_pose pose = sinew_default_pose();
  pose.joints = joints;
  pose.joint_count = info.joint_count;
  sinew_surface_def read = sinew_default_surface_def();
  read.space = SINEW_SPACE_BIND;
  read.moved_only = true;
  read.capacity = info.moved_vertex_count;
  read.positions = (sinew_vertex_stream){buffer->delta, sizeof *buffer, SINEW_FLOAT3};
  read.normals = (sinew_vertex_stream){buffer->normal, sizeof *buffer, SINEW_HALF4};

  for (int frame = 0; frame < 60; ++frame) {
    if (info.clip_count > 0)
      TRY(sinew_sample_clip(world, asset, 0, frame / 60.0, SINEW_CLIP_LOOP, joints, info.joint_count));
    pose.root.position_m[1] = 0.2 * sin(0.2 * frame);
    TRY(sinew_set_pose(world, creature, &pose));
    TRY(sinew_step(world, 1.0f / 60, NULL));
    TRY(sinew_read_surface(world, creature, &read));
    TRY(sinew_read_joint_matrices(world, creature, shown, info.joint_count));
    /* upload buffer and shown, draw */
  }
  float most_m = 0;
  for (uint32_t i = 0; i < info.moved_vertex_count; ++i) most_m = fmaxf(most_m, fabsf(buffer[i].delta[1]));
  printf("%u of %u vertices are soft; at the end one is %.4f m off its pose\n", info.moved_vertex_count,
         info.vertex_count, (double)most_m);
  free(joints);
  free(shown);
  free(buffer);
  return sinew_destroy_world(world);
}
