// occluders.cpp  see occluders.hpp: a tree for each mesh, and one over where they stand.
#include "sinew/occluders.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include "adapters/embree/with_memory.hpp"
#include "character/motion/pose.hpp"
#include "core/slot_table.hpp"
#include "core/status.hpp"

namespace sinew {
namespace {

using core::make_status;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kFarthest_m = 1e6f;
constexpr size_t kMostTriangles = size_t{1} << 26;

Status invalid(const char* line) noexcept { return make_status(StatusCode::kInvalidArgument, "%s", line); }
Status empty() noexcept { return invalid("these Occluders are empty; make them with Occluders::create"); }
Status stale() noexcept {
  return make_status(StatusCode::kStaleId, "the occluder's id is null or was removed");
}

Status check(const OccludersDef& def) noexcept {
  if (def.max_occluders < 1 || def.max_occluders > 65535)
    return invalid("OccludersDef: max_occluders must be 1..65535");
  const bool finite = std::ranges::all_of(def.origin_m, [](double x) { return std::isfinite(x); });
  return finite ? Status{} : make_status(StatusCode::kNotFinite, "OccludersDef: origin_m must be finite");
}

Status check(const OccluderDef& def) noexcept {
  const size_t triangles = def.triangles.size() / 3, vertices = def.places_m.size() / 3;
  if (triangles < 1 || def.triangles.size() % 3 != 0 || triangles > kMostTriangles)
    return make_status(StatusCode::kInvalidArgument,
                       "triangles has %zu indices; give three a triangle, 1 to %zu of them",
                       def.triangles.size(), kMostTriangles);
  if (vertices < 1 || def.places_m.size() % 3 != 0)
    return make_status(StatusCode::kInvalidArgument, "places_m has %zu numbers; give x y z of each vertex",
                       def.places_m.size());
  for (size_t i = 0; i < def.triangles.size(); ++i)
    if (def.triangles[i] >= vertices)
      return make_status(StatusCode::kInvalidArgument,
                         "triangle %zu names vertex %u of %zu; give indices that are there", i / 3,
                         def.triangles[i], vertices);
  for (size_t i = 0; i < def.places_m.size(); ++i)
    if (!(std::fabs(def.places_m[i]) <= kFarthest_m))
      return make_status(StatusCode::kInvalidArgument,
                         "places_m of vertex %zu is %g; give numbers within +-1e6", i / 3,
                         static_cast<double>(def.places_m[i]));
  return {};
}

// Owns an Embree handle.
template <class Handle, void (*release)(Handle)>
class Held {
 public:
  Held() noexcept = default;
  explicit Held(Handle handle) noexcept : handle_(handle) {}
  ~Held() {
    if (handle_) release(handle_);
  }
  Held(Held&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Held& operator=(Held&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  Handle get() const noexcept { return handle_; }
  explicit operator bool() const noexcept { return handle_ != nullptr; }

 private:
  Handle handle_ = nullptr;
};
using Device = Held<RTCDevice, rtcReleaseDevice>;
using Scene = Held<RTCScene, rtcReleaseScene>;
using Geometry = Held<RTCGeometry, rtcReleaseGeometry>;

template <class T>
bool fill(const Geometry& geometry, RTCBufferType type, RTCFormat format, std::span<const T> values) {
  void* room = rtcSetNewGeometryBuffer(geometry.get(), type, 0, format, 3 * sizeof(T), values.size() / 3);
  if (room) std::copy(values.begin(), values.end(), static_cast<T*>(room));
  return room != nullptr;
}

// Embree keeps the first error until it is asked for.
bool has_failed(RTCDevice device) noexcept { return rtcGetDeviceError(device) != RTC_ERROR_NONE; }
// Without a device: of the thread that could not make one.
Status cannot_start(RTCDevice device) noexcept {
  if (rtcGetDeviceError(device) == RTC_ERROR_OUT_OF_MEMORY)
    return make_status(StatusCode::kOutOfCapacity, "no memory for Embree to start with");
  return make_status(StatusCode::kUnsupported, "Embree cannot start on this machine");
}

Scene build(const Device& device, const OccluderDef& def) {
  Scene scene(rtcNewScene(device.get()));
  const Geometry mesh(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  if (!scene || !mesh || !fill(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, def.places_m) ||
      !fill(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, def.triangles))
    return {};
  rtcCommitGeometry(mesh.get());
  rtcAttachGeometry(scene.get(), mesh.get());
  rtcCommitScene(scene.get());
  return has_failed(device.get()) ? Scene() : std::move(scene);
}

struct Occluder {
  Scene mesh;
  Geometry placed;  // the mesh where it stands
  unsigned name = RTC_INVALID_GEOMETRY_ID;
};

}  // namespace

struct Occluders::Impl {
  OccludersDef def;
  Device device;
  Scene scene;
  bool updated = false;  // since the last change
  core::SlotTable<Occluder, OccluderId> occluders;

  Status start() {
    device = Device(rtcNewDevice("threads=1"));
    if (device) scene = Scene(rtcNewScene(device.get()));
    if (!scene) return cannot_start(device.get());
    update();
    if (!updated) return make_status(StatusCode::kOutOfCapacity, "no memory for an empty scene");
    return {};
  }

  Status add(const OccluderDef& occluder, const RootTransform& root, OccluderId* out) {
    (void)has_failed(device.get());  // of an earlier call that answers nothing
    Occluder made{build(device, occluder),
                  Geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE))};
    const bool built = made.mesh && made.placed;
    if (built) {
      rtcSetGeometryInstancedScene(made.placed.get(), made.mesh.get());
      place(made, root);
    }
    if (!has_failed(device.get()) && built) made.name = rtcAttachGeometry(scene.get(), made.placed.get());
    if (has_failed(device.get()) || made.name == RTC_INVALID_GEOMETRY_ID) {
      if (made.name != RTC_INVALID_GEOMETRY_ID) rtcDetachGeometry(scene.get(), made.name);
      return make_status(StatusCode::kOutOfCapacity, "no memory for an occluder's tree");
    }
    updated = false;
    *out = occluders.create(std::move(made));
    return {};
  }

  void update() {
    updated = false;
    (void)has_failed(device.get());  // of an earlier call that answers nothing
    rtcCommitScene(scene.get());
    updated = !has_failed(device.get());
  }

  void place(const Occluder& occluder, const RootTransform& root) noexcept {
    Eigen::Matrix<float, 3, 4> to;  // column-major, as Embree has it
    to.leftCols<3>() = static_cast<float>(root.scale) *
                       Eigen::Map<const Eigen::Quaternionf>(root.rotation_xyzw).toRotationMatrix();
    to.col(3) = (Eigen::Map<const Vector3d>(root.position_m) - Eigen::Map<const Vector3d>(def.origin_m))
                    .cast<float>();
    rtcSetGeometryTransform(occluder.placed.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, to.data());
    rtcCommitGeometry(occluder.placed.get());
  }
};

Occluders::~Occluders() { delete impl_; }
Occluders::Occluders(Occluders&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}
Occluders& Occluders::operator=(Occluders&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

Status Occluders::create(const OccludersDef& def, Occluders* out) noexcept {
  if (!out) return invalid("out is null; give where the occluders go");
  if (Status status = check(def); !status.ok()) return status;
  Occluders made;
  made.impl_ = new (std::nothrow) Impl;
  if (!made.impl_ || !made.impl_->occluders.reserve(def.max_occluders))
    return make_status(StatusCode::kOutOfCapacity, "no memory for %u occluders", def.max_occluders);
  made.impl_->def = def;
  const Status status = embree::with_memory("Embree to start with", [&] { return made.impl_->start(); });
  if (status.ok()) *out = std::move(made);
  return status;
}

Status Occluders::add(const OccluderDef& def, OccluderId* out) noexcept {
  if (!impl_) return empty();
  if (!out) return invalid("out is null; give where the id goes");
  RootTransform root;
  if (Status status = check(def); !status.ok()) return status;
  if (Status status = world::check_root(def.root, &root); !status.ok()) return status;
  if (impl_->occluders.count() == impl_->occluders.capacity())
    return make_status(StatusCode::kOutOfCapacity, "%u occluders are there; raise max_occluders",
                       impl_->occluders.count());
  return embree::with_memory("an occluder's tree", [&] { return impl_->add(def, root, out); });
}

Status Occluders::move(OccluderId id, const RootTransform& given) noexcept {
  if (!impl_) return empty();
  const Occluder* occluder = impl_->occluders.find(id);
  if (!occluder) return stale();
  RootTransform root;
  if (Status status = world::check_root(given, &root); !status.ok()) return status;
  impl_->place(*occluder, root);
  impl_->updated = false;
  return {};
}

Status Occluders::remove(OccluderId id) noexcept {
  if (!impl_) return empty();
  const Occluder* occluder = impl_->occluders.find(id);
  if (!occluder) return stale();
  rtcDetachGeometry(impl_->scene.get(), occluder->name);
  impl_->occluders.destroy(id);
  impl_->updated = false;
  return {};
}

void Occluders::update() noexcept {
  if (!impl_) return;
  (void)embree::with_memory("the tree over all occluders", [&]() -> Status {
    impl_->update();
    return {};
  });
}

bool Occluders::is_blocked(const double (&from_m)[3], const double (&to_m)[3]) noexcept {
  if (!impl_ || !impl_->updated) return false;
  const Vector3d origin = Eigen::Map<const Vector3d>(impl_->def.origin_m);
  const Vector3f from = (Eigen::Map<const Vector3d>(from_m) - origin).cast<float>();
  const Vector3f way = (Eigen::Map<const Vector3d>(to_m) - Eigen::Map<const Vector3d>(from_m)).cast<float>();
  if (!from.allFinite() || !way.allFinite()) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  alignas(16) RTCRay ray{from.x(), from.y(), from.z(), 0, way.x(), way.y(), way.z(), 0, 1, ~0u, 0, 0};
  rtcOccluded1(impl_->scene.get(), &context, &ray);
  return ray.tfar < 0;
}

}  // namespace sinew
