// dot-inl.hpp  Sums of four products of signed bytes, exact in 32 bits: what int8 layers are made of.
//
//   sum[j] += x[0] w[j][0] + x[1] w[j][1] + x[2] w[j][2] + x[3] w[j][3],  one 32-bit lane a column j
//
// Each form keeps quantised numbers x as it reads them (Stored), from floats that are kWhole + kOffset
// higher, reads weights as they lie in the pack, and is exact, so that all give the same integers: x and w
// are within +-127, a pair of products within 16 bits.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

using Ints = hn::Rebind<int32_t, Floats>;
using IntVector = hn::Vec<Ints>;
using Bytes = hn::Rebind<int8_t, Floats>;

// A float from here to 2^22 on either side is this and a whole number, which its low bits hold.
inline constexpr float kWhole = 0x1.8p23f;

HWY_INLINE IntVector whole_of(Vector x) {
  return hn::Sub(hn::BitCast(Ints(), x), hn::BitCast(Ints(), hn::Set(Floats(), kWhole)));
}

#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR

// Pairs of 16-bit numbers, multiplied and added by one instruction: weights 0 2 and 1 3 of each column, sign
// extended by shifts; x is stored as 0 2 1 3. vpmaddubsw would do four at a time, but saturates.
struct BasicDot {
  using Stored = int16_t;
  using Pairs = hn::Repartition<int16_t, Ints>;
  struct Weights {
    hn::Vec<Pairs> even, odd;
  };
  static constexpr size_t kVectors = kWide < 4 ? 2 : 4;
  static constexpr int32_t kOffset = 0;

  static HWY_INLINE void store(Vector x, Stored* out) {
    HWY_ALIGN static constexpr uint8_t kOrder[64] = {0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15,
                                                     0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15,
                                                     0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15,
                                                     0, 1, 4, 5, 2, 3, 6, 7, 8, 9, 12, 13, 10, 11, 14, 15};
    const hn::Rebind<int16_t, Floats> d;
    const hn::Repartition<uint8_t, decltype(d)> db;
    hn::Store(hn::TableLookupBytes(hn::DemoteTo(d, whole_of(x)), hn::BitCast(d, hn::Load(db, kOrder))), d,
              out);
  }
  static HWY_INLINE Weights weights(const int8_t* w) {
    const Ints d;
    const auto four = hn::BitCast(Pairs(), hn::Load(d, reinterpret_cast<const int32_t*>(w)));
    return {hn::ShiftRight<8>(hn::ShiftLeft<8>(four)), hn::ShiftRight<8>(four)};
  }
  static HWY_INLINE IntVector two(const Stored* x, hn::Vec<Pairs> w, IntVector sum) {
    int32_t pair;
    hwy::CopyBytes<sizeof pair>(x, &pair);
    IntVector none = hn::Zero(Ints());
    return hn::ReorderWidenMulAccumulate(Ints(), hn::BitCast(Pairs(), hn::Set(Ints(), pair)), w, sum, none);
  }
  static HWY_INLINE IntVector add(const Stored* x, const Weights& w, IntVector sum) {
    return two(x + 2, w.odd, two(x, w.even, sum));
  }
};

#else

// Four 32-bit products, for targets without vectors or without anything better.
struct BasicDot {
  using Stored = int8_t;
  using Weights = IntVector;
  static constexpr size_t kVectors = kWide < 4 ? 2 : 4;
  static constexpr int32_t kOffset = 0;

  static HWY_INLINE void store(Vector x, Stored* out) {
    hn::Store(hn::DemoteTo(Bytes(), whole_of(x)), Bytes(), out);
  }
  static HWY_INLINE Weights weights(const int8_t* w) {
    return hn::Load(Ints(), reinterpret_cast<const int32_t*>(w));
  }
#if HWY_TARGET == HWY_NEON
  // Products of eight bytes, neighbours added in 16 bits, then in 32.
  static HWY_INLINE IntVector add(const Stored* x, Weights w, IntVector sum) {
    int32_t four;
    hwy::CopyBytes<sizeof four>(x, &four);
    const int8x16_t value = vreinterpretq_s8_s32(vdupq_n_s32(four)), weight = vreinterpretq_s8_s32(w.raw);
    const int16x8_t low = vmull_s8(vget_low_s8(value), vget_low_s8(weight)),
                    high = vmull_high_s8(value, weight);
    return IntVector(vpadalq_s16(sum.raw, vpaddq_s16(low, high)));
  }
#else
  static HWY_INLINE IntVector add(const Stored* x, Weights w, IntVector sum) {
    sum = hn::Add(sum, hn::Mul(hn::Set(Ints(), x[0]), hn::ShiftRight<24>(hn::ShiftLeft<24>(w))));
    sum = hn::Add(sum, hn::Mul(hn::Set(Ints(), x[1]), hn::ShiftRight<24>(hn::ShiftLeft<16>(w))));
    sum = hn::Add(sum, hn::Mul(hn::Set(Ints(), x[2]), hn::ShiftRight<24>(hn::ShiftLeft<8>(w))));
    return hn::Add(sum, hn::Mul(hn::Set(Ints(), x[3]), hn::ShiftRight<24>(w)));
  }
#endif
};

#endif

#if HWY_ARCH_X86 && HWY_TARGET == HWY_AVX3
#define SINEW_FAST_DOT 1

// AVX-512 VNNI multiplies unsigned by signed bytes: x is stored 128 higher, and sums start 128 sum_k w lower.
// By its name, for compilers refuse the intrinsic in a function that is compiled for AVX-512 without it.
struct FastDot {
  using Stored = uint8_t;
  using Weights = IntVector;
  static constexpr size_t kVectors = kWide;
  static constexpr int32_t kOffset = 128;

  static HWY_INLINE void store(Vector x, Stored* out) {
    const hn::RebindToUnsigned<Bytes> d;
    hn::Store(hn::TruncateTo(d, hn::BitCast(hn::RebindToUnsigned<Ints>(), x)), d, out);
  }
  static HWY_INLINE Weights weights(const int8_t* w) {
    return hn::Load(Ints(), reinterpret_cast<const int32_t*>(w));
  }
  static HWY_INLINE IntVector add(const Stored* x, Weights w, IntVector sum) {
    int32_t four;
    hwy::CopyBytes<sizeof four>(x, &four);
    asm("vpdpbusd %2, %1, %0" : "+v"(sum.raw) : "v"(hn::Set(Ints(), four).raw), "v"(w.raw));
    return sum;
  }
};

inline bool has_fast_dot() { return __builtin_cpu_supports("avx512vnni") != 0; }

#elif HWY_TARGET == HWY_NEON && HWY_ARCH_ARM_A64 && defined(__linux__)
#define SINEW_FAST_DOT 1

// The dot product of Armv8.2, likewise by its name. `.arch` stays in force behind it and names more than the
// rest of the file needs; `.arch_extension dotprod` is unknown to clang 14 and, on armv8-a, to binutils 2.40.
struct FastDot : BasicDot {
  static HWY_INLINE IntVector add(const Stored* x, Weights w, IntVector sum) {
    int32_t four;
    hwy::CopyBytes<sizeof four>(x, &four);
    asm(".arch armv8.2-a+crypto+dotprod\n\tsdot %0.4s, %2.16b, %1.16b"
        : "+w"(sum.raw)
        : "w"(vdupq_n_s32(four)), "w"(w.raw));
    return sum;
  }
};

inline bool has_fast_dot() { return (getauxval(AT_HWCAP) & HWCAP_ASIMDDP) != 0; }

#endif

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
