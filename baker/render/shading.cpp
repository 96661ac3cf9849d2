// shading.cpp  see shading.hpp.
#include "baker/render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::render {

struct Shading::Surface {
  Eigen::Vector3f normal;  // smooth, unit, towards the viewer
  Eigen::Vector3f start;   // where shadow rays begin
  Rgb albedo;
};

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Eigen::Vector3f mix(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float t) { return a + t * (b - a); }

float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

// GGX with Schlick's Fresnel and a Smith-like visibility term, for a dielectric.
float highlight(const Eigen::Vector3f& n, const Eigen::Vector3f& view, const Eigen::Vector3f& light) {
  constexpr float kRoughness2 = 0.14f * 0.14f, kReflectance = 0.04f;
  const Eigen::Vector3f half = (view + light).normalized();
  const float nh = std::max(0.0f, n.dot(half)), nl = std::max(0.0f, n.dot(light));
  const float bell = nh * nh * (kRoughness2 - 1) + 1;
  const float fresnel =
      kReflectance + (1 - kReflectance) * std::pow(1 - std::max(0.0f, view.dot(half)), 5.0f);
  const float visibility = 0.25f / std::max(0.1f, half.dot(light) * half.dot(light));
  return nl * fresnel * visibility * kRoughness2 / (3.1415927f * bell * bell);
}

// Dark parts of a creature are its eyes and nose: wet. The rest shines a little.
float wetness(const Rgb& albedo) { return 1 + 3 * (1 - smooth_step(0.02f, 0.12f, albedo.maxCoeff())); }

// Coverage of grid lines by a pixel's footprint along one axis.
float line_coverage(float coordinate, float spacing, float half_width, float footprint) {
  const float nearest = std::abs(coordinate - spacing * std::round(coordinate / spacing));
  const float blur = std::max(footprint, 1e-6f);
  const float width = std::max(half_width, 0.5f * blur);
  return (half_width / width) * (1 - smooth_step(width - 0.5f * blur, width + 0.5f * blur, nearest));
}

}  // namespace

Shading::Shading(const Mesh& mesh, const Scene& scene, const Camera& camera, const RenderOptions& options)
    : mesh_(mesh),
      scene_(scene),
      options_(options),
      key_basis_(options.studio.key_direction),
      eye_(camera.eye) {
  const Eigen::AlignedBox3f box = bounding_box(mesh.positions);
  if (!box.isEmpty()) size_m_ = std::max(1e-6f, box.diagonal().norm());
  offset_m_ = 1e-4f * size_m_;
  center_ = camera.target;
  pixel_rad_ = camera.vertical_fov_deg * 0.017453293f / static_cast<float>(options.height);
}

// The start lies on the smooth surface that the normals describe, not in the flat triangle, so that large
// triangles cast no hard shadows on themselves: J. Hanika, Hacking the shadow terminator, Ray Tracing Gems
// II, 2021.
Shading::Surface Shading::surface_at(const Hit& hit, const Eigen::Vector3f& view) const {
  const auto& corners = mesh_.triangles[hit.triangle];
  const float weight[3] = {1 - hit.u - hit.v, hit.u, hit.v};
  Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero(),
                  lift = Eigen::Vector3f::Zero();
  Rgb albedo = Rgb::Zero();
  for (size_t i = 0; i < 3; ++i) {
    point += weight[i] * mesh_.positions[corners[i]];
    normal += weight[i] * mesh_.normals[corners[i]];
    albedo += weight[i] * mesh_.colors[corners[i]];
  }
  for (size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f& n = mesh_.normals[corners[i]];
    lift -= weight[i] * std::min(0.0f, (point - mesh_.positions[corners[i]]).dot(n)) * n;
  }
  normal.normalize();
  const Eigen::Vector3f edge = mesh_.positions[corners[1]] - mesh_.positions[corners[0]];
  const Eigen::Vector3f flat = edge.cross(mesh_.positions[corners[2]] - mesh_.positions[corners[0]]);
  if (flat.dot(view) < 0) normal = -normal, lift = -lift;  // the back of an open sheet
  // Large triangles at an outline: the smooth surface has turned away where the flat one has not.
  const float turned_away = 0.02f - normal.dot(view);
  if (turned_away > 0) normal = (normal + turned_away * view).normalized();
  return {normal, point + lift + offset_m_ * normal, albedo};
}

Eigen::Vector3f Shading::key_sample(const Eigen::Vector2f& sample) const {
  const Eigen::Vector2f d = std::tan(options_.studio.key_half_angle_rad) * disk_point(sample);
  return (options_.studio.key_direction + d.x() * key_basis_.tangent + d.y() * key_basis_.bitangent)
      .normalized();
}

Rgb Shading::body(const Surface& surface, const Eigen::Vector3f& view, const PathSamples& samples) const {
  const Studio& studio = options_.studio;
  const Eigen::Vector3f& n = surface.normal;
  Rgb diffuse = Rgb::Zero(), shine = Rgb::Zero();
  {  // key
    const Eigen::Vector3f light = key_sample(samples.key);
    const float facing = n.dot(light);
    if (facing > 0 && !scene_.occluded(surface.start, light, 0)) {
      diffuse += facing * studio.key;
      shine += wetness(surface.albedo) * 2 * highlight(n, view, light) * studio.key;
    }
  }
  const Eigen::Vector3f out = cosine_direction(n, samples.sky);
  const bool open = !scene_.occluded(surface.start, out, 0);
  // What blocks the sky is mostly the character itself: it throws some of its own colour back.
  diffuse += open ? studio.sky(out) : Rgb(0.30f * surface.albedo.cwiseProduct(studio.sky_horizon));
  {  // rim and sheen
    const float grazing = std::pow(1 - std::clamp(n.dot(view), 0.0f, 1.0f), 3.0f);
    const float open_share = open ? 1.0f : 0.15f;
    shine += open_share * grazing * std::max(0.0f, n.dot(studio.rim_direction) + 0.2f) * studio.rim;
    shine += open_share * 0.10f * grazing * studio.sky(2 * n.dot(view) * n - view);
  }
  return surface.albedo.cwiseProduct(diffuse) + options_.gloss * shine;
}

// The floor is painted as it should look in full light, then darkened by the share of light that the
// character takes away.
Rgb Shading::floor(const Eigen::Vector3f& point, const Eigen::Vector3f& view,
                   const PathSamples& samples) const {
  const Studio& studio = options_.studio;
  const Eigen::Vector3f start = point + offset_m_ * Eigen::Vector3f::UnitY();
  const Eigen::Vector3f light = key_sample(samples.key);
  const Eigen::Vector3f out = cosine_direction(Eigen::Vector3f::UnitY(), samples.sky);
  const Rgb key = light.y() * studio.key, sky = studio.sky(out);
  const Rgb full = studio.key_direction.y() * studio.key + studio.sky(Eigen::Vector3f(0, 0.67f, 0.74f));
  Rgb lit = Rgb::Zero();
  if (!scene_.occluded(start, light, 0)) lit += key;
  if (!scene_.occluded(start, out, 0)) lit += sky;
  const float far = smooth_step(1.2f, 4.5f, (point - center_).norm() / size_m_);
  const Rgb share = lit.cwiseQuotient(full);
  return floor_color(point, std::abs(view.y())).cwiseProduct(mix(share, Rgb::Ones(), far));
}

Rgb Shading::floor_color(const Eigen::Vector3f& point, float slope) const {
  const Studio& studio = options_.studio;
  const float far =
      smooth_step(0.3f, 3.2f, std::hypot(point.x() - center_.x(), point.z() - center_.z()) / size_m_);
  Rgb color = studio.floor;
  if (options_.grid_m > 0) {
    const float footprint = pixel_rad_ * (point - eye_).norm();
    const float half_width = 0.012f * options_.grid_m;
    const float lines =
        std::max(line_coverage(point.x(), options_.grid_m, half_width, footprint),
                 line_coverage(point.z(), options_.grid_m, half_width, footprint / std::max(slope, 0.02f)));
    color = mix(color, studio.floor_line, lines * (1 - far));
  }
  return mix(color, studio.backdrop, far);
}

Rgb Shading::backdrop(const Eigen::Vector3f& direction) const {
  const Studio& studio = options_.studio;
  return mix(studio.backdrop, studio.backdrop_top, smooth_step(0.0f, 0.45f, direction.y()));
}

Rgb Shading::along(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                   const PathSamples& samples) const {
  const float below = (options_.floor_y - origin.y()) / direction.y();
  const float to_floor = below > 0 ? below : kInfinity;
  if (const std::optional<Hit> hit = scene_.closest(origin, direction, to_floor)) {
    return body(surface_at(*hit, -direction), -direction, samples);
  }
  if (to_floor < kInfinity) return floor(origin + to_floor * direction, -direction, samples);
  return backdrop(direction);
}

}  // namespace sinew::render
