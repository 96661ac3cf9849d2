// scene.cpp  see scene.hpp.
#include "baker/render/scene.hpp"

#include <embree3/rtcore.h>

#include <cstring>
#include <limits>
#include <stdexcept>

namespace sinew::render {

struct Scene::Impl {
  // One thread builds: the tree, and so every picture, is the same on every run.
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = device != nullptr ? rtcNewScene(device) : nullptr;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

void fill_geometry(RTCGeometry geometry, const Mesh& mesh) {
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), mesh.triangles.size());
  if (vertices == nullptr || indices == nullptr) throw std::runtime_error("Embree is out of memory");
  std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(Eigen::Vector3f));
  std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
  rtcCommitGeometry(geometry);
}

RTCRay make_ray(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                float farthest) {
  RTCRay ray{};
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tnear = nearest;
  ray.tfar = farthest;
  ray.mask = ~0u;
  return ray;
}

}  // namespace

Scene::Scene(const Mesh& mesh) : impl_(std::make_unique<Impl>()) {
  if (impl_->scene == nullptr) throw std::runtime_error("Embree cannot start on this machine");
  if (!mesh.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    fill_geometry(geometry, mesh);
    rtcAttachGeometry(impl_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl_->scene);
}

Scene::~Scene() = default;

std::optional<Hit> Scene::closest(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                  float farthest) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, 0, farthest);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v};
}

bool Scene::occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = make_ray(origin, direction, nearest, std::numeric_limits<float>::infinity());
  rtcOccluded1(impl_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace sinew::render
