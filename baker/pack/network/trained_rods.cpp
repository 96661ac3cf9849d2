// trained_rods.cpp  see trained_rods.hpp.
#include "baker/pack/network/trained_rods.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <span>

#include "baker/common/bad_input.hpp"
#include "rods/section.hpp"

namespace sinew::baker {
namespace {

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void take(double value) {
    least = std::fmin(least, value);
    most = std::fmax(most, value);
  }
};

std::optional<Range> trained(const Safetensors& weights, const char* key) {
  const auto found = weights.metadata.find(key);
  if (found == weights.metadata.end()) return {};
  Range range;
  char rest = 0;
  if (std::sscanf(found->second.c_str(), "%lf,%lf%c", &range.least, &range.most, &rest) != 2 ||
      !(range.least <= range.most))
    throw BadInput(weights.path + ": metadata key '" + key + "' is '" + found->second +
                   "'; expected least,most: train again");
  return range;
}

rods::SegmentDef segment_of(const pack::RodSegmentRecord& record) {
  double squares = 0;
  for (int k = 0; k < 3; ++k) {
    const double along = double{record.end_m[k]} - double{record.begin_m[k]};
    squares += along * along;
  }
  rods::SegmentDef segment;
  segment.length_m = static_cast<float>(std::sqrt(squares));
  segment.radius_m = record.radius_m;
  segment.density_kg_m3 = record.density_kg_m3;
  segment.young_modulus_pa = record.young_modulus_pa;
  segment.torsion_modulus_pa = record.torsion_modulus_pa;
  return segment;
}

// Natural logarithms of joints' compliances, in units of the mean segment's length and mass, and seconds.
// What holds its beginning, and its end, is as long as the segment there (character/asset/rod_rig.hpp) and
// counts in the mean.
Range log_compliances(std::span<const pack::RodSegmentRecord> records, bool end_held) {
  double length_m = 0, mass_kg = 0, count = 0;
  const auto add = [&](const pack::RodSegmentRecord& record) {
    const rods::SegmentDef segment = segment_of(record);
    length_m += double{segment.length_m};
    mass_kg += rods::segment_inertia(segment).mass_kg;
    ++count;
  };
  for (const pack::RodSegmentRecord& record : records) add(record);
  add(records.front());
  if (end_held) add(records.back());
  length_m /= count;
  mass_kg /= count;
  Range range;
  for (const pack::RodSegmentRecord& record : records) {
    const rods::SegmentDef own = segment_of(record);
    const rods::JointCompliance joint = rods::joint_compliance(
        record.parent == pack::kNoIndex ? own : segment_of(records[record.parent]), own);
    if (record.joint == pack::kNoIndex) continue;  // a stiff link
    const double unit = mass_kg * length_m * length_m;
    range.take(std::log(joint.bend_rad_nm * unit));
    range.take(std::log(joint.twist_rad_nm * unit));
  }
  return range;
}

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.3g", value);
  return out;
}

std::string outside(const char* what, const Range& own, const Range& known) {
  constexpr double kRounding = 1e-3;
  if (own.least >= known.least - kRounding && own.most <= known.most + kRounding) return {};
  const std::string has =
      own.most - own.least < kRounding ? text(own.least) : text(own.least) + " to " + text(own.most);
  return std::string(what) + " " + has + ", trained on " + text(known.least) + " to " + text(known.most);
}

}  // namespace

std::vector<std::string> notes_of_untrained_rods(const Safetensors& weights, const pack::PackView& pack) {
  const std::optional<Range> segments = trained(weights, "trained.segments"),
                             compliances = trained(weights, "trained.log_compliances");
  if (!segments || !compliances)
    return {weights.path +
            ": does not say which rods it was trained on; whether it helps these is not known"};
  const bool none = std::ranges::all_of(pack.rods, [](const pack::RodRecord& rod) { return rod.start == 0; });
  std::vector<std::string> notes;
  for (const pack::RodRecord& rod : pack.rods) {
    if (rod.start == 0 && !none) continue;
    Range count;
    count.take(rod.segment_count + 1 + (rod.end_holder != 0));
    std::string why = outside("segments", count, *segments);
    if (why.empty())
      why = outside("logarithms of its joints' compliances",
                    log_compliances(pack.rod_segments.subspan(rod.first_segment, rod.segment_count),
                                    rod.end_holder != 0),
                    *compliances);
    if (!why.empty())
      notes.push_back(std::string("rod '") + (pack::string_at(pack, rod.name)) + "': no rod that " +
                      weights.path + " was trained on is like it (" + why +
                      "); its start may cost iterations instead of saving them");
  }
  return notes;
}

}  // namespace sinew::baker
