// load_weights.cpp  see load_weights.hpp.
#include "baker/truth/modes/load_weights.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kCertain = 1e4;  // a: what all nodes of a bone feel alike, all its flesh feels
// Of the mean at the nodes of what is not alike: those that nearly coincide say one thing.
constexpr double kNoise = 1e-2;
// C's trace over that of what is not alike. Far less, and what a few nodes swing by themselves is taken for
// all flesh's, and the base diverges.
constexpr double kSwinging = 0.3;

double shared_skin(const Influences& a, const Influences& b) {
  double sum = 0;
  for (size_t i = 0; i < kInfluences; ++i)
    for (size_t j = 0; j < kInfluences; ++j)
      if (a.joint[i] == b.joint[j])
        sum += static_cast<double>(a.weight[i]) * static_cast<double>(b.weight[j]);
  return sum;
}

struct Size {
  Vector3 middle = Vector3::Zero();
  double radius_m = 0;
};

Size size_of(const std::vector<Vector3>& places) {
  Size size;
  for (const Vector3& place : places) size.middle += place / static_cast<double>(places.size());
  for (const Vector3& place : places) size.radius_m = std::max(size.radius_m, (place - size.middle).norm());
  return size;
}

// Of skinning alone.
MatrixXd driven(const LoadPlaces& p, const LoadPlaces& q, const Size& size) {
  const double over = size.radius_m > 0 ? 1 / (size.radius_m * size.radius_m) : 0;
  MatrixXd k(static_cast<Index>(p.size()), static_cast<Index>(q.size()));
  for (size_t i = 0; i < p.size(); ++i)
    for (size_t j = 0; j < q.size(); ++j)
      k(static_cast<Index>(i), static_cast<Index>(j)) =
          (kCertain + over * (p.place[i] - size.middle).dot(q.place[j] - size.middle)) *
          (1 + shared_skin(p.skin[i], q.skin[j]));
  return k;
}

// C before it is scaled: the mean over the axes.
MatrixXd swinging(const LoadPlaces& p, const LoadPlaces& q) {
  MatrixXd c = MatrixXd::Zero(static_cast<Index>(p.size()), static_cast<Index>(q.size()));
  for (Index axis = 0; axis < 3; ++axis) {
    const MatrixXd of_p = p.answers(Eigen::seq(axis, Eigen::last, 3), Eigen::all),
                   of_q = q.answers(Eigen::seq(axis, Eigen::last, 3), Eigen::all);
    c += of_p * of_q.transpose();
  }
  return c / 3;
}

}  // namespace

MatrixXd load_weights(const LoadPlaces& nodes, const LoadPlaces& flesh) {
  const Size size = size_of(nodes.place);
  MatrixXd among = driven(nodes, nodes, size), towards = driven(flesh, nodes, size);
  const MatrixXd swung = swinging(nodes, nodes);
  double unlike = 0;  // at most: of a bone's nodes all in one place, nothing is
  for (size_t n = 0; n < nodes.size(); ++n) unlike += 1 + shared_skin(nodes.skin[n], nodes.skin[n]);
  const double scale = swung.trace() > 0 ? kSwinging * unlike / swung.trace() : 0;
  among += scale * swung;
  towards += scale * swinging(flesh, nodes);
  among.diagonal().array() += kNoise * unlike / static_cast<double>(nodes.size());
  return among.ldlt().solve(towards.transpose()).transpose();
}

}  // namespace sinew::baker
