// tier_change.cpp  see tier_change.hpp.
#include "perf/frames/tier_change.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::perf {
namespace {

constexpr size_t kBefore = 3;  // frames before the change that steps are taken from

float distance(const Surface& a, const Surface& b, size_t vertex) {
  const size_t v = 3 * vertex;
  return std::hypot(a[v] - b[v], a[v + 1] - b[v + 1], a[v + 2] - b[v + 2]);
}

// The longest of the last three steps up to each frame from `first` on; frames before the first are still.
std::vector<Steps> longest_steps(const std::vector<Surface>& frames, size_t first) {
  std::vector<Steps> out;
  for (size_t t = first; t < frames.size(); ++t) {
    Steps longest(frames[t].size() / 3, 0.0f);
    for (size_t back = 0; back < 3 && back < t; ++back)
      for (size_t v = 0; v < longest.size(); ++v)
        longest[v] = std::max(longest[v], distance(frames[t - back], frames[t - back - 1], v));
    out.push_back(std::move(longest));
  }
  return out;
}

// From what was seen, the last of it shown just before the change.
Stay stay_of(JumpPlayer& player, const Way& left, std::vector<Surface> seen) {
  Stay stay{.mark = player.mark(), .shown = seen.back(), .without = {}, .steps = {}, .had = {}};
  const size_t first = seen.size(), last = std::min(stay.mark.tick + kWatched, player.ticks());
  for (size_t tick = stay.mark.tick; tick < last; ++tick) {
    player.step(left);
    seen.push_back(player.surface());
  }
  stay.steps = longest_steps(seen, first);
  stay.without.assign(seen.begin() + static_cast<ptrdiff_t>(first), seen.end());
  return stay;
}

// Leaves the tier after `tick` ticks. What is seen, up to the last frame before the change.
std::vector<Surface> leave(JumpPlayer& player, const Run& run, size_t tick, const Way& left, size_t ticks) {
  std::vector<Surface> seen(run.surfaces.begin() + static_cast<ptrdiff_t>(tick - kBefore),
                            run.surfaces.begin() + static_cast<ptrdiff_t>(tick));
  if (left.hidden) seen.clear();
  for (size_t t = 0; t < ticks; ++t) {
    player.step(left);
    if (!left.hidden) seen.push_back(player.surface());
  }
  if (!left.hidden) return seen;
  player.step({});
  return {player.surface()};
}

std::vector<Surface> followed(JumpPlayer& player, const Way& way, size_t frames) {
  std::vector<Surface> seen;
  for (size_t t = 0; t < frames; ++t) {
    player.step(way);
    seen.push_back(player.surface());
  }
  return seen;
}

}  // namespace

Run run_in(JumpPlayer& player, const Way& way, size_t apart_ticks) {
  const JumpPlayer::Mark start = player.mark();
  Run run;
  for (size_t tick = 0; tick < player.ticks(); ++tick) {
    player.step(way);
    run.surfaces.push_back(player.surface());
    if (tick % apart_ticks == apart_ticks - 1) run.marks.push_back(player.mark());
  }
  run.steps = longest_steps(run.surfaces, 0);
  player.go_back(start);
  return run;
}

std::vector<Stay> stays_in(const Run& run) {
  std::vector<Stay> out;
  for (size_t change = 0; change < run.marks.size(); ++change) {
    const size_t first = run.marks[change].tick, last = std::min(first + kWatched, run.surfaces.size());
    const auto part = [&](const auto& of) {
      return std::vector(of.begin() + static_cast<ptrdiff_t>(first),
                         of.begin() + static_cast<ptrdiff_t>(last));
    };
    out.push_back({run.marks[change], run.surfaces[first - 1], part(run.surfaces), part(run.steps), {}});
  }
  return out;
}

std::vector<Stay> stays_after(JumpPlayer& player, const Run& run, const Way& left, size_t ticks) {
  std::vector<Stay> out;
  const Way back = left.hidden ? Way{} : left;
  for (size_t change = 0; change < run.marks.size(); ++change) {
    player.go_back(run.marks[change]);
    std::vector<Surface> seen = leave(player, run, run.marks[change].tick, left, ticks);
    out.push_back(stay_of(player, back, std::move(seen)));
    if (left.hidden || ticks > world::kCaughtUpTicks) continue;
    const auto had = run.steps.begin() + static_cast<ptrdiff_t>(out.back().mark.tick);
    out.back().had.assign(had, had + static_cast<ptrdiff_t>(out.back().steps.size()));
  }
  return out;
}

Jump largest_jump(JumpPlayer& player, const std::vector<Stay>& from, const Run& to, const Way& way) {
  Jump jump;
  for (const Stay& stay : from) {
    if (stay.without.empty()) continue;
    player.go_back(stay.mark);
    const std::vector<Surface> seen = followed(player, way, stay.without.size());
    for (size_t t = 0; t < seen.size(); ++t) {
      const Surface& before = t == 0 ? stay.shown : seen[t - 1];
      const Steps& other = to.steps[stay.mark.tick + t];
      for (size_t v = 0; v < other.size(); ++v) {
        const double step = distance(seen[t], before, v), own = std::max(stay.steps[t][v], other[v]);
        if (step - own > jump.beyond_m)
          jump.beyond_m = step - own, jump.change_tick = stay.mark.tick, jump.after_ticks = t;
        const double had = stay.had.empty() ? 0 : double{stay.had[t][v]};
        jump.beyond_all_m = std::max(jump.beyond_all_m, step - std::max(own, had));
        if (t == 0) jump.at_once_m = std::max(jump.at_once_m, double{distance(seen[0], stay.without[0], v)});
      }
    }
  }
  return jump;
}

}  // namespace sinew::perf
