// begin_calls.hpp  Up to end_calls.hpp HWY_INLINE is no order under sanitizers: put into one another,
// functions of thousands of vectors with a check at each address take a compiler half an hour. No include
// guard: once an instruction set.
#pragma push_macro("HWY_INLINE")
#ifdef SINEW_CHECKED_KERNELS
#undef HWY_INLINE
#define HWY_INLINE inline
#endif
