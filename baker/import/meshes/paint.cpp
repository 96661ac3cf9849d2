// paint.cpp  Paint as exporters write it.
#include "baker/import/meshes/paint.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace sinew::baker {
namespace {

bool is_paint(const std::string& name) {
  constexpr const char* kName = "_stiffness";
  return std::ranges::equal(name, std::string(kName), {}, [](unsigned char c) { return std::tolower(c); });
}

// The first number of each element.
std::vector<double> first_numbers(const AccessorReader& accessors, int accessor, const std::string& where) {
  const auto width = static_cast<size_t>(accessors.components(accessor, where));
  const std::vector<double> all = accessors.numbers(accessor, static_cast<int>(width), where);
  std::vector<double> first;
  for (size_t i = 0; i < all.size(); i += width) first.push_back(all[i]);
  return first;
}

}  // namespace

std::vector<double> read_paint(const tinygltf::Primitive& primitive, size_t vertex_count,
                               const AccessorReader& accessors, const std::string& where, Source& source) {
  const auto found =
      std::ranges::find_if(primitive.attributes, [](const auto& entry) { return is_paint(entry.first); });
  if (found == primitive.attributes.end()) return {};
  const std::string place = where + " " + found->first;
  const int width = accessors.components(found->second, place);
  if (accessors.count(found->second, place) != vertex_count || width < 1 || width > 4)
    source.refuse(place,
                  "is not one number or colour for each of " + std::to_string(vertex_count) + " vertices",
                  "paint it again as an attribute of vertices, 0 soft to 1 rigid");
  std::vector<double> values = first_numbers(accessors, found->second, place);
  const double largest = accessors.largest_integer(found->second, place);
  if (largest > 1 && std::ranges::any_of(values, [](double value) { return value > 1; }))
    for (double& value : values) value /= largest;
  size_t mended = 0;
  for (double& value : values) {
    const double usable = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
    mended += usable != value ? 1 : 0;
    value = usable;
  }
  if (mended > 0)
    source.note(where,
                std::to_string(mended) + " values of _STIFFNESS are outside 0..1: clamped, NaN is rigid");
  return values;
}

}  // namespace sinew::baker
