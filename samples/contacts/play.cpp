// play.cpp  see play.hpp.
#include "samples/contacts/play.hpp"

#include <algorithm>
#include <cmath>

#include "baker/common/bad_input.hpp"
#include "samples/contacts/limbs.hpp"
#include "sinew/sinew.hpp"

namespace sinew::sample {
namespace {

using Positions = std::vector<Eigen::Vector3f>;

constexpr double kFrame_s = 1.0 / 60;

void require(const Status& status) {
  if (!status.ok()) throw baker::BadInput(status.message);
}

// One creature, in the scene's pose, moved by its root.
class Creature {
 public:
  Creature(const demo::CharacterFile& character, const ContactDef& contacts) {
    require(World::create({.max_assets = 1, .max_instances = 1}, &world_));
    require(world_.load_asset_file(character.path.c_str(), &asset_));
    require(world_.create_instance({.asset = asset_, .contacts = contacts}, &instance_));
    AssetInfo info;
    require(world_.asset_info(asset_, &info));
    joints_.resize(info.joint_count);
    places_.resize(info.vertex_count);
    require(world_.bind_pose(asset_, joints_));
  }

  std::span<const Matrix34> pose(const demo::CharacterFile& character, const ContactScene& scene,
                                 double t_s) {
    require(world_.bind_pose(asset_, joints_));
    if (scene.pose) scene.pose(character, t_s, joints_);
    return joints_;
  }
  FrameReport step(const RootTransform& root) {
    require(world_.set_pose(instance_, {.joints = joints_, .root = root}));
    const FrameReport report = world_.step(static_cast<float>(kFrame_s));
    require(world_.read_positions(instance_, {.space = Space::kWorld,
                                              .out = places_.data()->data(),
                                              .stride_bytes = sizeof(Eigen::Vector3f),
                                              .capacity = places_.size()}));
    return report;
  }
  const Positions& places() const { return places_; }
  InstanceReport report() const {
    InstanceReport out;
    require(world_.report(instance_, &out));
    return out;
  }

 private:
  World world_;
  AssetId asset_;
  InstanceId instance_;
  std::vector<Matrix34> joints_;
  Positions places_;
};

// Vertices whose weights come to a twentieth, as the runtime counts them.
std::vector<uint32_t> carried_vertices(const pack::PackView& pack) {
  constexpr float kCarried = 0.05f;
  std::vector<float> sums(pack.character->vertex_count);
  for (const pack::RegionRecord& region : pack.regions) {
    for (uint32_t v = 0; v < region.vertex_count; ++v) {
      for (uint32_t n = 0; n < region.node_count; ++n)
        sums[pack.region_vertices[region.first_vertex + v]] +=
            pack.carry[region.carry + size_t{n} * region.padded_vertices + v];
    }
  }
  std::vector<uint32_t> out;
  for (uint32_t v = 0; v < sums.size(); ++v)
    if (sums[v] > kCarried) out.push_back(v);
  return out;
}

// What there is to be inside of.
struct Solids {
  Boxes boxes;
  Limbs limbs;

  double depth_m(const Eigen::Vector3f& place) const {
    return std::max(boxes.depth_m(place.cast<double>()), limbs.depth_m(place.cast<double>()));
  }
  double deepest_mm(const Positions& places, const std::vector<uint32_t>& vertices) const {
    double deepest = 0;
    for (const uint32_t v : vertices) deepest = std::max(deepest, depth_m(places[v]));
    return 1000 * deepest;
  }
  ContactMoment::Surface surface(const Positions& places, const std::vector<uint32_t>& vertices) const {
    ContactMoment::Surface out{places, std::vector<float>(places.size())};
    for (const uint32_t v : vertices) out.depths_m[v] = static_cast<float>(depth_m(places[v]));
    return out;
  }
};

// How vertices stray from a straight line in time, and how fast that line is.
void measure_jitter(const std::vector<Positions>& frames, const std::vector<uint32_t>& vertices,
                    ContactMeasured* to) {
  const auto count = static_cast<double>(frames.size());
  const double middle = (count - 1) / 2, spread = count * (count * count - 1) / 12;
  double sum = 0, most = 0, fastest = 0;
  for (const uint32_t v : vertices) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = mean;
    for (size_t f = 0; f < frames.size(); ++f) {
      const Eigen::Vector3d place = frames[f][v].cast<double>();
      mean += place / count;
      slope += (static_cast<double>(f) - middle) / spread * place;
    }
    for (size_t f = 0; f < frames.size(); ++f) {
      const Eigen::Vector3d on_line = mean + (static_cast<double>(f) - middle) * slope;
      const double off = (frames[f][v].cast<double>() - on_line).squaredNorm();
      sum += off;
      most = std::max(most, off);
    }
    fastest = std::max(fastest, slope.norm() / kFrame_s);
  }
  to->jitter_rms_mm = 1000 * std::sqrt(sum / (count * static_cast<double>(vertices.size())));
  to->jitter_most_mm = 1000 * std::sqrt(most);
  to->creep_mm_s = 1000 * fastest;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

ContactPlay play(const demo::CharacterFile& character, const ContactScene& scene) {
  Solids solids{Boxes(scene.boxes), Limbs(character, scene.limbs)};
  Boxes& boxes = solids.boxes;
  Creature alone(character, {}),
      touching(character,
               {.source = scene.boxes.empty() ? nullptr : boxes.source(), .own_body = !scene.limbs.empty()});
  const std::vector<uint32_t> soft = carried_vertices(character.view);
  ContactPlay out;
  ContactMeasured& to = out.measured;
  std::vector<Positions> resting;
  std::vector<double> alone_us, touching_us;
  size_t next = 0;
  for (int frame = 0; frame * kFrame_s < scene.seconds; ++frame) {
    const double t_s = frame * kFrame_s;
    boxes.move_to(t_s, kFrame_s);
    alone.pose(character, scene, t_s);
    solids.limbs.move_to(touching.pose(character, scene, t_s));
    const double us_alone = static_cast<double>(alone.step(scene.root(t_s)).total_us);
    const double us = static_cast<double>(touching.step(scene.root(t_s)).total_us);
    const InstanceReport report = touching.report();
    if (report.vertices_touched > 0) alone_us.push_back(us_alone), touching_us.push_back(us);
    to.deepest_alone_mm = std::max(to.deepest_alone_mm, solids.deepest_mm(alone.places(), soft));
    to.deepest_mm = std::max(to.deepest_mm, solids.deepest_mm(touching.places(), soft));
    to.volume_most_l = std::max(to.volume_most_l, 1000 * static_cast<double>(report.contact_volume_m3));
    to.vertices_most = std::max(to.vertices_most, report.vertices_touched);
    to.dropped += report.contacts_dropped;
    to.refused += report.contacts_refused;
    if (t_s >= scene.rest_from_s && t_s < scene.rest_from_s + 0.9) resting.push_back(touching.places());
    for (; next < scene.moments_s.size() && t_s + kFrame_s / 2 >= scene.moments_s[next]; ++next) {
      out.moments.push_back(
          {t_s, solids.surface(alone.places(), soft), solids.surface(touching.places(), soft), {}});
      render::Mesh* drawn = &out.moments.back().boxes;
      scene.sees_into ? boxes.add_edges_to(drawn) : boxes.add_to(drawn);
    }
  }
  measure_jitter(resting, soft, &to);
  to.frame_alone_us = median(alone_us);
  to.frame_us = median(touching_us);
  return out;
}

}  // namespace sinew::sample
