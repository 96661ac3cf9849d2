// part_picture.cpp  see part_picture.hpp.
#include "baker/preview/part_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "baker/preview/facing.hpp"
#include "baker/preview/pack_mesh.hpp"
#include "baker/preview/write_preview.hpp"
#include "baker/render/picture/layout.hpp"
#include "baker/render/picture/lines.hpp"
#include "baker/render/picture/text.hpp"
#include "baker/render/renderer.hpp"

namespace sinew::baker {
namespace {

using render::Image;
using render::RgbBytes;

// Neighbours in the list differ most; beyond the last it begins again.
constexpr std::array<RgbBytes, 10> kPartColors{{{222, 60, 50},
                                                {30, 118, 214},
                                                {240, 160, 20},
                                                {40, 160, 80},
                                                {150, 70, 200},
                                                {0, 170, 180},
                                                {226, 80, 160},
                                                {128, 92, 40},
                                                {120, 180, 20},
                                                {70, 80, 150}}};

RgbBytes color_of(size_t part) { return kPartColors[part % kPartColors.size()]; }

// A little of the base colour is left, so that the surface can be read.
void paint(const Part& part, RgbBytes color, render::Mesh& mesh) {
  constexpr float kStrength = 0.8f;
  const render::Rgb linear = render::linear_from_srgb(color);
  for (size_t i = 0; i < part.vertices.size(); ++i) {
    render::Rgb& here = mesh.colors[part.vertices[i]];
    here += kStrength * part.share[i] * (linear - here);
  }
}

void draw_bones(Image& image, const Part& part, RgbBytes color, const render::Camera& camera) {
  constexpr float kWidth_px = 3.4f, kRim_px = 2.6f, kJoint_px = 6.5f;
  const render::Rays rays(camera, static_cast<float>(image.width) / static_cast<float>(image.height));
  const auto pixel = [&](const Eigen::Vector3f& p) { return rays.pixel(p, image.width, image.height); };
  for (const auto& [ink, rim] : {std::pair{render::kPaper, kRim_px}, std::pair{color, 0.0f}}) {
    for (const auto& [begin, end] : part.bones) {
      const Eigen::Vector2f line[2] = {pixel(begin), pixel(end)}, joint[2] = {line[1], line[1]};
      render::draw_polyline(image, line, kWidth_px + rim, ink);
      render::draw_polyline(image, joint, kJoint_px + rim, ink);
    }
  }
}

// Parts are to be told apart from a body of any colour.
void fade(render::Mesh& mesh) {
  constexpr float kGrey = 0.6f;
  const render::Rgb luminance(0.2126f, 0.7152f, 0.0722f);  // Rec. 709
  for (render::Rgb& color : mesh.colors)
    color += kGrey * (render::Rgb::Constant(color.dot(luminance)) - color);
}

struct ViewSide {
  const char* name;
  float yaw_deg;
  int width_px;
  render::Camera camera;
};

float aspect_of(int width, int height) { return static_cast<float>(width) / static_cast<float>(height); }

// Front and side share the width by what they show, at one scale.
std::array<ViewSide, 2> sides_of(const render::Mesh& mesh, float front_deg, const PartPicture& picture) {
  constexpr float kNarrowest = 0.3f, kRadians = 0.017453293f;
  std::array<ViewSide, 2> sides{{{"front", front_deg, 0, {}}, {"side", front_deg + 90, 0, {}}}};
  float extent[2], farthest = 0;
  for (size_t i = 0; i < 2; ++i) {
    const float yaw = sides[i].yaw_deg * kRadians;
    const Eigen::Vector3f right(std::cos(yaw), 0, -std::sin(yaw));
    float low = 0, high = 0;
    for (const Eigen::Vector3f& p : mesh.positions)
      low = std::min(low, p.dot(right)), high = std::max(high, p.dot(right));
    extent[i] = high - low + 1e-6f;
  }
  const float share = std::clamp(extent[0] / (extent[0] + extent[1]), kNarrowest, 1 - kNarrowest);
  sides[0].width_px = static_cast<int>(share * static_cast<float>(picture.width));
  sides[1].width_px = picture.width - sides[0].width_px;
  for (ViewSide& side : sides) {
    side.camera = render::camera_around(
        mesh.positions, aspect_of(side.width_px, picture.height),
        {.yaw_deg = side.yaw_deg, .pitch_deg = 6, .margin = 1.18f, .vertical_fov_deg = 14});
    farthest = std::max(farthest, (side.camera.eye - side.camera.target).norm());
  }
  for (ViewSide& side : sides)
    side.camera.eye = side.camera.target + farthest * (side.camera.eye - side.camera.target).normalized();
  return sides;
}

Image view_from(const ViewSide& side, const render::Mesh& mesh, const std::vector<Part>& parts,
                const PartPicture& picture) {
  const Eigen::AlignedBox3f box = render::bounding_box(mesh.positions);
  render::RenderOptions options;
  options.width = side.width_px;
  options.height = picture.height;
  options.samples = picture.samples;
  options.floor_y = box.min().y();
  options.grid_m = render::grid_for_height(box.sizes().y());
  options.gloss = 0.3f;
  options.studio = render::Studio::facing(side.yaw_deg);
  Image image = render::render(mesh, side.camera, options);
  for (size_t p = 0; p < parts.size(); ++p) draw_bones(image, parts[p], color_of(p), side.camera);
  return image;
}

constexpr float kLetter_px = 12, kRow_px = 25, kMargin_px = 18, kSwatch_px = 16;

std::string kind_of(const Part& part) {
  char hz[24] = "";
  if (part.frequency_hz > 0) std::snprintf(hz, sizeof hz, ", %.3g Hz", part.frequency_hz);
  const std::string bones = std::to_string(part.bones.size()) + (part.bones.size() == 1 ? " bone" : " bones");
  return (part.is_rod ? "rod, " + bones : "soft") + hz;
}

Image legend(const std::vector<Part>& parts, const char* title, int height) {
  constexpr float kWidestName_px = 300, kKind_px = 190, kTop_px = 60;
  const render::TextStyle bold{.size_px = kLetter_px, .weight = 1.4f},
      pale{.size_px = kLetter_px, .color = render::kPaleInk};
  float name_px = 60;
  for (const Part& part : parts)
    name_px = std::max(name_px, std::min(kWidestName_px, render::text_width(part.name, bold)));
  const float name_at = kMargin_px + kSwatch_px + 10, kind_at = name_at + name_px + 14;
  Image image(static_cast<int>(kind_at + kKind_px), height, render::kPaper);
  render::draw_text(image, kMargin_px, 34, title, {.size_px = 14, .weight = 1.4f});
  if (parts.empty())
    render::draw_text(image, kMargin_px, kTop_px + 10, "nothing: no soft part, no rod", pale);
  const auto rows = static_cast<size_t>((static_cast<float>(height) - kTop_px - kMargin_px) / kRow_px);
  const size_t shown = parts.size() <= rows ? parts.size() : rows - 1;
  for (size_t p = 0; p < shown; ++p) {
    const float base = kTop_px + kRow_px * static_cast<float>(p) + kSwatch_px;
    const int top = static_cast<int>(base) - 13;
    const int thick = parts[p].is_rod ? 4 : static_cast<int>(kSwatch_px);
    render::fill_box(image, static_cast<int>(kMargin_px), top + (static_cast<int>(kSwatch_px) - thick) / 2,
                     static_cast<int>(kSwatch_px), thick, color_of(p));
    render::draw_text(image, name_at, base, render::cut_to(parts[p].name, kWidestName_px, bold), bold);
    render::draw_text(image, kind_at, base, kind_of(parts[p]), pale);
  }
  if (shown < parts.size())
    render::draw_text(image, name_at, kTop_px + kRow_px * static_cast<float>(shown) + kSwatch_px,
                      "and " + std::to_string(parts.size() - shown) + " more", pale);
  return image;
}

}  // namespace

Image part_picture(const pack::PackView& character, const PartPicture& picture) {
  std::vector<Part> parts = parts_of(character);
  for (size_t p = 0; p < std::min(parts.size(), picture.captions.size()); ++p)
    parts[p].name = picture.captions[p] + " " + parts[p].name;
  render::Mesh mesh = bind_mesh(character);
  fade(mesh);
  for (size_t p = 0; p < parts.size(); ++p) paint(parts[p], color_of(p), mesh);
  const std::array<ViewSide, 2> sides = sides_of(mesh, facing_yaw_deg(character), picture);
  const std::string name = pack::string_at(character, character.character->name);
  std::vector<render::Panel> panels;
  for (const ViewSide& side : sides)
    panels.push_back({view_from(side, mesh, parts, picture), panels.empty() ? name : "", side.name});
  panels.push_back(
      {legend(parts, picture.captions.empty() ? "Moves by itself" : "May move by itself", picture.height), "",
       ""});
  return render::side_by_side(panels);
}

void write_preview(const std::string& path, const pack::PackView& character,
                   const std::vector<std::string>& captions) {
  render::write_png(path, part_picture(character, {.captions = captions}));
}

}  // namespace sinew::baker
