// bullet_contacts.cpp  see include/sinew/bullet.hpp.
#include <algorithm>
#include <atomic>
#include <new>
#include <utility>

#include "adapters/bullet/impulses.hpp"
#include "adapters/bullet/probe_contacts.hpp"
#include "core/status.hpp"

namespace sinew {
namespace {

using namespace bullet;
using rods::Vector;

constexpr size_t kAtOnce = 16;       // probes that share a question to the broadphase
constexpr double kSamePoint = 0.05;  // of the radius

Status bad(const char* name, double value, const char* range) {
  return core::make_status(StatusCode::kInvalidArgument, "BulletDef::%s is %g; give %s", name, value, range);
}

Status check_origin(const double (&origin_m)[3]) {
  for (const double x : origin_m) {
    if (!std::isfinite(x)) {
      return core::make_status(StatusCode::kNotFinite, "origin_m has %g; give finite numbers", x);
    }
  }
  return {};
}

Status check(const BulletDef& def) {
  if (!def.world) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "BulletDef::world is null; give the engine's world");
  }
  if (!(def.friction >= 0 && std::isfinite(def.friction))) {
    return bad("friction", static_cast<double>(def.friction), "a finite number, 0 or more");
  }
  if (!(def.restitution >= 0 && def.restitution <= 1)) {
    return bad("restitution", static_cast<double>(def.restitution), "0 to 1");
  }
  if (!(def.fastest_body_m_s >= 0 && std::isfinite(def.fastest_body_m_s))) {
    return bad("fastest_body_m_s", static_cast<double>(def.fastest_body_m_s), "a finite number, 0 or more");
  }
  if (def.push_capacity > 65536) return bad("push_capacity", def.push_capacity, "at most 65536");
  return check_origin(def.origin_m);
}

Path path_of(const ContactProbe& probe, const double (&origin_m)[3]) {
  Path out = {};
  for (size_t e = 0; e < 2; ++e) {
    for (size_t k = 0; k < 3; ++k) {
      out.start[e][k] = probe.start_m[e][k] - origin_m[k];
      out.end[e][k] = probe.end_m[e][k] - origin_m[k];
    }
  }
  out.radius_m = static_cast<double>(probe.radius_m);
  return out;
}

bool is_good(const Path& path) {
  return path.radius_m >= 0 && std::isfinite(path.radius_m) && rods::finite(path.start[0]) &&
         rods::finite(path.start[1]) && rods::finite(path.end[0]) && rods::finite(path.end[1]);
}

bool goes_on(const Path& path, const Path& before) {
  const double enough = kSamePoint * path.radius_m;
  return is_good(before) && path.radius_m <= before.radius_m &&
         rods::length(rods::difference(path.start[0], before.start[1])) <= enough &&
         rods::length(rods::difference(path.start[0], path.start[1])) > enough;
}

// The first hits.size() of all, then the deepest of them.
struct Hits {
  std::span<ContactHit> to;
  uint32_t count = 0;

  static bool shallower(const ContactHit& a, const ContactHit& b) { return a.gap_m < b.gap_m; }
  void add(const ContactHit& hit) {
    if (count < to.size()) {
      to[count] = hit;
      if (++count == to.size()) std::make_heap(to.begin(), to.end(), shallower);
      return;
    }
    ++count;
    if (to.empty() || !shallower(hit, to[0])) return;
    std::pop_heap(to.begin(), to.end(), shallower);
    to.back() = hit;
    std::push_heap(to.begin(), to.end(), shallower);
  }
};

// What was told at the end of a probe, for the one that goes on there.
class EndOfProbe {
 public:
  void set(uint32_t probe, const ProbeContacts& contacts) {
    probe_ = probe, count_ = 0;
    for (uint32_t i = 0; i < contacts.size(); ++i) {
      if (contacts[i].along == 1) told_[count_++] = {contacts.body(i), contacts[i].gap_m};
    }
  }
  // As deep, of the same body: at a joint one contact is enough, two would share its force.
  bool tells(uint32_t probe, uint32_t body, double gap_m, double slack_m) const {
    return probe_ == probe && std::any_of(told_, told_ + count_, [&](const Told& told) {
             return told.body == body && told.gap_m <= gap_m + slack_m;
           });
  }

 private:
  struct Told {
    uint32_t body;
    double gap_m;
  };
  uint32_t probe_ = ~0u, count_ = 0;
  Told told_[ProbeContacts::kMost];
};

}  // namespace

struct BulletContacts::State {
  BulletDef def;
  Problems problems;
  Impulses impulses;
  std::atomic<uint32_t> looked_at = 0, lost = NearBodies::kNone;  // of the world's bodies

  bool is_tree_spoilt(const NearBodies& near, uint32_t turn) noexcept;
  void find(const NearBodies& near, std::span<const ContactProbe> all, size_t begin, EndOfProbe* before,
            Hits* hits) noexcept;
  void find(std::span<const ContactProbe> all, size_t index, const Path& path, std::span<const Body> bodies,
            double dt_s, EndOfProbe* before, Hits* hits) noexcept;
};

BulletContacts::~BulletContacts() { delete state_; }
BulletContacts::BulletContacts(BulletContacts&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)) {}
BulletContacts& BulletContacts::operator=(BulletContacts&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status BulletContacts::create(const BulletDef& def, BulletContacts* out) noexcept {
  const Status status = check(def);
  if (!status.ok()) return status;
  BulletContacts made;
  made.state_ = new (std::nothrow) State{def, {}, {}};
  if (!made.state_ || !made.state_->impulses.reserve(def.push_capacity)) {
    return core::make_status(StatusCode::kOutOfCapacity,
                             "no memory for the contact forces on %u bodies; give a smaller push_capacity",
                             def.push_capacity);
  }
  *out = std::move(made);
  return {};
}

Status BulletContacts::set_origin(const double (&origin_m)[3]) noexcept {
  const Status status = check_origin(origin_m);
  if (status.ok() && state_) std::copy_n(origin_m, 3, state_->def.origin_m);
  return status;
}

void BulletContacts::State::find(std::span<const ContactProbe> all, size_t index, const Path& path,
                                 std::span<const Body> bodies, double dt_s, EndOfProbe* before,
                                 Hits* hits) noexcept {
  const ContactProbe& probe = all[index];
  ProbeContacts contacts(path, dt_s, problems);
  for (const Body& body : bodies) {
    const double closing_m = path.closing_m(body.motion);
    if (!body.box.overlaps(box_of(path, path.radius_m + 0.25 * closing_m))) continue;
    if (def.accepts && !def.accepts(def.context, probe.owner, *body.object)) continue;
    contacts.add(body, closing_m);
  }
  contacts.reduce();
  const bool joined = index > 0 && all[index - 1].owner == probe.owner &&
                      goes_on(path, path_of(all[index - 1], def.origin_m));
  const auto number = static_cast<uint32_t>(index);
  const double slack_m = kSamePoint * path.radius_m;
  for (uint32_t i = 0; i < contacts.size(); ++i) {
    ContactHit hit = contacts[i];
    if (joined && hit.along == -1 && before->tells(number - 1, contacts.body(i), hit.gap_m, slack_m))
      continue;
    hit.probe = number;
    hits->add(hit);
  }
  before->set(number, contacts);
}

// Of up to kAtOnce probes from `begin` on.
void BulletContacts::State::find(const NearBodies& near, std::span<const ContactProbe> all, size_t begin,
                                 EndOfProbe* before, Hits* hits) noexcept {
  const size_t count = std::min(kAtOnce, all.size() - begin);
  Path paths[kAtOnce];
  bool any = false;
  Box box = {};
  for (size_t i = 0; i < count; ++i) {
    paths[i] = path_of(all[begin + i], def.origin_m);
    if (!is_good(paths[i])) continue;
    const Motion still = {};
    const Path& path = paths[i];
    const double way = path.closing_m(still) + static_cast<double>(def.fastest_body_m_s) * near.dt_s;
    const Box own = box_of(path, path.radius_m + 0.25 * way);
    if (!any) box = own;
    box.widen(own.low), box.widen(own.high);
    any = true;
  }
  if (!any) return;
  Body bodies[kMostBodies];
  const uint32_t found = near.find(box, bodies);
  for (size_t i = 0; i < count && found > 0; ++i) {
    if (is_good(paths[i])) find(all, begin + i, paths[i], {bodies, found}, near.dt_s, before, hits);
  }
}

// Where the one that is known was, another may be once bodies went: then all are looked at, once.
bool BulletContacts::State::is_tree_spoilt(const NearBodies& near, uint32_t turn) noexcept {
  const uint32_t known = lost.load(std::memory_order_relaxed);
  if (near.is_lost(known)) return true;
  const bool was_known = known != NearBodies::kNone;
  const uint32_t found = near.find_lost(turn, was_known ? NearBodies::kAll : NearBodies::kLookedAt);
  const bool is_found = found != NearBodies::kNone;
  // What another thread found meanwhile stays.
  if (is_found || was_known) lost.store(found, std::memory_order_relaxed);
  return is_found;
}

uint32_t BulletContacts::find(std::span<const ContactProbe> probes, float dt_s,
                              std::span<ContactHit> hits) noexcept {
  if (!state_ || !(dt_s > 0 && std::isfinite(dt_s))) return 0;
  const uint32_t turn = state_->looked_at.fetch_add(NearBodies::kLookedAt, std::memory_order_relaxed);
  NearBodies near = {state_->def, static_cast<double>(dt_s), state_->problems};
  near.is_tree_spoilt = state_->is_tree_spoilt(near, turn);
  Hits out = {hits};
  EndOfProbe before;
  for (size_t i = 0; i < probes.size(); i += kAtOnce) state_->find(near, probes, i, &before, &out);
  return out.count;
}

void BulletContacts::push(const ContactHit& hit, const double (&point_m)[3],
                          const float (&impulse_n_s)[3]) noexcept {
  if (!state_) return;
  Vector point;
  for (size_t k = 0; k < 3; ++k) point[k] = point_m[k] - state_->def.origin_m[k];
  state_->impulses.add(hit.body, point, rods::vector_of(impulse_n_s));
}

uint32_t BulletContacts::apply_impulses() noexcept {
  return state_ ? state_->impulses.apply(state_->def.world) : 0;
}

BulletReport BulletContacts::report() const noexcept {
  if (!state_) return {};
  BulletReport out = state_->problems.report();
  out.pushes_dropped = state_->impulses.dropped();
  return out;
}

Status BulletContacts::problem(uint32_t index) const noexcept {
  return state_ ? state_->problems.line(index) : Status{};
}

}  // namespace sinew
