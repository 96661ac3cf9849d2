/* native_steps.c  native_steps PACK FIGURES STEPS ISA: the page's scene without a page; prints the median
 * time of a step of the world and of everything that the page has the engine do in a frame, in microseconds.
 */
#include <pack_file.h>
#include <scene.h>
#include <sinew/sinew.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int fail(const char* what) { return fprintf(stderr, "native_steps: %s\n", what), 2; }

static double now_us(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static int by_size(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return x < y ? -1 : x > y;
}

int main(int count, char** arguments) {
  if (count != 5) return fail("usage: native_steps PACK FIGURES STEPS ISA");
  const uint32_t figures = (uint32_t)atoi(arguments[2]), steps = (uint32_t)atoi(arguments[3]);
  double* times[2] = {calloc(steps + 1, sizeof(double)), calloc(steps + 1, sizeof(double))};
  if (!times[0] || !times[1]) return fail("no memory");
  if (sinew_force_isa(arguments[4])) return fail(sinew_message());
  if (!read_pack_file(arguments[1])) return fail("the pack cannot be read");
  if (scene_open(figures, 0) || scene_set_clip(2)) return fail(scene_message());
  for (uint32_t i = 0; i < steps; ++i) {
    const double begin_us = now_us();
    if (scene_step(1.0f / 60)) return fail(scene_message());
    times[0][i] = (double)scene_report()[0];
    times[1][i] = now_us() - begin_us;
  }
  for (int k = 0; k < 2; ++k) qsort(times[k], steps, sizeof(double), by_size);
  printf("%.2f %.2f\n", times[0][steps / 2], times[1][steps / 2]);
  return 0;
}
