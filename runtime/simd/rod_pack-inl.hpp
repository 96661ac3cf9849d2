// rod_pack-inl.hpp  Takes strands from lane to lane between groups, bit by bit.
//
// What an iteration reads goes along to where a strand is iterated on; from there what it came to.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct FieldSpan {
  uint32_t first, count;
};
// As direct and what follows it read them.
inline constexpr FieldSpan kIteratedRecords[] = {{kRodFree, 2}, {kRodInertia, 2}, {kRodTied, 3}};
inline constexpr FieldSpan kIteratedScratch[] = {
    {kRodFreeMove, 7}, {kRodGap, kRodImpulse - kRodGap}, {kRodLastTurn, 3}};
// As finish and what may look at the iterate read them.
inline constexpr FieldSpan kEndedScratch[] = {{kRodMove, kRodImpulse - kRodMove}, {kRodImpulse + 3, 3}};

// What the vectors of `to` take from those of `from`: a row's go together, for they lie together.
template <class D, size_t kWidth>
class LaneMoves {
 public:
  HWY_INLINE explicit LaneMoves(const int8_t* lanes) {
    for (size_t to = 0; to < kWidth; to += kLanes) {
      for (size_t from = 0; from < kWidth; from += kLanes) add(from, to, lanes);
    }
  }
  HWY_INLINE void rows(const float* source, float* target, size_t count) const {
    const D d;
    for (size_t row = 0; row < count * kWidth; row += kWidth) {
      for (size_t k = 0; k < count_; ++k) {
        const Move& move = moves_[k];
        const auto sources = hn::SetTableIndices(d, move.sources);
        const auto taken = hn::Gt(hn::Load(d, move.takes), hn::Zero(d));
        const auto values = hn::TableLookupLanes(hn::Load(d, source + row + move.from), sources);
        float* place = target + row + move.to;
        hn::Store(hn::IfThenElse(taken, values, hn::Load(d, place)), d, place);
      }
    }
  }
  HWY_INLINE void spans(const Group<D, kWidth>& source, const Group<D, kWidth>& target, size_t segment,
                        const auto& fields) const {
    for (const FieldSpan& span : fields)
      rows(source.at(segment, span.first), target.at(segment, span.first), span.count);
  }

 private:
  static constexpr size_t kLanes = hn::MaxLanes(D()), kVectors = kWidth / kLanes;
  struct Move {
    HWY_ALIGN int32_t sources[kLanes];
    HWY_ALIGN float takes[kLanes];
    size_t from, to;
  };

  HWY_INLINE void add(size_t from, size_t to, const int8_t* lanes) {
    Move& move = moves_[count_];
    bool any = false;
    for (size_t k = 0; k < kLanes; ++k) {
      const int32_t lane = lanes[to + k] - static_cast<int32_t>(from);
      const bool here = lane >= 0 && lane < static_cast<int32_t>(kLanes);
      move.sources[k] = here ? lane : 0, move.takes[k] = here ? 1.0f : 0.0f;
      any = any || here;
    }
    move.from = from, move.to = to;
    if (any) ++count_;
  }

  size_t count_ = 0;
  Move moves_[kVectors * kVectors];
};

// Vectors of `to` from the first on, so that a group's lanes may close up within it.
template <size_t kWidth>
void rod_move_lanes(const RodJob& from, const RodJob& to, const int8_t* lanes, bool ended) {
  using D = LanesOf<kWidth>;
  const Group<D, kWidth> source = lanes_from<D, kWidth>(from, 0), target = lanes_from<D, kWidth>(to, 0);
  const LaneMoves<D, kWidth> moves(lanes);
  moves.rows(from.lanes, to.lanes, kLaneFields);
  for (size_t i = 0; i < from.segments; ++i) {
    if (ended) {
      moves.spans(source, target, i, kEndedScratch);
    } else {
      moves.spans(source, target, i, kIteratedRecords);
      moves.spans(source, target, i, kIteratedScratch);
    }
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
