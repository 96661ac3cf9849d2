// crowd_picture.cpp  see crowd_picture.hpp.
#include "samples/demo/crowd_picture.hpp"

#include <algorithm>
#include <cmath>

#include "baker/preview/pack_mesh.hpp"
#include "baker/render/picture/text.hpp"
#include "baker/render/renderer.hpp"

namespace sinew::demo {
namespace {

using render::Rgb;
using render::RgbBytes;

struct TierLook {
  const char* name;
  RgbBytes tint;
  float strength;
  RgbBytes ink;  // of its line in the picture
};

// By Tier. The network's instances keep their own colours; little of these is left in the others', or blue on
// orange would be pink.
constexpr TierLook kLooks[] = {{"skinning", {128, 138, 152}, 0.9f, {96, 104, 118}},
                               {"extrapolated", {236, 190, 60}, 0.8f, {150, 104, 0}},
                               {"network", {0, 0, 0}, 0, {38, 44, 54}},
                               {},  // no tier
                               {"modal", {44, 111, 187}, 0.8f, {24, 84, 150}}};

constexpr TierLook kOutOfView = {"out of view", {214, 218, 224}, 0.97f, {120, 126, 136}};

const TierLook& look_of(const CrowdMember& member) {
  return member.hidden ? kOutOfView : kLooks[static_cast<size_t>(member.tier)];
}

void add_member(const render::Mesh& character, std::span<const uint32_t> welded, const CrowdMember& member,
                render::Mesh& out) {
  const auto first = static_cast<uint32_t>(out.positions.size());
  const auto normals = render::smooth_normals(member.positions, character.triangles, welded);
  out.positions.insert(out.positions.end(), member.positions.begin(), member.positions.end());
  out.normals.insert(out.normals.end(), normals.begin(), normals.end());
  const TierLook& look = look_of(member);
  const Rgb tint = render::linear_from_srgb(look.tint);
  for (const Rgb& color : character.colors) out.colors.push_back(color + look.strength * (tint - color));
  for (const auto& [a, b, c] : character.triangles)
    out.triangles.push_back({first + a, first + b, first + c});
}

void draw_counts(render::Image& image, const Run& run, const Options& options) {
  std::string title = std::to_string(run.instances) + " instances";
  if (std::isfinite(options.budget_us))
    title += ", " + std::to_string(std::lround(options.budget_us)) + " us a frame";
  render::draw_text(image, 18, 34, title, {.size_px = 16, .weight = 1.4f});
  int line = 0;
  constexpr Tier kFromTheBest[] = {Tier::kNetwork, Tier::kModal, Tier::kExtrapolate, Tier::kSkinning};
  std::vector<const TierLook*> looks;
  for (const Tier tier : kFromTheBest) looks.push_back(&look_of({.tier = tier}));
  looks.push_back(&kOutOfView);
  for (const TierLook* look : looks) {
    const auto count = std::ranges::count(run.crowd, look, [](const CrowdMember& m) { return &look_of(m); });
    if (count == 0 && look == &kOutOfView) continue;
    render::draw_text(image, 18, static_cast<float>(60 + 22 * line++),
                      std::to_string(count) + "  " + look->name,
                      {.size_px = 12, .weight = 1.4f, .color = look->ink});
  }
}

}  // namespace

render::Image crowd_picture(const CharacterFile& character, const Run& run, const Options& options) {
  const render::Mesh bind = baker::bind_mesh(character.view);
  const std::vector<uint32_t> welded(character.view.welded.begin(), character.view.welded.end());
  render::Mesh crowd;
  for (const CrowdMember& member : run.crowd) add_member(bind, welded, member, crowd);
  render::RenderOptions look;
  look.width = 3 * options.width;
  look.height = look.width * 9 / 16;
  look.samples = 4 * options.samples;
  look.floor_y = render::bounding_box(bind.positions).min().y();
  look.grid_m = render::grid_for_height(run.asset.height_m);
  constexpr float kYaw_deg = 24;
  look.studio = render::Studio::facing(kYaw_deg);
  const float aspect = static_cast<float>(look.width) / static_cast<float>(look.height);
  render::Image image = render::render(
      crowd, render::camera_around(crowd.positions, aspect, {.yaw_deg = kYaw_deg, .pitch_deg = 20}), look);
  draw_counts(image, run, options);
  return image;
}

}  // namespace sinew::demo
