// turn-inl.hpp  Vectors turned by rotation vectors, and by the mean of the turns on the way there.
//
// With a = |theta|, s = a^2 <= 4, C = (1 - cos a) / a^2 and D = (a - sin a) / a^3, t x short for cross
// product:
//   turn        exp([theta]x) v = v + (1 - s D) theta x v + C theta x (theta x v)        (Rodrigues)
//   turn_back   exp([theta]x)^T v, the same with -theta
//   warp        v + C theta x v + D theta x (theta x v)
// C and D are polynomials in s: what is left out is below 1e-9. NaN goes through.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

struct TurnSeries {
  Vector c, d;
};

HWY_INLINE TurnSeries turn_series(Vector s) {
  constexpr int kTerms = 8;
  // 1 / (2k + 2)! and 1 / (2k + 3)!, signs alternating.
  constexpr float kC[kTerms] = {5.00000000e-1f, -4.16666667e-2f, 1.38888889e-3f,  -2.48015873e-5f,
                                2.75573192e-7f, -2.08767570e-9f, 1.14707456e-11f, -4.77947733e-14f};
  constexpr float kD[kTerms] = {1.66666667e-1f, -8.33333333e-3f,  1.98412698e-4f,  -2.75573192e-6f,
                                2.50521084e-8f, -1.60590438e-10f, 7.64716373e-13f, -2.81145725e-15f};
  const Floats d;
  TurnSeries series{hn::Set(d, kC[kTerms - 1]), hn::Set(d, kD[kTerms - 1])};
  SINEW_UNROLL
  for (int k = kTerms - 2; k >= 0; --k) {
    series.c = hn::MulAdd(series.c, s, hn::Set(d, kC[k]));
    series.d = hn::MulAdd(series.d, s, hn::Set(d, kD[k]));
  }
  return series;
}

// turned(theta, v) of each row.
template <class Turned>
HWY_INLINE void for_each_turn(const TurnJob& job, const Turned& turned) {
  for (uint32_t first = 0; first < job.count; first += kLanes) {
    const Vector3 theta = load_rows3(job.turns, job.turn_stride, first, job.count);
    const Vector3 v = load_rows3(job.in, 3, first, job.count);
    store_rows3(turned(theta, v), job.out, 3, first, job.count);
  }
}

HWY_INLINE Vector3 turn_about(const Vector3& theta, const Vector3& v) {
  const Vector s = dot(theta, theta);
  const TurnSeries series = turn_series(s);
  const Vector3 once = cross(theta, v), twice = cross(theta, once);
  const Vector sine = hn::NegMulAdd(s, series.d, hn::Set(Floats(), 1));
  return scaled_sum(series.c, twice, scaled_sum(sine, once, v));
}

void turn(const TurnJob& job) {
  for_each_turn(job, [](const Vector3& theta, const Vector3& v) HWY_ATTR { return turn_about(theta, v); });
}

void turn_back(const TurnJob& job) {
  for_each_turn(job, [](const Vector3& theta, const Vector3& v) HWY_ATTR {
    return turn_about({hn::Neg(theta.x), hn::Neg(theta.y), hn::Neg(theta.z)}, v);
  });
}

void warp(const TurnJob& job) {
  for_each_turn(job, [](const Vector3& theta, const Vector3& v) HWY_ATTR {
    const TurnSeries series = turn_series(dot(theta, theta));
    const Vector3 once = cross(theta, v), twice = cross(theta, once);
    return scaled_sum(series.d, twice, scaled_sum(series.c, once, v));
  });
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
