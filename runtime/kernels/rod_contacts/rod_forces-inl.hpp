// rod_forces-inl.hpp  Contacts' gaps, forces and rows, a contact a lane, with the bits of one at a time.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using ForceTag = hn::CappedTag<double, kForceLanes>;
using ForceV = hn::Vec<ForceTag>;
using ForceM = hn::Mask<ForceTag>;

HWY_INLINE ForceV force_row(const double (&row)[kForceLanes], size_t first) {
  return hn::Load(ForceTag(), row + first);
}
HWY_INLINE Three<ForceV> force_rows3(const double (*rows)[kForceLanes], size_t first) {
  return {force_row(rows[0], first), force_row(rows[1], first), force_row(rows[2], first)};
}
HWY_INLINE ForceV force_float(const float (&row)[kForceLanes], size_t first) {
  return hn::PromoteTo(ForceTag(), hn::Load(hn::Rebind<float, ForceTag>(), row + first));
}
HWY_INLINE void put_row(double (&row)[kForceLanes], size_t first, ForceV value) {
  hn::Store(value, ForceTag(), row + first);
}
HWY_INLINE void put_rows3(double (*rows)[kForceLanes], size_t first, const Three<ForceV>& v) {
  put_row(rows[0], first, v.x), put_row(rows[1], first, v.y), put_row(rows[2], first, v.z);
}
HWY_INLINE Four<ForceV> force_turn(const float (*rows)[kForceLanes], size_t first) {
  return {force_float(rows[0], first), force_float(rows[1], first), force_float(rows[2], first),
          force_float(rows[3], first)};
}

// std::max(0.0, x)
HWY_INLINE ForceV not_negative(ForceV x) {
  const ForceV zero = hn::Zero(ForceTag());
  return hn::IfThenElse(hn::Lt(zero, x), x, zero);
}
HWY_INLINE ForceV larger(ForceV a, ForceV b) { return hn::IfThenElse(hn::Lt(a, b), b, a); }
HWY_INLINE Three<ForceV> three_where(ForceM mask, const Three<ForceV>& v) {
  return {hn::IfThenElseZero(mask, v.x), hn::IfThenElseZero(mask, v.y), hn::IfThenElseZero(mask, v.z)};
}

HWY_INLINE void look_at(RodLooks* looks, size_t i) {
  const auto row = [&](size_t r) HWY_ATTR { return force_row(looks->rows[r], i); };
  const auto row3 = [&](size_t r) HWY_ATTR { return force_rows3(looks->rows + r, i); };
  const Three<ForceV> moved = {force_float(looks->floats[kLookMove], i),
                               force_float(looks->floats[kLookMove + 1], i),
                               force_float(looks->floats[kLookMove + 2], i)};
  const LookOf<ForceV> look =
      look_of<ForceV>({force_turn(looks->floats + kLookTurn, i), force_turn(looks->floats + kLookNow, i),
                       scaled(row(kLookLength), moved), row3(kLookAxis), row3(kLookNormal),
                       row3(kLookObstacle), row(kLookAlong), row(kLookRadius)});
  const ForceV open = hn::Sub(hn::Add(row(kLookGap), look.opened), row(kLookAllowed));
  const auto presses = [&](ForceV at) HWY_ATTR {
    return hn::Gt(hn::Sub(row(kLookForce), hn::Mul(row(kLookLetsGo), at)), hn::Zero(ForceTag()));
  };
  const ForceM pressed = hn::Or(presses(open), presses(row(kLookOpenBefore)));
  put_row(looks->rows[kLookOpen], i, open);
  put_rows3(looks->rows + kLookSlip, i, three_where(pressed, look.slip));
}

// rods/contacts/contact.hpp's ContactForce of what presses.
struct ForceOf {
  Three<ForceV> drag, direction;
  ForceV along, across;
};
struct RubbedOf {
  ForceV gain, limit;
  ForceM sticks, slides, rubs;
  Three<ForceV> drag;
};
HWY_INLINE ForceOf force_of(const RubbedOf& c, const Three<ForceV>& slip) {
  const ForceTag d;
  const ForceV one = hn::Set(d, 1), zero = hn::Zero(d);
  const Three<ForceV> pulled = plain_sum(hn::Neg(c.gain), slip, c.drag);
  const ForceV size = plain_length(pulled), part = hn::Div(c.limit, size);
  const ForceM whole = hn::Or(c.sticks, hn::Not(hn::Gt(size, c.limit)));
  const ForceM cut = hn::AndNot(whole, c.rubs);
  const Three<ForceV> direction = three_where(cut, scaled(hn::Div(one, size), pulled));
  const ForceV across = hn::IfThenElse(whole, one, part);
  const ForceV along = hn::IfThenElse(whole, one, hn::IfThenElse(c.slides, zero, part));
  const Three<ForceV> drag = choose(whole, pulled, scaled(c.limit, direction));
  return {three_where(c.rubs, drag), direction, hn::IfThenElseZero(c.rubs, along),
          hn::IfThenElseZero(c.rubs, across)};
}
// drag_after
HWY_INLINE Three<ForceV> drag_of_change(ForceV gain, const ForceOf& f, const Three<ForceV>& change) {
  const ForceV along = hn::Mul(hn::Sub(f.along, f.across), plain_dot(change, f.direction));
  return plain_sum(hn::Neg(gain), plain_sum(along, f.direction, scaled(f.across, change)), f.drag);
}
HWY_INLINE Three<ForceV> shortened(const Three<ForceV>& v, ForceV size, ForceV limit) {
  return choose(hn::Gt(size, limit), scaled(hn::Div(limit, size), v), v);
}

// ContactForces::law_miss
struct MissOf {
  ForceV gain, friction, nothing, rounding, force_before, force, open, open_before;
  ForceM stuck;
  Three<ForceV> slip, slip_before;
};
HWY_INLINE ForceV miss_of(const MissOf& c, const ForceOf& before) {
  const ForceTag d;
  const ForceV zero = hn::Zero(d);
  const Three<ForceV> slipped = c.slip - c.slip_before;
  const ForceV moved = larger(hn::Abs(hn::Sub(c.open, c.open_before)), plain_length(slipped));
  const ForceM none = hn::AndNot(c.stuck, hn::Le(moved, c.nothing));
  const ForceV pull = not_negative(hn::Sub(hn::Mul(c.gain, c.open), c.force_before));
  const Three<ForceV> drag = drag_of_change(c.gain, before, slipped);
  const ForceV limit = hn::Mul(c.friction, c.force);
  const Three<ForceV> asked = choose(c.stuck, drag, plain_sum(hn::Neg(c.gain), c.slip, drag));
  const Three<ForceV> lawful = shortened(asked, plain_length(asked), limit);
  const ForceV off = hn::IfThenElseZero(hn::Gt(c.friction, zero), plain_length(lawful - drag));
  return hn::IfThenZeroElse(none, not_negative(hn::Sub(hn::Add(pull, off), c.rounding)));
}

// ContactForces::update_friction
struct StateOf {
  ForceV state, changes;
  ForceM rests;  // slid, and does no more
};
HWY_INLINE StateOf state_after(ForceV state, ForceV changes, const RubbedOf& c, ForceV force,
                               const Three<ForceV>& slip, const Three<ForceV>& slip_before) {
  const ForceTag d;
  const ForceV zero = hn::Zero(d), slides = hn::Set(d, kFrictionSlides), either = hn::Set(d, kFrictionEither);
  const ForceV drag = plain_length(plain_sum(hn::Neg(c.gain), slip, c.drag));
  const ForceV with_drag = plain_dot(slip, c.drag);
  const ForceM presses = hn::Gt(force, zero), may_be_either = hn::Eq(state, either);
  const ForceM further = hn::And(hn::And(hn::Lt(with_drag, zero), hn::Gt(plain_dot(slip, slip_before), zero)),
                                 hn::Gt(plain_dot(slip, slip), plain_dot(slip_before, slip_before)));
  const ForceM slides_on = hn::And(further, hn::Gt(drag, hn::Mul(hn::Set(d, 2), c.limit)));
  const ForceM ends = hn::Or(hn::Gt(with_drag, zero), hn::Lt(drag, c.limit));
  const ForceM turns = hn::Or(hn::And(c.slides, ends), hn::And(c.sticks, hn::Gt(drag, c.limit)));
  const ForceM changed = hn::And(presses, turns);
  const ForceV count = hn::Add(changes, hn::IfThenElseZero(changed, hn::Set(d, 1)));
  const ForceM too_many = hn::Gt(count, hn::Set(d, kMostFrictionChanges));
  const ForceV other =
      hn::IfThenElse(too_many, either, hn::IfThenElse(c.slides, hn::Set(d, kFrictionSticks), slides));
  const ForceM goes_on = hn::And(hn::And(presses, may_be_either), slides_on);
  return {hn::IfThenElse(changed, other, hn::IfThenElse(goes_on, slides, state)), count,
          hn::And(changed, c.slides)};
}

HWY_INLINE ForceM state_is(ForceV state, RodFriction which) {
  return hn::Eq(state, hn::Set(ForceTag(), static_cast<double>(which)));
}
HWY_INLINE ForceM rubs_with(ForceV friction, ForceV limit, ForceM sticks) {
  const ForceV zero = hn::Zero(ForceTag());
  return hn::And(hn::Gt(friction, zero), hn::Or(sticks, hn::Gt(limit, zero)));
}

// ContactForces::take_over
HWY_INLINE void take_lanes(RodTakes* takes, size_t i) {
  const ForceTag d;
  const ForceV zero = hn::Zero(d), one = hn::Set(d, 1);
  const auto row = [&](size_t r) HWY_ATTR { return force_row(takes->rows[r], i); };
  const auto row3 = [&](size_t r) HWY_ATTR { return force_rows3(takes->rows + r, i); };
  const ForceV gain = row(kTakeGain), friction = row(kTakeFriction), state = row(kTakeState);
  const ForceV open = row(kTakeOpen), open_before = row(kTakeOpenBefore), force_before = row(kTakeForce);
  const Three<ForceV> slip_now = row3(kTakeSlip), slip_before = row3(kTakeSlipBefore), drag = row3(kTakeDrag);
  const ForceM stuck = state_is(state, kFrictionSticks), slid = state_is(state, kFrictionSlides);
  const RubbedOf was = {gain, row(kTakeLimit), stuck, slid, rubs_with(friction, row(kTakeLimit), stuck),
                        drag};
  const ForceOf linearised = force_of(was, slip_before);

  const ForceV left = hn::Sub(one, row(kTakeShare));
  const Three<ForceV> slip = plain_sum(hn::Neg(left), slip_before, slip_now);
  const ForceV force =
      not_negative(hn::Sub(force_before, hn::Mul(gain, hn::Sub(open, hn::Mul(left, open_before)))));
  const ForceV damped = hn::Add(one, hn::Mul(friction, friction));
  const ForceV limit = hn::Add(was.limit, hn::Div(hn::Sub(hn::Mul(friction, force), was.limit), damped));
  RubbedOf is = {gain, limit, stuck, slid, was.rubs, drag};
  const StateOf after = state_after(state, row(kTakeChanges), is, force, slip, slip_before);
  is.sticks = state_is(after.state, kFrictionSticks), is.slides = state_is(after.state, kFrictionSlides);
  is.rubs = hn::And(hn::Gt(force, zero), rubs_with(friction, limit, is.sticks));
  const Three<ForceV> kept = shortened(drag, plain_length(drag), limit);
  put_rows3(takes->rows + kTakeDrag, i, choose(after.rests, kept, force_of(is, slip).drag));

  const MissOf miss = {
      gain,        friction, row(kTakeNothing), row(kTakeRounding), force_before, force, open,
      open_before, stuck,    slip_now,          slip_before};
  put_row(takes->rows[kTakeMiss], i, miss_of(miss, linearised));
  const ForceM held = hn::And(stuck, hn::Gt(friction, zero));
  const ForceV off = larger(hn::Abs(open), hn::IfThenElseZero(held, plain_length(slip_now)));
  put_row(takes->rows[kTakeExact], i, hn::IfThenElseZero(hn::Le(off, row(kTakeTolerance)), one));
  put_row(takes->rows[kTakeForce], i, force);
  put_row(takes->rows[kTakeLimit], i, limit);
  put_row(takes->rows[kTakeState], i, after.state);
  put_row(takes->rows[kTakeChanges], i, after.changes);
}

HWY_INLINE void put_out(float (&row)[kForceLanes], size_t first, ForceV value) {
  const hn::Rebind<float, ForceTag> d;
  hn::Store(hn::DemoteTo(d, value), d, row + first);
}

// ContactForces::add_to_side: J of place is 1.
HWY_INLINE void push_lanes(RodPushes* pushes, size_t i) {
  const ForceTag d;
  const ForceV one = hn::Set(d, 1);
  const auto row = [&](size_t r) HWY_ATTR { return force_row(pushes->rows[r], i); };
  const auto row3 = [&](size_t r) HWY_ATTR { return force_rows3(pushes->rows + r, i); };
  const ForceV state = row(kPushState), gain = row(kPushGain), limit = row(kPushLimit);
  const ForceM sticks = state_is(state, kFrictionSticks), slides = state_is(state, kFrictionSlides);
  const ForceOf f =
      force_of({gain, limit, sticks, slides, rubs_with(row(kPushFriction), limit, sticks), row3(kPushDrag)},
               row3(kPushSlip));
  const Three<ForceV> normal = row3(kPushNormal);
  const ForceV press = hn::Sub(row(kPushForce), hn::Mul(gain, row(kPushOpen)));
  const Three<ForceV> force = plain_sum(press, normal, f.drag);

  const ForceV pressed = row(kPushStiffness), held = hn::Mul(f.across, pressed);
  const ForceV along_held = hn::Mul(f.along, pressed);
  const ForceV more_pressed = hn::Sub(pressed, held), more_held = hn::Sub(along_held, held);
  const ForceV m = row(kPushMass), l = row(kPushLength);
  const ForceV per_mass = hn::Div(one, m), unit = hn::Mul(m, l);
  const SegmentAxes<ForceV> own = plain_axes(force_turn(pushes->now, i));
  const Three<ForceV> arm =
      scaled(hn::Div(one, l), plain_sum(row(kPushRadius), normal, scaled(row(kPushAlong), own.z)));
  const Three<ForceV> turns[3] = {plain_cross(own.x, arm), plain_cross(own.y, arm), plain_cross(own.z, arm)};
  const auto stiff = [&](ForceV along_normal, ForceV along_direction,
                         const Three<ForceV>& held_move) HWY_ATTR {
    const Three<ForceV> held_all = plain_sum(hn::Mul(more_held, along_direction), f.direction, held_move);
    return scaled(per_mass, plain_sum(hn::Mul(more_pressed, along_normal), normal, held_all));
  };
  const auto put = [&](size_t r, ForceV value) HWY_ATTR { put_out(pushes->out[r], i, value); };
  const ForceV zero = hn::Zero(d);
  const Three<ForceV> of_x = stiff(normal.x, f.direction.x, {held, zero, zero});
  const Three<ForceV> of_y = stiff(normal.y, f.direction.y, {zero, held, zero});
  const Three<ForceV> of_z = stiff(normal.z, f.direction.z, {zero, zero, held});
  put(0, of_x.x);
  put(1, of_y.x), put(2, of_y.y);
  put(3, of_z.x), put(4, of_z.y), put(5, of_z.z);
  size_t at = 6;
  SINEW_UNROLL
  for (size_t r = 0; r < 3; ++r) {
    const Three<ForceV> of_turn =
        stiff(plain_dot(turns[r], normal), plain_dot(turns[r], f.direction), scaled(held, turns[r]));
    put(at, of_turn.x), put(at + 1, of_turn.y), put(at + 2, of_turn.z);
    SINEW_UNROLL
    for (size_t k = 0; k <= r; ++k) put(at + 3 + k, plain_dot(of_turn, turns[k]));
    at += 4 + r;
    put(21 + 3 + r, hn::Div(plain_dot(force, turns[r]), unit));
  }
  put(21, hn::Div(force.x, unit)), put(22, hn::Div(force.y, unit)), put(23, hn::Div(force.z, unit));
}

inline void rod_look(RodLooks* looks, size_t count) {
  for (size_t i = 0; i < count; i += hn::MaxLanes(ForceTag())) look_at(looks, i);
}
inline void rod_take(RodTakes* takes, size_t count) {
  for (size_t i = 0; i < count; i += hn::MaxLanes(ForceTag())) take_lanes(takes, i);
}
inline void rod_push(RodPushes* pushes, size_t count) {
  for (size_t i = 0; i < count; i += hn::MaxLanes(ForceTag())) push_lanes(pushes, i);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
