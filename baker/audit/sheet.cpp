// sheet.cpp  Plays the motions of the worst moments once more and stops at them.
#include "baker/audit/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "baker/audit/bounds.hpp"
#include "baker/audit/player.hpp"
#include "baker/preview/facing.hpp"
#include "baker/preview/pack_mesh.hpp"
#include "baker/render/picture/layout.hpp"
#include "baker/render/renderer.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kMostCells = 12;
constexpr int kWidth_px = 400, kHeight_px = 320, kSamples = 8, kColumns = 4;

struct Shot {
  size_t part;
  const Moment* moment;
  bool is_stretch;
  double badness;
  render::Cell cell;
};

// Worst first; each part by what is further beyond its bound.
std::vector<Shot> choose_shots(const Audit& audit) {
  std::vector<Shot> shots;
  for (size_t p = 0; p < audit.parts.size(); ++p) {
    const PartAudit& part = audit.parts[p];
    const double bound = most_stretch(part.part.is_rod);
    const bool torn = !(part.edge_stretch.value <= bound);
    const Moment& moment = torn ? part.edge_stretch : part.displacement_m;
    if (moment.motion.empty()) continue;
    const double badness =
        torn ? part.edge_stretch.value / bound : part.displacement_m.value / audit.height_m;
    shots.push_back({p, &moment, torn, std::isnan(badness) ? HUGE_VAL : badness, {}});
  }
  std::ranges::stable_sort(shots, std::greater<>{}, &Shot::badness);
  if (shots.size() > kMostCells) shots.resize(kMostCells);
  return shots;
}

// How far the worst edge of each vertex is on its way from unstretched to twice the bound's stretch.
std::vector<float> redness(const AuditedParts& parts, const Player& player, double height_m) {
  std::vector<float> red(parts.of_vertex.size(), 0);
  for (const AuditedParts::Edge& edge : parts.edges) {
    const double skinned = (player.skinned().col(edge.a) - player.skinned().col(edge.b)).norm();
    if (skinned < kShortestEdge * height_m) continue;
    const double shown = (player.shown().col(edge.a) - player.shown().col(edge.b)).norm();
    const auto here = static_cast<float>(
        std::clamp((edge.stretch(skinned, shown) - 1.1) / (kMostEdgeStretch - 1.1), 0.0, 1.0));
    for (const uint32_t v : {edge.a, edge.b}) red[v] = std::max(red[v], here);
  }
  return red;
}

render::Mesh mesh_of(const AuditedPack& pack, const AuditedParts& parts, const Player& player) {
  render::Mesh mesh = bind_mesh(pack.view);
  for (size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.positions[v] = player.shown().col(static_cast<Eigen::Index>(v));
  mesh.normals = render::smooth_normals(mesh.positions, mesh.triangles, pack.view.welded);
  const std::vector<float> red = redness(parts, player, static_cast<double>(pack.view.character->height_m));
  const render::Rgb signal = render::linear_from_srgb({215, 35, 25});
  for (size_t v = 0; v < red.size(); ++v) mesh.colors[v] += red[v] * (signal - mesh.colors[v]);
  return mesh;
}

// The part in the middle, with as much around it.
render::Camera camera_of(const render::Mesh& mesh, const AuditedParts& parts, size_t part, float yaw_deg) {
  Eigen::AlignedBox3f box;
  for (size_t v = 0; v < parts.of_vertex.size(); ++v)
    if (parts.of_vertex[v] == static_cast<int>(part)) box.extend(mesh.positions[v]);
  const Eigen::AlignedBox3f body = render::bounding_box(mesh.positions);
  if (box.isEmpty()) box = body;
  const Eigen::Vector3f more = Eigen::Vector3f::Constant(0.12f * body.sizes().y());
  return render::camera_around(Eigen::AlignedBox3f(box.min() - more, box.max() + more),
                               static_cast<float>(kWidth_px) / kHeight_px, {.yaw_deg = yaw_deg + 40});
}

std::string caption_of(const Audit& audit, const Shot& shot) {
  const PartAudit& part = audit.parts[shot.part];
  char text[64];
  if (shot.is_stretch)
    std::snprintf(text, sizeof text, ": stretch %.2f, ", part.edge_stretch.value);
  else
    std::snprintf(text, sizeof text, ": moved %.3f heights, ", part.displacement_m.value / audit.height_m);
  // Exporters set the skeleton's name before a clip's: "Armature|Run".
  const std::string& motion = shot.moment->motion;
  const size_t bar = motion.rfind('|');
  return part.part.name + text + (bar == std::string::npos ? motion : "clip " + motion.substr(bar + 1)) +
         ", tick " + std::to_string(shot.moment->tick);
}

void shoot(const AuditedPack& pack, const AuditedParts& parts, const Player& player, Shot& shot) {
  const render::Mesh mesh = mesh_of(pack, parts, player);
  const float yaw_deg = facing_yaw_deg(pack.view);
  render::RenderOptions options;
  options.width = kWidth_px;
  options.height = kHeight_px;
  options.samples = kSamples;
  options.floor_y = render::bounding_box(mesh.positions).min().y();
  options.grid_m = render::grid_for_height(pack.view.character->height_m);
  options.gloss = 0.3f;
  options.studio = render::Studio::facing(yaw_deg);
  shot.cell.image = render::render(mesh, camera_of(mesh, parts, shot.part, yaw_deg), options);
}

void play_to_shots(const AuditedPack& pack, const AuditedParts& parts, const AuditMotion& motion,
                   std::vector<Shot>& shots) {
  size_t last = 0;
  for (const Shot& shot : shots)
    if (shot.moment->motion == motion.name) last = std::max(last, shot.moment->tick);
  if (last == 0) return;
  Player player(pack, motion);
  while (player.tick() < last) {
    player.advance();
    for (Shot& shot : shots) {
      if (shot.moment->motion != motion.name || shot.moment->tick != player.tick()) continue;
      player.read();
      shoot(pack, parts, player, shot);
    }
  }
}

}  // namespace

void write_audit_sheet(const std::string& path, const Audit& audit, const AuditedPack& pack) {
  const AuditedParts parts = find_parts(pack.view);
  std::vector<Shot> shots = choose_shots(audit);
  for (const AuditMotion& motion : audit_motions(pack.view)) play_to_shots(pack, parts, motion, shots);
  std::vector<render::Cell> cells;
  for (Shot& shot : shots) {
    if (shot.cell.image.width == 0) continue;
    shot.cell.caption = caption_of(audit, shot);
    cells.push_back(std::move(shot.cell));
  }
  if (cells.empty()) cells.push_back({render::Image(kWidth_px, kHeight_px), "nothing moves by itself"});
  const std::string name = pack::string_at(pack.view, pack.view.character->name);
  render::write_png(path,
                    render::contact_sheet(cells, std::min<int>(kColumns, static_cast<int>(cells.size())),
                                          name + ": worst moments; red is stretched beyond the bound"));
}

}  // namespace sinew::baker
