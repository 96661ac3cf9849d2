// limbs.cpp  see limbs.hpp.
#include "samples/contacts/limbs.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace sinew::sample {
namespace {

using Eigen::Vector3d;
using Rows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

Vector3d moved(const float* rows, const Vector3d& point) {
  return (Eigen::Map<const Rows>(rows).cast<double>() * point.homogeneous()).eval();
}

Vector3d vector(const float (&v)[3]) { return Eigen::Map<const Eigen::Vector3f>(v).cast<double>(); }

}  // namespace

Limbs::Limbs(const demo::CharacterFile& character, std::span<const std::string> names)
    : character_(character) {
  for (const pack::ProxyRecord& proxy : character.view.proxies) {
    const std::string_view bone = pack::string_at(character.view, character.view.joints[proxy.joint].name);
    if (std::ranges::any_of(names, [&](const std::string& name) { return bone.starts_with(name); }))
      records_.push_back(&proxy);
  }
}

void Limbs::move_to(std::span<const Matrix34> joints) {
  capsules_.clear();
  for (const pack::ProxyRecord* proxy : records_) {
    const float* bind = character_.view.joints[proxy->joint].inverse_bind;
    const float* now = &joints[proxy->joint].m[0][0];
    capsules_.push_back({moved(now, moved(bind, vector(proxy->from_m))),
                         moved(now, moved(bind, vector(proxy->to_m))), static_cast<double>(proxy->radius_m)});
  }
}

double Limbs::depth_m(const Vector3d& point) const {
  double deepest = 0;
  for (const Capsule& c : capsules_) {
    const Vector3d along = c.to - c.from;
    const double size = std::max(along.squaredNorm(), 1e-12);
    const double share = std::clamp((point - c.from).dot(along) / size, 0.0, 1.0);
    deepest = std::max(deepest, c.radius_m - (point - c.from - share * along).norm());
  }
  return deepest;
}

}  // namespace sinew::sample
