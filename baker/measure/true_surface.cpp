// true_surface.cpp  see true_surface.hpp.
#include "baker/measure/true_surface.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "baker/common/bad_input.hpp"
#include "core/hash.hpp"

namespace sinew::baker {
namespace {

std::string stated(const Safetensors& file, const char* key) {
  const auto found = file.metadata.find(key);
  return found == file.metadata.end() ? "?" : found->second;
}

std::string name_of(const Safetensors& file) {
  return stated(file, "motion") + " seed " + stated(file, "seed") + " strength " + stated(file, "strength");
}

}  // namespace

TrueSurface::TrueSurface(const std::string& path, const pack::PackView& character)
    : TrueSurface(read_safetensors(path), character) {}

TrueSurface::TrueSurface(const Safetensors& file, const pack::PackView& character)
    : name_(name_of(file)), vertices_(character.character->vertex_count), motion_(file, character) {
  if (!file.tensors.contains("positions"))
    throw BadInput(file.path + ": holds no positions; simulate it with: sinew-bake truth ... --positions");
  const auto rows = static_cast<long>(motion_.ticks() + 1);
  positions_ = file.need("positions", {rows, static_cast<long>(vertices_), 3}).as_f32();
  if (!std::ranges::all_of(positions_, [](float v) { return std::isfinite(v); }))
    throw BadInput(file.path + ": tensor 'positions' is not finite; simulate it again");
}

uint64_t TrueSurface::fingerprint() const { return core::hash64(std::as_bytes(std::span(positions_))); }

}  // namespace sinew::baker
