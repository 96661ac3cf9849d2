// run_scene.cpp  see run_scene.hpp.
#include "samples/rods/run_scene.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tests/rods/rod_scenes.hpp"

namespace sinew::sample {
namespace {

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Poses poses_of(const rods::RodBatch& batch, uint32_t strand) {
  Poses out;
  for (uint32_t i = 0; i < batch.segment_count(); ++i) out.push_back(batch.pose(strand, i));
  return out;
}

void measure_shape(const rods::RodBatch& batch, const Story& story, Measured* m) {
  for (uint32_t k = 0; k < story.actors.size(); ++k) {
    const Segments& segments = story.actors[k].segments;
    const double ratio = test::length_ratio(batch, segments, k);
    if (std::fabs(ratio - 1) > std::fabs(m->length_ratio - 1)) m->length_ratio = ratio;
    m->largest_gap = std::max(m->largest_gap, test::largest_stretch(batch, segments, k));
  }
}

void take_step(const Scene& scene, Measured* m) {
  rods::RodReport report;
  const double begin = thread_us();
  const Status status = scene.batch->step(static_cast<float>(scene.dt_s), scene.collider, &report);
  m->step_us.push_back(thread_us() - begin);
  accept(status);
  m->iterations_sum += report.iterations_sum;
  m->iterations_most = std::max(m->iterations_most, report.iterations);
  m->unconverged += report.unconverged;
  m->recovered += report.recovered;
  m->contacts_most = std::max(m->contacts_most, report.contacts);
  m->deepest_penetration = std::max(m->deepest_penetration, static_cast<double>(report.deepest_penetration));
}

std::string caption_of(const Scene& scene, double time_s) {
  if (scene.caption) return scene.caption(time_s);
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", time_s);
  return text;
}

Moment moment_of(const Scene& scene, double time_s) {
  Moment moment{time_s, caption_of(scene, time_s), {}};
  if (scene.prop) moment.prop = scene.prop(time_s);
  for (uint32_t k = 0; k < scene.batch->strand_count(); ++k)
    moment.poses.push_back(poses_of(*scene.batch, k));
  return moment;
}

}  // namespace

void accept(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.message);
}

void run_scene(const Scene& scene, Story* story) {
  Measured& m = story->measured;
  m.steps = static_cast<uint32_t>(std::lround(scene.seconds / scene.dt_s));
  m.dt_s = scene.dt_s;
  m.strands = scene.batch->strand_count();
  m.segments = scene.batch->segment_count();
  size_t next = 0;
  for (uint32_t i = 0; i <= m.steps; ++i) {
    const double time = i * scene.dt_s;
    while (next < scene.moments_s.size() && time >= scene.moments_s[next] - 0.5 * scene.dt_s) {
      story->moments.push_back(moment_of(scene, time)), ++next;
    }
    if (i == m.steps) break;
    scene.drive(time + scene.dt_s);
    take_step(scene, &m);
    measure_shape(*scene.batch, *story, &m);
    if (scene.depth) m.deepest_by_shape = std::max(m.deepest_by_shape, scene.depth());
  }
}

std::string report_line(const Story& story) {
  const Measured& m = story.measured;
  char text[320];
  std::snprintf(text, sizeof text,
                "%-10s %u x %u segments, %u steps of %.2f ms: l/l0 %.6f, largest gap %.1e of a segment, "
                "%.2f iterations (most %u), %u not converged, %.1f us a step (median)",
                story.name.c_str(), m.strands, m.segments, m.steps, 1e3 * m.dt_s, m.length_ratio,
                m.largest_gap, m.iterations_sum / m.strands / m.steps, m.iterations_most, m.unconverged,
                m.step_us.empty() ? 0.0 : median(m.step_us));
  if (m.contacts_most == 0) return text;
  char contacts[96];
  std::snprintf(contacts, sizeof contacts, ", up to %u contacts, %.2f of a radius deep", m.contacts_most,
                m.deepest_penetration);
  if (m.deepest_by_shape == 0) return std::string(text) + contacts;
  char shape[64];
  std::snprintf(shape, sizeof shape, " by contacts, %.3f by the shape", m.deepest_by_shape);
  return std::string(text) + contacts + shape;
}

}  // namespace sinew::sample
