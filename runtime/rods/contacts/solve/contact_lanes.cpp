// contact_lanes.cpp  Brings contacts into lanes and back.
#include "rods/contacts/solve/contact_lanes.hpp"

#include "kernels/kernels.hpp"

namespace sinew::rods {
namespace {

using Rows = double (*)[simd::kForceLanes];

void put3(Rows rows, size_t lane, const Vector& v) {
  for (size_t k = 0; k < 3; ++k) rows[k][lane] = v[k];
}
Vector get3(Rows rows, size_t lane) { return {rows[0][lane], rows[1][lane], rows[2][lane]}; }

static_assert(simd::kFrictionSticks == static_cast<uint32_t>(Friction::kSticks));
static_assert(simd::kFrictionSlides == static_cast<uint32_t>(Friction::kSlides));
static_assert(simd::kFrictionEither == static_cast<uint32_t>(Friction::kEither));
static_assert(simd::RodPushes::kOut == simd::kRodContactRows);
static_assert(simd::kRodNow == simd::kRodMove + 3 && simd::kLookNow == simd::kLookMove + 3);

}  // namespace

void ContactLooks::add(Contact* contact) {
  if (contact->has_two_rods()) return forces_.look(contact);
  put(*contact);
  of_[count_++] = contact;
  if (count_ == simd::kForceLanes) end();
}

void ContactLooks::put(const Contact& c) {
  const Contact::Side& s = c.sides[0];
  const auto put_one = [&](size_t r, double value) { lanes_.rows[r][count_] = value; };
  put3(lanes_.rows + simd::kLookNormal, count_, c.normal);
  put3(lanes_.rows + simd::kLookAxis, count_, s.axis);
  put3(lanes_.rows + simd::kLookObstacle, count_, c.obstacle_move);
  put_one(simd::kLookGap, c.gap_m);
  put_one(simd::kLookAllowed, c.allowed_m);
  put_one(simd::kLookLetsGo, kLetsGo * c.gain_kg);
  put_one(simd::kLookForce, c.force);
  put_one(simd::kLookOpenBefore, c.open_before_m);
  put_one(simd::kLookAlong, s.along_m);
  put_one(simd::kLookRadius, s.radius_m);
  const RodBatch& batch = forces_.batch;
  put_one(simd::kLookLength, static_cast<double>(batch.units_[s.strand].length_m));
  const float* now = forces_.to.scratch_row(batch, s.strand, s.segment, simd::kRodMove);
  const float* before = &batch.at(s.strand, s.segment, simd::kRodTurn);
  for (size_t k = 0; k < 7; ++k) lanes_.floats[simd::kLookMove + k][count_] = now[k * batch.width_];
  for (size_t k = 0; k < 4; ++k) lanes_.floats[simd::kLookTurn + k][count_] = before[k * batch.width_];
}

void ContactLooks::end() {
  if (count_ == 0) return;
  simd::kernels().rod_forces->look(&lanes_, count_);
  for (size_t k = 0; k < count_; ++k) {
    of_[k]->open_m = lanes_.rows[simd::kLookOpen][k];
    of_[k]->slip_m = get3(lanes_.rows + simd::kLookSlip, k);
    ContactForces::let_go_of_lost(of_[k]);
  }
  count_ = 0;
}

// What was not part of the last system begins anew.
void ContactTakes::add(Contact* contact) {
  if (contact->has_two_rods()) {
    end();
    return forces_.keep_pending(*contact, forces_.take_over(contact));
  }
  if (!is_active(*contact, contact->open_before_m)) {
    return forces_.keep_pending(*contact, forces_.begin_anew(contact));
  }
  put(*contact);
  of_[count_++] = contact;
  if (count_ == simd::kForceLanes) end();
}

void ContactTakes::put(const Contact& c) {
  const auto put_one = [&](size_t r, double value) { lanes_.rows[r][count_] = value; };
  put_one(simd::kTakeGain, c.gain_kg);
  put_one(simd::kTakeFriction, c.friction);
  put_one(simd::kTakeShare, forces_.share_of(c));
  put_one(simd::kTakeTolerance, forces_.tolerance_m(c));
  put_one(simd::kTakeNothing, forces_.nothing_m(c));
  put_one(simd::kTakeRounding, forces_.rounding_kg_m(c));
  put_one(simd::kTakeOpen, c.open_m);
  put_one(simd::kTakeOpenBefore, c.open_before_m);
  put3(lanes_.rows + simd::kTakeSlip, count_, c.slip_m);
  put3(lanes_.rows + simd::kTakeSlipBefore, count_, c.slip_before_m);
  put_one(simd::kTakeForce, c.force);
  put_one(simd::kTakeLimit, c.limit);
  put3(lanes_.rows + simd::kTakeDrag, count_, c.drag);
  put_one(simd::kTakeState, static_cast<uint32_t>(c.state));
  put_one(simd::kTakeChanges, c.changes);
}

void ContactTakes::get(size_t lane) {
  Contact& c = *of_[lane];
  const auto row = [&](size_t r) { return lanes_.rows[r][lane]; };
  c.force = row(simd::kTakeForce);
  c.limit = row(simd::kTakeLimit);
  c.drag = get3(lanes_.rows + simd::kTakeDrag, lane);
  c.state = static_cast<Friction>(static_cast<uint32_t>(row(simd::kTakeState)));
  c.changes = static_cast<uint32_t>(row(simd::kTakeChanges));
  forces_.add_miss(c, row(simd::kTakeMiss));
  forces_.keep_pending(c, row(simd::kTakeExact) != 0);
}

void ContactTakes::end() {
  if (count_ == 0) return;
  simd::kernels().rod_forces->take(&lanes_, count_);
  for (size_t k = 0; k < count_; ++k) get(k);
  count_ = 0;
}

void ContactPushes::add(const Contact& contact) {
  if (contact.has_two_rods()) {
    end();
    return forces_.add(contact);
  }
  const Contact::Side& s = contact.sides[0];
  if (!forces_.goes_on(s.strand) || !is_active(contact, contact.open_m)) return;
  if (!(s.stiffness_kg > 0)) return;
  forces_.lane(s.strand, simd::kLaneLargestShare) = 1;
  put(contact);
  of_[count_++] = &contact;
  if (count_ == simd::kForceLanes) end();
}

void ContactPushes::put(const Contact& c) {
  const Contact::Side& s = c.sides[0];
  const auto put_one = [&](size_t r, double value) { lanes_.rows[r][count_] = value; };
  put_one(simd::kPushGain, c.gain_kg);
  put_one(simd::kPushFriction, c.friction);
  put_one(simd::kPushForce, c.force);
  put_one(simd::kPushLimit, c.limit);
  put3(lanes_.rows + simd::kPushDrag, count_, c.drag);
  put_one(simd::kPushState, static_cast<uint32_t>(c.state));
  put_one(simd::kPushOpen, c.open_m);
  put3(lanes_.rows + simd::kPushSlip, count_, c.slip_m);
  put3(lanes_.rows + simd::kPushNormal, count_, c.normal);
  put_one(simd::kPushAlong, s.along_m);
  put_one(simd::kPushRadius, s.radius_m);
  put_one(simd::kPushStiffness, s.stiffness_kg);
  const RodBatch& batch = forces_.batch;
  const RodBatch::Units& units = batch.units_[s.strand];
  put_one(simd::kPushLength, static_cast<double>(units.length_m));
  put_one(simd::kPushMass, static_cast<double>(units.mass_kg));
  const float* now = forces_.to.scratch_row(batch, s.strand, s.segment, simd::kRodNow);
  for (size_t k = 0; k < 4; ++k) lanes_.now[k][count_] = now[k * batch.width_];
}

void ContactPushes::get(size_t lane) {
  const Contact::Side& s = of_[lane]->sides[0];
  float* rows = forces_.touched_rows(s.strand, s.segment);
  for (size_t r = 0; r < simd::kRodContactRows; ++r) rows[r * forces_.batch.width_] += lanes_.out[r][lane];
}

void ContactPushes::end() {
  if (count_ == 0) return;
  simd::kernels().rod_forces->push(&lanes_, count_);
  for (size_t k = 0; k < count_; ++k) get(k);
  count_ = 0;
}

}  // namespace sinew::rods
