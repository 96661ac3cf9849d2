// rod_contacts-inl.hpp  What contacts add to a segment: force, and a positive matrix to mass and inertia.
//
// Contacts of a segment with obstacles, or with other rods as they stand, concern its own six unknowns alone:
// a chain that touches is solved as exactly as one that does not. Groups that touch nothing skip all of it.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {

// Into the momentum residual, after linearise().
template <class G>
HWY_INLINE void add_contact_forces(const G& g, const RodJob& job) {
  for (size_t i = 0; g.contacts && i < job.segments; ++i) {
    if (!g.touches(i)) continue;
    for (size_t k = 0; k < 6; ++k) {
      g.set(i, kRodImpulse + k, hn::Sub(g.get(i, kRodImpulse + k), g.contact(i, kContactForce + k)));
    }
  }
}

// After start_segment().
template <class G>
HWY_INLINE void add_contact_matrices(const G& g, const RodJob& job) {
  for (size_t i = 0; g.contacts && i < job.segments; ++i) {
    if (!g.touches(i)) continue;
    for (size_t k = 0; k < kContactForce; ++k) {
      g.set(i, kRodInertiaFactor + k, hn::Add(g.get(i, kRodInertiaFactor + k), g.contact(i, k)));
    }
  }
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
