// rod_pack-inl.hpp  Takes strands from lane to lane between groups, bit by bit.
//
// What an iteration reads goes along to where a strand is iterated on; from there what it came to.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct FieldSpan {
  uint32_t first, count;
};
// As direct and what follows it read them.
inline constexpr FieldSpan kIteratedRecords[] = {{kRodFree, 2}, {kRodInertia, 3}, {kRodTied, 3}};
static_assert(kRodHalfLength == kRodInertia + 2 && kRodArm == kRodTied + 2);
inline constexpr FieldSpan kIteratedScratch[] = {
    {kRodFreeMove, 7}, {kRodGap, kRodImpulse - kRodGap}, {kRodLastTurn, 3}};
// As finish and what may look at the iterate read them.
inline constexpr FieldSpan kEndedScratch[] = {{kRodMove, kRodImpulse - kRodMove}, {kRodImpulse + 3, 3}};

// What one vector of `to` takes from one of `from`.
template <class D, size_t kWidth>
struct LaneMove {
  D d;
  size_t from, to;
  decltype(hn::SetTableIndices(D(), static_cast<const int32_t*>(nullptr))) sources;
  hn::Mask<D> taken;
  bool any;

  HWY_INLINE LaneMove(size_t from_lane, size_t to_lane, const int8_t* lanes)
      : from(from_lane), to(to_lane), any(false) {
    constexpr size_t kLanes = hn::MaxLanes(D());
    HWY_ALIGN int32_t at[kLanes];
    HWY_ALIGN float takes[kLanes];
    for (size_t k = 0; k < kLanes; ++k) {
      const int32_t lane = lanes[to + k] - static_cast<int32_t>(from);
      const bool here = lane >= 0 && lane < static_cast<int32_t>(kLanes);
      at[k] = here ? lane : 0, takes[k] = here ? 1.0f : 0.0f;
      any = any || here;
    }
    sources = hn::SetTableIndices(d, at);
    taken = hn::Gt(hn::Load(d, takes), hn::Zero(d));
  }
  HWY_INLINE void rows(const float* source, float* target, size_t count) const {
    for (size_t row = 0; row < count * kWidth; row += kWidth) {
      const auto values = hn::TableLookupLanes(hn::Load(d, source + row + from), sources);
      float* place = target + row + to;
      hn::Store(hn::IfThenElse(taken, values, hn::Load(d, place)), d, place);
    }
  }
  HWY_INLINE void spans(const Group<D, kWidth>& source, const Group<D, kWidth>& target, size_t segment,
                        const auto& fields) const {
    for (const FieldSpan& span : fields)
      rows(source.at(segment, span.first), target.at(segment, span.first), span.count);
  }
};

// Vectors of `to` from the first on, so that a group's lanes may close up within it.
template <size_t kWidth>
void rod_move_lanes(const RodJob& from, const RodJob& to, const int8_t* lanes, bool ended) {
  using D = LanesOf<kWidth>;
  constexpr size_t kLanes = hn::MaxLanes(D());
  const Group<D, kWidth> source = lanes_from<D, kWidth>(from, 0), target = lanes_from<D, kWidth>(to, 0);
  for (size_t pair = 0; pair < kWidth / kLanes * (kWidth / kLanes); ++pair) {
    const LaneMove<D, kWidth> move(pair % (kWidth / kLanes) * kLanes, pair / (kWidth / kLanes) * kLanes,
                                   lanes);
    if (!move.any) continue;
    move.rows(from.lanes, to.lanes, kLaneFields);
    for (size_t i = 0; i < from.segments; ++i) {
      if (ended) {
        move.spans(source, target, i, kEndedScratch);
      } else {
        move.spans(source, target, i, kIteratedRecords);
        move.spans(source, target, i, kIteratedScratch);
      }
    }
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
