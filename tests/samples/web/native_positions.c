/* native_positions.c  native_positions PACK VERTICES OUT: plays what page.mjs plays in the browser, and
 * writes where all vertices of both figures are. */
#include <pack_file.h>
#include <scene.h>
#include <stdio.h>
#include <stdlib.h>

static int fail(const char* what) { return fprintf(stderr, "native_positions: %s\n", what), 2; }

int main(int count, char** arguments) {
  if (count != 4) return fail("usage: native_positions PACK VERTICES OUT");
  if (!read_pack_file(arguments[1])) return fail("the pack cannot be read");
  if (scene_open(2, SCENE_TOUCH_BALL) || scene_set_clip(2)) return fail(scene_message());
  if (scene_set_air(9.80665f, 6, 0, 3, 0.3f, 0.5f)) return fail(scene_message());
  scene_set_ball(0.1f, 0.3f, 0.6f, 0.12f);
  for (int step = 0; step < 120; ++step) {
    if (step == 30) scene_pull(0, 0.3f, 0.2f, 0.1f), scene_set_ball(0.1f, 0.3f, 0.3f, 0.12f);
    if (step == 60) scene_let_go();
    if (scene_step(1.0f / 60)) return fail(scene_message());
  }
  FILE* out = fopen(arguments[3], "wb");
  const size_t floats = 3 * (size_t)atol(arguments[2]);
  for (uint32_t figure = 0; out && figure < 2; ++figure)
    if (fwrite(scene_positions(figure), sizeof(float), floats, out) != floats) return fail("cannot write");
  return out && fclose(out) == 0 ? 0 : fail("cannot write");
}
