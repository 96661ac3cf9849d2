// problems.cpp  see problems.hpp.
#include "adapters/bullet/problems.hpp"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <cstdio>

#include "core/status.hpp"

namespace sinew::bullet {
namespace {

struct Words {
  StatusCode code;
  const char *what, *mend;
};
constexpr Words kWords[] = {
    {StatusCode::kInvalidArgument, "has no volume", "give its shape a size above 0"},
    {StatusCode::kNotFinite, "has a transform, velocity, friction or restitution that is not finite",
     "set them again"},
    {StatusCode::kInvalidArgument, "has a triangle without area", "take it out of the mesh"},
    {StatusCode::kUnsupported, "is of a kind that is not known here",
     "give it a convex shape, a triangle mesh, a heightfield or a compound of these"},
    {StatusCode::kInvalidArgument, "is faster than BulletDef::fastest_body_m_s", "give that a larger value"},
    {StatusCode::kOutOfCapacity, "is one of more than 64 near the same position", "make a compound of them"}};

// Problem, shape and the body's place in the world's list, above 0.
uint64_t packed(BulletProblem problem, int body, int shape) {
  return uint64_t{1} << 63 | uint64_t{static_cast<uint32_t>(problem)} << 48 |
         uint64_t{static_cast<uint16_t>(shape)} << 32 | static_cast<uint32_t>(body);
}

}  // namespace

void Problems::note(BulletProblem problem, const btCollisionObject& body, int shape_type) noexcept {
  counts_[static_cast<uint32_t>(problem)].fetch_add(1, std::memory_order_relaxed);
  const uint64_t name = packed(problem, body.getWorldArrayIndex(), shape_type);
  for (std::atomic<uint64_t>& known : named_) {
    uint64_t there = 0;
    if (known.compare_exchange_strong(there, name, std::memory_order_relaxed) || there == name) return;
  }
}

BulletReport Problems::report() const noexcept {
  BulletReport out;
  for (size_t i = 0; i < std::size(counts_); ++i) out.counts[i] = counts_[i].load(std::memory_order_relaxed);
  while (out.named < kNamed && named_[out.named].load(std::memory_order_relaxed) != 0) ++out.named;
  return out;
}

Status Problems::line(uint32_t index) const noexcept {
  const uint64_t name = index < kNamed ? named_[index].load(std::memory_order_relaxed) : 0;
  if (name == 0) return {};
  const Words& words = kWords[name >> 48 & 0x7fff];
  return core::make_status(words.code, "body %d of the Bullet world (shape type %u) %s; %s",
                           static_cast<int>(static_cast<uint32_t>(name)),
                           static_cast<unsigned>(name >> 32 & 0xffff), words.what, words.mend);
}

}  // namespace sinew::bullet
