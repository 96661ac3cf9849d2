// end_calls.hpp  After begin_calls.hpp.
#pragma pop_macro("HWY_INLINE")
