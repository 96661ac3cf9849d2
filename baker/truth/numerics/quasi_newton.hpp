// quasi_newton.hpp  L-BFGS memory around a given inverse Hessian (Nocedal and Wright 2006, algorithm 7.4;
// Liu, Bouaziz, Kavan 2017).
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <deque>
#include <utility>

namespace sinew::baker {

class QuasiNewtonMemory {
 public:
  void clear() { pairs_.clear(); }

  // The last step and how the gradient changed along it; without positive curvature it teaches nothing.
  void learn(Eigen::VectorXd step, Eigen::VectorXd change) {
    const double curvature = step.dot(change);
    if (!(curvature > 1e-12 * step.norm() * change.norm())) return;
    if (pairs_.size() == kPairs) pairs_.pop_front();
    pairs_.push_back({std::move(step), std::move(change), curvature});
  }

  // Approximately -(Hessian^-1) gradient; inverse(v) applies the given inverse in place.
  template <typename Inverse>
  Eigen::VectorXd direction(const Eigen::VectorXd& gradient, const Inverse& inverse) const {
    Eigen::VectorXd d = -gradient;
    std::array<double, kPairs> along{};
    for (size_t k = pairs_.size(); k-- > 0;) {
      along[k] = pairs_[k].step.dot(d) / pairs_[k].curvature;
      d -= along[k] * pairs_[k].change;
    }
    inverse(d);
    for (size_t k = 0; k < pairs_.size(); ++k)
      d += (along[k] - pairs_[k].change.dot(d) / pairs_[k].curvature) * pairs_[k].step;
    return d;
  }

 private:
  static constexpr size_t kPairs = 8;
  struct Pair {
    Eigen::VectorXd step, change;
    double curvature;
  };
  std::deque<Pair> pairs_;
};

}  // namespace sinew::baker
