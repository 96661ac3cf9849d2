// yardstick.cpp  see yardstick.hpp.
#include "baker/measure/yardstick.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "baker/common/bad_input.hpp"
#include "character/motion/pose.hpp"
#include "character/output/read.hpp"
#include "character/rods/rod_publish.hpp"

namespace sinew::baker {
namespace {

using Affine = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kMillimetres = 1e3f;
constexpr size_t kShortTicks = 50;

std::vector<float> positions_of(const ClosedLoop& loop) {
  const uint32_t count = loop.instance().asset->vertex_count();
  std::vector<float> out(size_t{3} * count);
  world::read_surface(loop.instance(), {.capacity = count, .positions = {out.data()}});
  return out;
}

float distance_mm(const float* a, const float* b) {
  return kMillimetres * std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

size_t ticks_of(const TrueSurface& surface) { return std::min(surface.motion().ticks(), kMostTicks); }

Vector3f at(const float* positions, uint32_t vertex) {
  return Eigen::Map<const Vector3f>(positions + size_t{3} * vertex);
}

// [joints][12]
std::vector<float> matrices_of(const ClosedLoop& loop) {
  const pack::PackView& pack = loop.instance().asset->pack;
  std::vector<float> out(size_t{12} * pack.joints.size());
  world::skin_matrices(pack.joints, world::shown_joints(loop.instance()), out.data());
  return out;
}

// How skinning turns and stretches what is at the vertex, bind pose to posed.
Matrix3f skin_of(const pack::SkinRecord& skin, const float* matrices) {
  Matrix3f sum = Matrix3f::Zero();
  for (uint32_t i = 0; i < pack::kInfluences; ++i) {
    const Eigen::Map<const Affine> joint(matrices + size_t{12} * skin.joint[i]);
    sum += skin.weight[i] * joint.leftCols<3>();
  }
  return sum;
}

}  // namespace

// Distances of one way, and what skinning was off there.
class Yardstick::Sums {
 public:
  explicit Sums(size_t motions) : motions_(motions) {}

  void add(size_t motion, size_t tick, float mm, float skinning_mm) {
    all_.add(mm, skinning_mm);
    if (tick <= kShortTicks) first_.add(mm, skinning_mm);
    motions_[motion].mm += static_cast<double>(mm);
    motions_[motion].skinning_mm += static_cast<double>(skinning_mm);
    motions_[motion].count += 1;
  }
  Error error() { return {all_.spread(), first_.spread(), ratios()}; }

 private:
  struct Distances {
    std::vector<float> mm;
    double skinning_mm = 0;

    void add(float distance, float skinning) {
      mm.push_back(distance);
      skinning_mm += static_cast<double>(skinning);
    }
    Spread spread() {
      Spread out;
      double sum = 0, squares = 0;
      for (const float d : mm) sum += static_cast<double>(d);
      out.mean_mm = sum / static_cast<double>(mm.size());
      for (const float d : mm) squares += std::pow(static_cast<double>(d) - out.mean_mm, 2);
      out.sd_mm = std::sqrt(squares / static_cast<double>(mm.size()));
      const auto p95 = mm.begin() + static_cast<ptrdiff_t>(0.95 * static_cast<double>(mm.size()));
      std::ranges::nth_element(mm, p95);
      out.p95_mm = static_cast<double>(*p95);
      out.worst_mm = static_cast<double>(std::ranges::max(mm));
      out.ratio = sum / skinning_mm;
      return out;
    }
  };

  struct Along {
    double mm = 0, skinning_mm = 0, count = 0;
    double skinning() const { return count > 0 ? skinning_mm / count : 0; }
  };

  std::vector<double> ratios() const {
    constexpr double kHardly = 0.02;  // of what skinning is off along the liveliest
    const double liveliest = std::ranges::max(motions_, {}, &Along::skinning).skinning();
    std::vector<double> out;
    for (const Along& along : motions_)
      out.push_back(along.skinning() > kHardly * liveliest ? along.mm / along.skinning_mm
                                                           : std::numeric_limits<double>::quiet_NaN());
    return out;
  }

  Distances all_, first_;
  std::vector<Along> motions_;
};

Yardstick::Yardstick(const LoadedPack& character, std::span<const TrueSurface> surfaces)
    : surfaces_(surfaces) {
  std::map<uint32_t, size_t> region_of;
  const pack::PackView& view = character.view();
  for (size_t r = 0; r < view.regions.size(); ++r)
    for (const uint32_t vertex :
         view.region_vertices.subspan(view.regions[r].first_vertex, view.regions[r].vertex_count))
      region_of.emplace(vertex, r);
  for (const auto& [vertex, region] : region_of) vertices_.push_back(vertex), region_.push_back(region);
  double whole = 0;
  for (size_t m = 0; m < surfaces_.size(); ++m) {
    skin(character, m);
    for (const float mm : skinning_mm_[m]) whole += static_cast<double>(mm);
  }
  if (!(whole > 0)) throw BadInput("--truth: nothing moves in these motions; give others");
}

void Yardstick::skin(const LoadedPack& character, size_t m) {
  const TrueSurface& surface = surfaces_[m];
  ClosedLoop loop(character, surface.motion());
  std::vector<Vector3f> bound(vertices_.size());  // the truth's displacement before skinning turns it
  std::vector<float>&skinning = skinning_mm_.emplace_back(), &previous = previous_mm_.emplace_back(),
  &truths = truth_.emplace_back();
  for (size_t tick = 0; tick <= ticks_of(surface); ++tick) {
    if (tick > 0) loop.tick(Tier::kSkinning);
    const std::vector<float> skinned = positions_of(loop), matrices = matrices_of(loop);
    for (size_t i = 0; i < vertices_.size(); ++i) {
      const Vector3f here = at(skinned.data(), vertices_[i]);
      const Vector3f unlimited = at(surface.positions(tick), vertices_[i]) - here;
      const Vector3f truth = here + surface.motion().limited(tick, region_[i]) * unlimited;
      truths.insert(truths.end(), truth.begin(), truth.end());
      const Matrix3f turn = skin_of(character.view().skin[vertices_[i]], matrices.data());
      skinning.push_back(kMillimetres * (truth - here).norm());
      previous.push_back(kMillimetres * (truth - here - turn * bound[i]).norm());
      bound[i] = turn.inverse() * (truth - here);
    }
  }
}

const float* Yardstick::truth(size_t motion, size_t tick, size_t vertex) const {
  return &truth_[motion][3 * (tick * vertices_.size() + vertex)];
}

Error Yardstick::of_skinning() const {
  Sums sums(surfaces_.size());
  for (size_t m = 0; m < surfaces_.size(); ++m)
    for (size_t k = vertices_.size(); k < skinning_mm_[m].size(); ++k)
      sums.add(m, k / vertices_.size(), skinning_mm_[m][k], skinning_mm_[m][k]);
  return sums.error();
}

Error Yardstick::of_previous_frame() const {
  Sums sums(surfaces_.size());
  for (size_t m = 0; m < surfaces_.size(); ++m)
    for (size_t k = vertices_.size(); k < previous_mm_[m].size(); ++k)
      sums.add(m, k / vertices_.size(), previous_mm_[m][k], skinning_mm_[m][k]);
  return sums.error();
}

Error Yardstick::of(const LoadedPack& character, Tier tier, uint32_t level) const {
  Sums sums(surfaces_.size());
  for (size_t m = 0; m < surfaces_.size(); ++m) {
    ClosedLoop loop(character, surfaces_[m].motion());
    for (size_t tick = 1; tick <= ticks_of(surfaces_[m]); ++tick) {
      loop.tick(tier, level);
      const std::vector<float> places = positions_of(loop);
      for (size_t i = 0; i < vertices_.size(); ++i)
        sums.add(m, tick, distance_mm(&places[3 * vertices_[i]], truth(m, tick, i)),
                 skinning_mm_[m][tick * vertices_.size() + i]);
    }
  }
  return sums.error();
}

Error Yardstick::of_extrapolation(const LoadedPack& character, size_t ticks) const {
  Sums sums(surfaces_.size());
  for (size_t m = 0; m < surfaces_.size(); ++m) {
    ClosedLoop loop(character, surfaces_[m].motion());
    ClosedLoop::Checkpoint left;
    for (size_t tick = ticks + 1; tick <= ticks_of(surfaces_[m]); ++tick) {
      loop.tick();
      loop.save(&left);
      for (size_t k = 0; k < ticks; ++k) loop.tick(Tier::kExtrapolate);
      const std::vector<float> places = positions_of(loop);
      for (size_t i = 0; i < vertices_.size(); ++i)
        sums.add(m, tick, distance_mm(&places[3 * vertices_[i]], truth(m, tick, i)),
                 skinning_mm_[m][tick * vertices_.size() + i]);
      loop.restore(left);
    }
  }
  return sums.error();
}

}  // namespace sinew::baker
