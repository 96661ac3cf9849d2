// convert.hpp  Between the structs of sinew.h and those of the C++ headers. Those that are laid out alike
// (c/layout.cpp holds them to it) are handed over as they are.
#pragma once
#include <algorithm>
#include <bit>

#include "sinew/sinew.h"
#include "sinew/types.hpp"
#include "sinew/view.hpp"

namespace sinew::c {

template <class To, class From>
To same(const From& from) noexcept {
  return std::bit_cast<To>(from);
}

// An array of the other's.
template <class To, class From>
To* as(From* from) noexcept {
  static_assert(sizeof(To) == sizeof(From) && alignof(To) == alignof(From));
  return reinterpret_cast<To*>(from);
}

inline RootTransform to_root(const sinew_root& root) noexcept { return same<RootTransform>(root); }

inline View to_view(const sinew_view& view) noexcept {
  View out;
  std::copy_n(view.position_m, 3, out.position_m);
  std::copy_n(view.rotation_xyzw, 4, out.rotation_xyzw);
  out.height_rad = view.height_rad;
  out.aspect = view.aspect;
  out.far_m = view.far_m;
  return out;
}

}  // namespace sinew::c
