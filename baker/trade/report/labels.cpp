// labels.cpp  see labels.hpp.
#include "baker/trade/report/labels.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace sinew::baker {
namespace {

using Point = Eigen::Vector2f;

constexpr float kGap = 3;    // around boxes and dots
constexpr float kApart = 6;  // names on one line

struct Thread {
  Point from, to;
};

LabelBox widened(const LabelBox& box, const Point& by) { return {box.min() - by, box.max() + by}; }

// Looks every four pixels: names are higher.
bool crosses(const Thread& thread, const LabelBox& box) {
  constexpr float kBetween = 4;
  const Point way = thread.to - thread.from;
  const int steps = 1 + static_cast<int>(way.norm() / kBetween);
  for (int i = 0; i <= steps; ++i) {
    const Point at = thread.from + way * (static_cast<float>(i) / static_cast<float>(steps));
    if (box.contains(at)) return true;
  }
  return false;
}

float side(const Thread& of, const Point& point) {
  const Point way = of.to - of.from, to = point - of.from;
  return way.x() * to.y() - way.y() * to.x();
}
bool cross(const Thread& a, const Thread& b) {
  return side(a, b.from) * side(a, b.to) < 0 && side(b, a.from) * side(b, a.to) < 0;
}

float distance(const Thread& thread, const Point& point) {
  const Point way = thread.to - thread.from;
  const float share = (point - thread.from).dot(way) / std::max(way.squaredNorm(), 1e-6f);
  return (thread.from + way * std::clamp(share, 0.0f, 1.0f) - point).norm();
}

// Where its box touches the circle of that radius about the dot, in that direction.
LabelBox box_at(const Labelled& label, float radius, float turn) {
  const Point towards(std::cos(turn), std::sin(turn));
  const Point half = 0.5f * label.size, middle = label.dot + radius * towards + half.cwiseProduct(towards);
  return {middle - half, middle + half};
}

class Places {
 public:
  Places(std::span<const Labelled> all, std::span<const Point> front, const LabelBox& room)
      : all_(all), room_(room) {
    for (size_t i = 1; i < front.size(); ++i) front_.push_back({front[i - 1], front[i]});
  }
  bool is_free(const LabelBox& box) const {
    const LabelBox wide = widened(box, {kGap, kGap}), alone = widened(box, {kApart, kGap});
    const auto lies_under = [&](const Thread& line) { return crosses(line, wide); };
    const auto lies_on = [&](const Labelled& other) {
      return wide.exteriorDistance(other.dot) < kDotRadius + kGap;
    };
    return room_.contains(wide) && std::ranges::none_of(front_, lies_under) &&
           std::ranges::none_of(all_, lies_on) &&
           std::ranges::none_of(boxes_, [&](const LabelBox& other) { return alone.intersects(other); });
  }
  // Not another's, by what lies between, or lies nearer.
  bool is_plain_to_see(const Labelled& label, const LabelBox& box) const {
    const Thread thread{label.dot, nearest(box, label.dot)};
    const auto meets = [&](const Thread& other) { return crosses(other, box) || cross(other, thread); };
    const float far = box.exteriorDistance(label.dot);
    const auto is_in_its_way = [&](const Labelled& other) {
      const bool is_own = (other.dot - label.dot).norm() < kDotRadius;  // or as good as on its own
      const bool is_taken_for = far < kThreadFrom && box.exteriorDistance(other.dot) < far + kGap;
      return !is_own && (is_taken_for || distance(thread, other.dot) < kDotRadius);
    };
    return std::ranges::none_of(threads_, meets) && std::ranges::none_of(all_, is_in_its_way) &&
           std::ranges::none_of(boxes_, [&](const LabelBox& other) { return crosses(thread, other); });
  }
  void take(const Labelled& label, const LabelBox& box) {
    boxes_.push_back(box);
    threads_.push_back({label.dot, nearest(box, label.dot)});
  }

 private:
  std::span<const Labelled> all_;
  LabelBox room_;
  std::vector<Thread> front_, threads_;
  std::vector<LabelBox> boxes_;
};

// About the dot, to the right first, then to the left, above, below, and between; then further off.
std::vector<LabelBox> places_about(const Labelled& label) {
  constexpr float kFirst = 12, kMost = 500, kFurther = 6, kQuarter = 1.5707963f;
  constexpr float kQuarters[] = {0,      2,     -1,     1,     -0.25f, 0.25f, -0.5f,  0.5f,
                                 -0.75f, 0.75f, -1.25f, 1.25f, -1.5f,  1.5f,  -1.75f, 1.75f};
  std::vector<LabelBox> out;
  for (float radius = kFirst; radius < kMost; radius += kFurther)
    for (const float quarters : kQuarters) out.push_back(box_at(label, radius, quarters * kQuarter));
  return out;
}

struct Choice {
  LabelBox box;
  float price;  // pixels from the dot, and what of it is to be avoided
};

Choice chosen_place(const Places& places, const Labelled& label) {
  constexpr float kHidden = 1e3f, kOverprinted = 1e6f;
  const std::vector<LabelBox> all = places_about(label);
  const auto price = [&](const LabelBox& box) { return box.exteriorDistance(label.dot); };
  for (const LabelBox& box : all)
    if (places.is_free(box) && places.is_plain_to_see(label, box)) return {box, price(box)};
  for (const LabelBox& box : all)
    if (places.is_free(box)) return {box, price(box) + kHidden};
  return {all.front(), kOverprinted};
}

struct Plan {
  std::vector<LabelBox> boxes;
  float price = 0;
};

// One after the other, in that order.
Plan planned(Places places, std::span<const Labelled> all, const std::vector<size_t>& order) {
  Plan plan{.boxes = std::vector<LabelBox>(all.size())};
  for (const size_t i : order) {
    const auto [box, price] = chosen_place(places, all[i]);
    places.take(all[i], box);
    plan.boxes[i] = box;
    plan.price += price;
  }
  return plan;
}

}  // namespace

std::vector<LabelBox> place_labels(std::span<const Labelled> all, std::span<const Point> front,
                                   const LabelBox& room) {
  constexpr int kOrders = 64;
  std::vector<size_t> order(all.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::minstd_rand random;
  Plan best = planned({all, front, room}, all, order);
  for (int i = 1; i < kOrders; ++i) {
    for (size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
    if (Plan plan = planned({all, front, room}, all, order); plan.price < best.price) best = std::move(plan);
  }
  return best.boxes;
}

Point nearest(const LabelBox& box, const Point& to) { return to.cwiseMax(box.min()).cwiseMin(box.max()); }

}  // namespace sinew::baker
