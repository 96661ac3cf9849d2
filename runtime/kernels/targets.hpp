// targets.hpp  What the files that are compiled once an instruction set agree on; before
// hwy/foreach_target.h.
#pragma once

// Sums are arrays of vectors, which scalable vectors cannot be: 64-bit Arm runs NEON.
#define SINEW_SCALABLE_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
// By the CMake option SINEW_INSTRUCTION_SETS.
#ifdef SINEW_FEW_INSTRUCTION_SETS
#define HWY_DISABLED_TARGETS (SINEW_SCALABLE_TARGETS | HWY_SSSE3 | HWY_SSE4)
#else
#define HWY_DISABLED_TARGETS SINEW_SCALABLE_TARGETS
#endif

// Sums stay in registers only when the loops over them are gone.
#ifdef __clang__
#define SINEW_UNROLL _Pragma("clang loop unroll(full)")
#else
#define SINEW_UNROLL _Pragma("GCC unroll 16")
#endif
